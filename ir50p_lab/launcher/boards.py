"""USB ids of the boards that fit the bench, and who may open a serial port. Standard library only."""

import sys
from pathlib import Path

MEGA = "Arduino Mega 2560"
# Arduino's own list (boards.txt of its AVR core): the Mega 2560 under both of its vendors, and the Mega ADK
BOARDS = {
    (vendor, product): MEGA if product in (0x0010, 0x0042, 0x0210, 0x0242) else "Arduino Mega ADK"
    for vendor in (0x2341, 0x2A03)
    for product in (0x0010, 0x0042, 0x0210, 0x0242, 0x003F, 0x0044)
}
# USB-to-serial chips on clones of the Mega (their makers' default ids): any other device may have one as well
CHIPS = {
    (0x1A86, 0x7523): "CH340",
    (0x1A86, 0x5523): "CH341",
    (0x1A86, 0x55D4): "CH9102",
    (0x10C4, 0xEA60): "CP2102",
    (0x0403, 0x6001): "FT232",
    (0x067B, 0x2303): "PL2303",
    (0x03EB, 0x204B): "ATmega16U2",
}


def board_name(vid, pid):
    """What a USB vendor and product id stands for; None if no board of ours has it."""
    if (vid, pid) in BOARDS:
        return BOARDS[vid, pid]
    return f"{CHIPS[vid, pid]} chip, as on clones of the Mega" if (vid, pid) in CHIPS else None


def permission_remedy(device):
    """What to do when this user may not open the serial port `device`, on this operating system."""
    if sys.platform.startswith("linux"):
        return f"'sudo usermod -aG {_group_of(device)} $USER', then log out and in again, or restart, to make it count"
    if sys.platform == "darwin":
        return f"'ls -l {device}' shows who may; on a managed Mac ask its administrator for access to serial devices"
    return "close the program that holds it (Arduino IDE, another notebook): Windows reports a busy port this way"


def _group_of(device):
    """Name of the group that may open the port: dialout on Debian and Fedora, uucp on Arch."""
    try:
        name = Path(device).group()
    except (OSError, KeyError, NotImplementedError):
        return "dialout"
    return "dialout" if name == "root" else name  # root: no rule gave the port to anybody
