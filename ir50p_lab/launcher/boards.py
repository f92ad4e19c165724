"""USB ids of the boards that fit the bench, and who may open a serial port. Standard library only."""

import sys
import tomllib
from pathlib import Path


def board_name(vid, pid):
    """What a USB vendor and product id stands for, by boards.toml; None if no board of ours has it."""
    names = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
    return None if vid is None else names.get(f"{vid:04X}:{pid:04X}")


def permission_remedy(device):
    """What to do when this user may not open the serial port `device`, on this operating system."""
    if sys.platform.startswith("linux"):
        return (
            f"'sudo usermod -aG dialout $USER' (on Arch: uucp; 'ls -l {device}' names the group), then log out and in "
            "again, or restart, to make it count"
        )
    if sys.platform == "darwin":
        return f"'ls -l {device}' shows who may; on a managed Mac ask its administrator for access to serial devices"
    return "close the program that holds it (Arduino IDE, another notebook): Windows reports a busy port this way"
