"""One student goes from 00 to 19 in one home: every function is their own, and what is kept is what the next loads.
Another one takes the fourteen sessions of the guide, and nothing else.

CI runs one of the two on half of the commits, by its name: all notebooks one after the other take ten minutes.
"""

import pytest
import selections
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


@pytest.mark.notebook
def test_fourteen_sessions_with_stand_ins_for_the_rest(tmp_path):
    taken = {}
    for session in selections.SELECTIONS["The whole order in fourteen sessions"]:
        for number, sections in session.items():
            core, _ = selections.cells_of(number, *sections)
            taken.setdefault(number, []).extend(cell.id for cell in core)
    for number, ids in taken.items():
        assert_solved(number, tmp_path, solutions.source, only=ids)
