"""USB ids, and who may open a port."""

from ir50p_lab.launcher.boards import board_name, permission_remedy


def test_ids():
    assert board_name(0x2341, 0x0042) == board_name(0x2A03, 0x0010) == "Arduino Mega 2560"
    assert board_name(0x2341, 0x0044) == "Arduino Mega ADK"
    assert board_name(0x1A86, 0x7523).startswith("CH340 chip")
    assert board_name(0x2341, 0x0043) is None  # an Uno has no timer for three motors
    assert board_name(None, None) is None


def test_who_may_open_a_port():
    assert permission_remedy("/dev/ttyACM0").startswith("'ls -l /dev/ttyACM0' shows who may")
    assert "sudo usermod -aG dialout $USER' (on Arch: uucp)" in permission_remedy("/dev/ttyACM0")
