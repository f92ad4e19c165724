"""USB ids, and who may open a port on which system."""

from types import SimpleNamespace

import pytest

from ir50p_lab.launcher import boards
from ir50p_lab.launcher.boards import board_name, permission_remedy

grp, pwd = pytest.importorskip("grp"), pytest.importorskip("pwd")  # not on Windows


def test_ids():
    assert board_name(0x2341, 0x0042) == board_name(0x2A03, 0x0010) == "Arduino Mega 2560"
    assert board_name(0x2341, 0x0044) == "Arduino Mega ADK"
    assert board_name(0x1A86, 0x7523).startswith("CH340 chip")
    assert board_name(0x2341, 0x0043) is None  # an Uno has no timer for three motors
    assert board_name(None, None) is None


@pytest.fixture
def linux(monkeypatch):
    """A Linux machine on which the port belongs to a group that the test names."""

    def make(group, members=()):
        monkeypatch.setattr(boards.sys, "platform", "linux")
        monkeypatch.setattr(boards.os, "stat", lambda device: SimpleNamespace(st_gid=77))
        monkeypatch.setattr(grp, "getgrgid", lambda number: SimpleNamespace(gr_name=group))
        monkeypatch.setattr(grp, "getgrall", lambda: [SimpleNamespace(gr_name=group, gr_mem=list(members))])
        monkeypatch.setattr(pwd, "getpwuid", lambda number: SimpleNamespace(pw_name="student"))

    return make


@pytest.mark.parametrize("group", ["dialout", "uucp"])
def test_linux_names_the_group_of_the_port(linux, group):
    linux(group)
    assert permission_remedy("/dev/ttyACM0") == f"'sudo usermod -aG {group} $USER', then log out and in again"


def test_linux_member_of_the_group_who_has_not_logged_in_again(linux):
    linux("dialout", members=["student"])
    assert "log out and in again" in permission_remedy("/dev/ttyACM0")
    assert "sudo" not in permission_remedy("/dev/ttyACM0")


def test_linux_port_of_root_or_gone(linux, monkeypatch):
    linux("root")
    assert "usermod -aG dialout" in permission_remedy("/dev/ttyACM0")
    monkeypatch.undo()
    monkeypatch.setattr(boards.sys, "platform", "linux")
    assert "usermod -aG" in permission_remedy("/dev/not-there") or "log out" in permission_remedy("/dev/not-there")


def test_other_systems(monkeypatch):
    monkeypatch.setattr(boards.sys, "platform", "darwin")
    assert "ls -l /dev/cu.usbmodem1" in permission_remedy("/dev/cu.usbmodem1")
    monkeypatch.setattr(boards.sys, "platform", "win32")
    assert "Arduino IDE" in permission_remedy("COM3")
