"""Every notebook runs, and every slider of it answers from end to end: a broken callback is invisible otherwise."""

import os
import re

import nbformat
import predictions
import pytest
import solutions
import stripped
from notebook_runner import CHAIN, NOTEBOOKS, REWRITTEN, run_notebook

from ir50p_lab.course.robot.catalogue import function_of, is_function


def code_of(notebook):
    return "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")


@pytest.mark.notebook
def test_notebook(path, notebook, tmp_path):
    """Every cell runs, none complains, every slider moves something, and who writes nothing gets no tick."""
    run = assert_runs(path, notebook, tmp_path)
    assert "✓" not in "".join(output.get("text", "") for cell in run.cells for output in cell.get("outputs", []))


def assert_runs(path, notebook, home):
    run = run_notebook(notebook, variables={"IR50P_HOME": str(home)})
    if run.error:
        pytest.fail(f"{path.name}, {run.error}", pytrace=False)
    assert len(run.panels) >= len(re.findall(r"^live\(|[^\w]live\(", code_of(notebook)))
    for panel in run.panels:
        assert panel["errors"] == []
        assert panel["pushes"] >= 4
        assert panel["pictures"] >= 2, f"nothing moves when {panel['controls']} are pushed"
    return run


@pytest.mark.notebook
@pytest.mark.ci
def test_notebooks_in_a_chain(tmp_path):
    """In order, with one home: what a notebook keeps there is what later ones load. In a home of their own: conftest.py."""
    for path in CHAIN:
        assert_runs(path, stripped.read(path), tmp_path)


@pytest.mark.notebook
@pytest.mark.parametrize("number", REWRITTEN)
def test_notebook_with_solutions(number, tmp_path):
    """A student writes every function rightly: each passes its check, becomes the robot, and runs in what follows.

    What is measured there is what the lecturer's table calls true, on the arm that it speaks of.
    """
    run = assert_solved(number, tmp_path, solutions.source)
    if not any(os.environ.get(f"IR50P_{one}") for one in ("ARM", "UNIT", "SEED", "BENCH")):
        said = "".join(output.get("text", "") for cell in run.cells for output in cell.get("outputs", []))
        assert list(predictions.contradictions(number, said)) == []


def assert_solved(number, tmp_path, source, first=(), only=None):
    """Run a notebook by source(name) of each function; `first`: functions of earlier notebooks, written before.

    only: ids of the cells that are run, None for all.
    """
    (found,) = [one for one in NOTEBOOKS if one.name.startswith(number)]
    notebook = stripped.read(found)
    notebook.cells = [cell for cell in notebook.cells if only is None or cell.id in only]
    notebook.cells[2:2] = [nbformat.v4.new_code_cell(f'check("{name}", {name})') for name in first]
    asked = []
    for cell in notebook.cells:
        for name in re.findall(r'^check\("([\w.]+)", \w+\)', cell.source, re.M):
            if is_function(name):
                asked.append(name)
                cell.source = f'{source(name)}\n\ncheck("{name}", {function_of(name)})'
    run = run_notebook(notebook, variables={"IR50P_HOME": str(tmp_path)})
    if run.error:
        pytest.fail(f"{found.name}, {run.error}", pytrace=False)
    said = "".join(str(output.get("data", "")) for cell in run.cells for output in cell.get("outputs", []))
    for name in asked:
        assert f"<b>{name}</b>: right, and yours: from now on my_robot.{function_of(name)} is this" in said, name
        assert (tmp_path / "my_robot" / f"_{function_of(name)}.py").exists()
    return run
