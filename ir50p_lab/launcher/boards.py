"""USB ids of the boards that fit the bench, and who may open a serial port. Standard library only."""

import tomllib
from pathlib import Path


def board_name(vid, pid):
    """Return what a USB vendor and product id stands for, by boards.toml; None if no board of ours has it."""
    names = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
    return None if vid is None else names.get(f"{vid:04X}:{pid:04X}")


def permission_remedy(device):
    """Return what to do if this user may not open the serial port `device`."""
    linux = "on Linux 'sudo usermod -aG dialout $USER' (on Arch: uucp), then log out and in again"
    return f"'ls -l {device}' shows who may; {linux}; on a managed Mac ask its administrator"
