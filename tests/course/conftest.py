"""Each test of the course has a student's folder of its own."""

import pytest

from ir50p_lab.course import my_robot
from ir50p_lab.course.robot import catalogue


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    """The student's folder: empty, nothing said of it yet, no stage of a function taken up."""
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    catalogue._at.clear()
    my_robot._said.clear()
    yield tmp_path
    catalogue._at.clear()
