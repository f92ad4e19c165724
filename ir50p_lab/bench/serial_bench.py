"""The bench with the real arm: a Mega 2560 that runs our firmware, on a serial port."""

import contextlib
import os
import secrets

import numpy as np

from ir50p_lab.bench import protocol
from ir50p_lab.bench.base import Bench
from ir50p_lab.bench.caps import caps_of
from ir50p_lab.bench.link import PORT_ERRORS, Link
from ir50p_lab.bench.pace import Clock, Pace, cut_said, load_controllers
from ir50p_lab.bench.ports import open_port
from ir50p_lab.bench.result_files import own_calibration
from ir50p_lab.errors import BoardError, BoardLostError, InputError

BOOT_LOADER = 2.0  # silence after opening the port, s: the boot loader takes 1 to 2 s, but 8 s if a byte arrives
HANDSHAKE = 2.0  # s: if the board has not answered the hello by then, there is none
LOST_AFTER = 0.5  # s: a board that is silent for longer is lost; a shorter pause may be a busy computer's
_BROKEN = protocol.BROKEN_COUNTS
_REMEDY = "put the sketch of ir50p_lab/bench/firmware on the board (its README shows how)"


class SerialBench(Bench):
    """The arm on the bench, through an Arduino Mega 2560 that runs `firmware/ir50p_board`.

    Args:
        port: name of the serial port ('COM3', '/dev/ttyACM0'), or an open pyserial-like object.
        arm: Arm, default `load_arm()`; calibration: by default yours, if one was measured on
        this board (`result_files`), else the nominal one.
        clock: object with now() and sleep(s); default the computer's. period: s. record_to: folder, or False.

    Times are the true times of the measurements. A cycle that begins late is counted in `Sample.missed` and never
    raises; see `Pace`.

    Raises, when opened: PortError (missing, busy, not permitted), BoardError (not our board, or another firmware),
    InputError (the lab's own file is wrong, see `caps`).
    Raises, in a run: BoardLostError if the cable is pulled or the board resets (it brakes 0.1 s after the last
    command); BoardError if a potentiometer has lost its wire.

    Attributes: statistics: of the wire since it was last opened, see `Link`; identity: the board's Identity.
    """

    kind = "board"

    def __init__(self, port, *, calibration=None, clock=None, **options):
        named = isinstance(port, str | os.PathLike) and str(port)
        if not (named or hasattr(port, "write")):
            raise InputError(f"port = {port!r}: give the name of a serial port, or an open port")
        super().__init__(calibration=calibration, **options)
        self.port = os.fspath(port) if named else getattr(port, "name", None) or "a given port"
        self.name = f"board on {self.port} for {self.arm.name}"
        self._given = None if named else port
        self._calibrated = calibration is not None
        self._clock = clock or Clock
        self._link = self.identity = None

    # ---- the hooks of Bench

    def _open(self):
        transport = self._given or open_port(self.port, protocol.BAUD)
        self._link = Link(transport, self._clock)
        self.statistics = self._link.statistics
        try:
            ready = self._clock.now()
            if self._given is None:  # the next line that is printed takes the place of this one
                print(f"{self.port}: the board restarts, its boot loader takes {BOOT_LOADER:g} s", end="\r", flush=True)
                ready += BOOT_LOADER
            load_controllers()
            self._clock.sleep(max(0.0, ready - self._clock.now()))
            self.identity = self._shake_hands(HANDSHAKE)
            self.caps = caps_of(self.bench_id)
            if not self._calibrated:
                self.calibration = own_calibration(self) or self.calibration
        except BaseException:
            self._close()
            raise

    def _begin(self):
        try:
            self.identity = self._shake_hands(LOST_AFTER)  # the board may have been reset between two runs
        except BoardError:
            raise self._lost("does not answer") from None

    def _make_pace(self):
        return Pace(self._clock, self.period)

    def measure(self, cycle, drive):
        """Measure by one exchange with the board; see `Bench.measure`."""
        kind, command = (protocol.DRIVE, self.command) if drive else (protocol.STOP, (0, 0, 0))
        try:
            state, sent = self._link.ask(kind, command, self.gripper, patience=LOST_AFTER)
        except BoardLostError:
            raise self._lost(f"has not answered for {LOST_AFTER:g} s") from None
        except PORT_ERRORS as error:
            raise self._lost(f"is gone ({error})") from error
        if state.status & protocol.HELLO_NEEDED:
            cause = "somebody pressed its button or opened its port, or its supply broke down when the motors started"
            if state.status & protocol.HARDWARE_RESET:
                cause = "its program hung and the hardware watchdog restarted it"
            said = f"the board on {self.port} has restarted in the middle of the run ({cause}): its drive is off"
            raise BoardLostError(f"{said}. Power the motors from their own supply, not from USB; then run again")
        for joint, counts in enumerate(state.counts):
            if not _BROKEN <= counts <= protocol.MAX_COUNTS - _BROKEN:
                said = f"the potentiometer of joint {joint + 1} reads {counts / protocol.SUBCOUNTS:g} of 0..1023 counts"
                off = "the drive is off" if self.cut() else cut_said(False)
                raise BoardError(f"{said}: only a broken or shorted wire does so; {off}. Look at its plug and its 5 V")
        pace, tripped = self._run.pace, drive and bool(state.status & protocol.WATCHDOG_TRIPPED)
        pace.heard = sent
        return sent - pace.start, np.array(state.counts) / protocol.SUBCOUNTS, tripped

    def _send(self, pwm, gripper):
        try:
            self._link.tell(protocol.DRIVE, pwm, gripper)
        except PORT_ERRORS as error:
            self.cut()
            raise self._lost(f"is gone ({error})") from error

    def _cut(self):
        if self._link is not None:
            # whatever happens: the board cuts by itself 0.1 s after the last command. BaseException: a second Ctrl-C
            with contextlib.suppress(BaseException):
                self._link.stop(self.gripper)
                return True
        return False

    def _close(self):
        link, self._link = self._link, None
        if link is not None:
            with contextlib.suppress(*PORT_ERRORS):
                link.close()

    def _header(self):
        return {"port": self.port, "firmware": self.firmware, "protocol": str(self.identity.protocol)}

    def _arguments(self):
        if self._given is not None:  # an open port cannot be handed on
            return None
        return {name: getattr(self, name) for name in ("port", "arm", "calibration", "period", "record_to")}

    # ---- more than the contract asks for

    @property
    def firmware(self):
        """Version of the board's firmware, such as '1.1'; the bench must have been opened before."""
        return "{}.{}".format(*self.identity.firmware)

    @property
    def bench_id(self):
        """The id in the board's memory, such as 'board-0a1b2c'; None if it has none yet or was never open."""
        if self.identity is None or self.identity.board_id == protocol.NO_ID:
            return None
        return f"board-{self.identity.board_id:06x}"

    def give_id(self):
        """Give the board a random id if it has none, and keep it there for good. The board brakes. Returns `bench_id`.

        Raises BoardError if the bench is closed or the board does not answer.
        """
        if self._link is None:
            raise BoardError("the bench is closed: open it before the board is given an id")
        if self.bench_id is None:
            number = [secrets.randbelow(255) for _ in range(3)]  # never NO_ID
            self.identity = self._shake_hands(HANDSHAKE, protocol.NAME, number)
        return self.bench_id

    def timing(self, run):
        """Return the timing of a run with the counts of the wire; see `Bench.timing`."""
        return vars(self.statistics) | super().timing(run)

    # ---- the rest

    def _shake_hands(self, patience, kind=protocol.HELLO, pwm=(0, 0, 0)):
        """Say hello until the board says who it is. Raises BoardError, with the remedy, if it is not ours."""
        link = self._link
        try:
            if link.statistics.commands == 0:  # all that came is a boot loader's; later it may be half of an answer
                link.forget()
            identity, _ = link.ask(kind, pwm, patience=patience, repeat=min(0.05, patience / 4))
        except BoardLostError:
            said = f"{self.port}: no firmware of ours answers. Is it a Mega 2560? Then {_REMEDY}"
            raise BoardError(f"{said}, or press its reset button if that is done") from None
        except PORT_ERRORS as error:
            raise BoardError(f"{self.port} went away while we said hello ({error}): is the cable firm?") from error
        if identity.protocol == protocol.VERSION and identity.firmware >= protocol.MINIMUM_FIRMWARE:
            return identity
        has = "the board speaks protocol {}, its firmware is {}.{}".format(identity.protocol, *identity.firmware)
        needs = "protocol {} and firmware {}.{} or newer".format(protocol.VERSION, *protocol.MINIMUM_FIRMWARE)
        raise BoardError(f"{self.port}: {has}; this lab book needs {needs}: {_REMEDY}")

    def _lost(self, what):
        brakes = "it brakes by itself 0.1 s after the last command, then gravity has the arm. Look at the USB cable"
        return BoardLostError(f"the board on {self.port} {what}: {brakes} and the board's lamp, then connect() again")
