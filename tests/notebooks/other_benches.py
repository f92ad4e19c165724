"""Notebooks that drive the arm run whole on a replay, and on the emulated board, in its own time; 08 and 09 with a second PID.

CI runs this file by its name: it takes minutes, and `ir50p_lab test` is to be quick.
"""

import re

import circles
import nbformat
import pytest
import solutions
import stripped
from notebook_runner import NOTEBOOKS, ROOT, run_notebook
from test_runs import assert_solved

#: Notebooks that drive the arm.
DRIVING = {
    path.stem: path
    for path in NOTEBOOKS
    if re.search(r"\bwith connect\(|\barm_that_answers\(|\bviews\.(?:go|follow)\(", path.read_text(encoding="utf-8"))
}

PLUG_IN = f"""
import sys
sys.path[:0] = [{str(ROOT)!r}, {str(ROOT / "tests/notebooks")!r}]
import emulated_bench
board = emulated_bench.plug_in(globals())
"""

#: What a cell asks for beside the board, and how it is done to the emulated one.
BY_HAND = {
    "from time import sleep": "sleep = lambda s: emulated_bench.wait(board, s)",
    "views.with_gripper(arm)  #": "views.with_gripper(arm); emulated_bench.hang(board, 0.3)  #",
}


def said_by(path, home, first="", variables=None):
    """What the cells of a notebook print, with another cell before them; fails if one complains."""
    notebook = stripped.read(path)
    for cell in notebook.cells if first else ():
        for asked, done in BY_HAND.items():
            cell.source = cell.source.replace(asked, done)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(first))
    run = run_notebook(notebook, timeout=900, variables={"IR50P_HOME": str(home)} | (variables or {}), push=False)
    if run.error:
        pytest.fail(f"{path.name}, {run.error}", pytrace=False)
    return "".join(output.get("text", "") for cell in run.cells for output in cell.get("outputs", []))


@pytest.mark.notebook
@pytest.mark.parametrize("name", DRIVING)
def test_on_a_replay(name, tmp_path):
    """A cell that needs an arm that answers takes the simulated one, and says so."""
    said = said_by(DRIVING[name], tmp_path, variables={"IR50P_BENCH": "replay:data/pid_default_unit.csv"})
    assert "Bench: replay" in said or "The simulated arm instead: a recording does not answer" in said


@pytest.mark.notebook
@pytest.mark.emulator
@pytest.mark.parametrize(
    "name",
    [
        "08_pid_from_its_parts",
        "10_bench_measure",
        "11_bench_drive",
        "12_identification",
        "13_is_the_model_good",
        "15_on_the_bench",
        "18_vision_guided_reaching",
    ],
)
def test_on_the_board(name, tmp_path):
    """Found, driven, and never left for the simulated arm."""
    needs_results = re.search(
        r"\barm_that_answers\(\"|\bviews\.(?:go|follow)\(", DRIVING[name].read_text(encoding="utf-8").replace("\\", "")
    )
    said = said_by(DRIVING[name], tmp_path, PLUG_IN + ("emulated_bench.measure()" if needs_results else ""))
    assert "Bench: board on emulated" in said and "The simulated arm instead" not in said


@pytest.mark.notebook
@pytest.mark.emulator
def test_a_student_drives_the_board_and_pulls_its_cable(tmp_path):
    """The circle without its radius in the speed, then rightly; driven; then the cable goes, and is put back."""
    notebook = stripped.read(DRIVING["11_bench_drive"])
    last = next(k for k, cell in enumerate(notebook.cells) if cell.source.startswith("## 8"))
    sources = [cell.source for cell in notebook.cells[:last] if cell.cell_type == "code"]
    (asked,) = [k for k, source in enumerate(sources) if source.startswith("def circle")]
    sources[asked : asked + 1] = [
        circles.written(sources[asked], *circles.WRONG[0][:2]),
        circles.written(sources[asked]),
    ]
    pulled = next(k for k, source in enumerate(sources) if 'broken("cable")' in source)
    sources.insert(pulled + 1, "emulated_bench.plug_in_again(board)\nviews.connect().close()")
    sources.insert(0, PLUG_IN + "emulated_bench.allow_the_cable(board)")
    notebook.cells = [nbformat.v4.new_code_cell(source) for source in sources]
    run = run_notebook(notebook, timeout=900, variables={"IR50P_HOME": str(tmp_path)}, push=False)
    assert not run.error, run.error
    said = [str(cell.outputs) for cell in run.cells]
    assert circles.WRONG[0][2] in said[asked + 1] and "right, and yours" in said[asked + 2]
    lost = next(text for text in said if "BoardLostError" in text)
    assert "Broken on the simulated arm" not in lost and "it brakes by itself 0.1 s after the last command" in lost
    assert "Bench: board on emulated" in said[pulled + 2]  # plugged in again
    (driven,) = re.findall(r"circle\.rms: ([\d.]+)", "".join(said))
    assert float(driven) < 25  # mm, on the board


def clipped(name):
    """A solution; of PIDs the one whose memory does not rest at the limit, but is clipped: right as well."""
    rests, clips = "np.where(winds_up, self.integral, grown)", "np.clip(grown, -self.limit, self.limit)"
    return solutions.source(name).replace(rests, clips)


@pytest.mark.notebook
@pytest.mark.parametrize("number", ["08", "09"])
def test_notebook_with_a_clipped_memory(number, tmp_path):
    """What is said and claimed of the student's PID holds of every PID that its check accepts."""
    assert clipped("PID") != solutions.source("PID")
    assert_solved(number, tmp_path, clipped, first=("PID",) if number == "09" else ())
