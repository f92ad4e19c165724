"""Serial ports: which of them may be our board, how to open one, and what to do if that fails."""

import errno
from collections import namedtuple

from ir50p_lab.errors import PortError
from ir50p_lab.launcher.boards import board_name, permission_remedy
from ir50p_lab.lazy import failed


class Port(namedtuple("Port", "device board")):
    """A serial port: its device name, and the board that its USB id stands for (None: none that fits the bench)."""


def list_ports():
    """Return all serial ports of this computer: first those of a Mega 2560, then those with chips of its clones."""
    try:
        import serial  # noqa: F401 - by itself first: a browser tab lacks it, and has no ports
        from serial.tools import list_ports
    except ModuleNotFoundError as missing:
        if missing.name == "serial":
            return []
        raise failed("the list of serial ports", missing) from missing
    ports = [Port(port.device, board_name(port.vid, port.pid)) for port in sorted(list_ports.comports())]
    return sorted(ports, key=lambda port: (port.board is None, "chip" in str(port.board)))


def open_port(device, baud):
    """Open a serial port that no other program may share.

    Args: device: name of the port ('COM3', '/dev/ttyACM0'); baud: bit/s.
    Returns: an open serial.Serial.
    Raises: PortError, with the remedy, if the port is missing, busy or not permitted.
    """
    import serial

    try:
        # pyserial also calls a write timed out that went well in a process that was held up meanwhile: hence 1 s
        port = serial.Serial(device, baud, timeout=0.1, write_timeout=1.0, exclusive=True)
    except (OSError, ValueError) as error:  # SerialException is an OSError; ValueError: a baud rate it cannot do
        raise port_error(device, error) from error
    try:
        port.set_low_latency_mode(True)  # FTDI chips else wait 16 ms before they pass bytes on; Linux only
    except (AttributeError, NotImplementedError, OSError, ValueError):
        pass  # other systems and other chips: nothing to set
    return port


def port_error(device, error):
    """Return the PortError for what pyserial raised when opening `device`: what is wrong and what to do."""
    text, number = str(error), getattr(error, "errno", None)
    # Windows reports a port in use as 'access denied', without a number
    if number in (errno.EBUSY, errno.EAGAIN) or "lock port" in text or "PermissionError" in text:
        names = f"Linux: 'fuser -v {device}' names it; ModemManager lets go after half a minute"
        remedy = "close the Arduino IDE's monitor and other notebooks' kernels, then try again; or connect('simulated')"
        return PortError(f"{device} is busy: another program holds it ({names}); {remedy}")
    if number in (errno.EACCES, errno.EPERM):
        return PortError(f"no permission to open {device}: {permission_remedy(device)}")
    if number in (errno.ENOENT, errno.ENXIO, errno.ENODEV) or "FileNotFoundError" in text:
        return PortError(f"{device} does not exist: {_missing_remedy()}")
    return PortError(f"{device} does not open ({text}): is it a serial port? {_missing_remedy()}")


def _missing_remedy():
    here = ", ".join(port.device for port in list_ports()) or "none at all"
    shows = "'dmesg | tail' on Linux, 'ls /dev/cu.*' on macOS, the Device Manager on Windows"
    plug = f"plug the board in with a cable that carries data ({shows} show it); clones may need a driver (CH340)"
    return f"ports on this computer: {here}. Else {plug}. To go on without a board: connect('simulated')"
