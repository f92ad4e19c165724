"""USB ids, and who may open a port on which system."""

from ir50p_lab.launcher import boards
from ir50p_lab.launcher.boards import board_name, permission_remedy


def test_ids():
    assert board_name(0x2341, 0x0042) == board_name(0x2A03, 0x0010) == "Arduino Mega 2560"
    assert board_name(0x2341, 0x0044) == "Arduino Mega ADK"
    assert board_name(0x1A86, 0x7523).startswith("CH340 chip")
    assert board_name(0x2341, 0x0043) is None  # an Uno has no timer for three motors
    assert board_name(None, None) is None


def test_linux_names_the_group(monkeypatch):
    monkeypatch.setattr(boards.sys, "platform", "linux")
    assert permission_remedy("/dev/ttyACM0").startswith("'sudo usermod -aG dialout $USER' (on Arch: uucp")


def test_other_systems(monkeypatch):
    monkeypatch.setattr(boards.sys, "platform", "darwin")
    assert "ls -l /dev/cu.usbmodem1" in permission_remedy("/dev/cu.usbmodem1")
    monkeypatch.setattr(boards.sys, "platform", "win32")
    assert "Arduino IDE" in permission_remedy("COM3")
