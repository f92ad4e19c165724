"""One student goes from 00 to 18 in one home: every function is their own, and what is kept is what the next loads.

CI runs this file by its name: all notebooks one after the other take ten minutes.
"""

import pytest
import solutions
from notebook_runner import REWRITTEN
from test_runs import assert_solved

from ir50p_lab.course import my_robot
from ir50p_lab.course.robot.catalogue import ORDER


@pytest.mark.notebook
def test_the_whole_course_without_a_stand_in(tmp_path, monkeypatch):
    for number in REWRITTEN:
        assert_solved(number, tmp_path, solutions.source)
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    others = {name: whose for name in ORDER if (whose := my_robot.whose(name)) != "yours"}
    assert not others
    kept = {path.name.split("-")[0] for path in (tmp_path / "results").iterdir()}
    assert {"calibration", "model", "camera"} <= kept, kept
