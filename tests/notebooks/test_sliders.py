"""Every notebook runs, and every slider of it answers from end to end: a broken callback is invisible otherwise."""

import re

import nbformat
import pytest
from notebook_runner import run_notebook


def code_of(notebook):
    return "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")


def test_runs(path, runs):
    assert runs(path).error == ""


def test_nothing_complains(path, runs):
    """No cell writes to stderr (a warning is a message to somebody else), none shows a traceback."""
    for cell in runs(path).cells:
        for output in cell.get("outputs", []):
            assert output.get("name") != "stderr", output.text
            assert output.output_type != "error"


def test_sliders(path, notebook, runs):
    run = runs(path)
    assert run.error == ""
    assert len(run.panels) >= len(re.findall(r"^live\(|[^\w]live\(", code_of(notebook)))
    for panel in run.panels:
        assert panel["errors"] == []
        assert panel["pushes"] >= 4
        assert panel["pictures"] >= 2, f"nothing moves when {panel['controls']} are pushed"


BROKEN = """
from ir50p_lab.course.figures import new_figure
from ir50p_lab.course.widgets import live, slider
figure = new_figure(3, 2)
line, = figure.axes[0].plot([0, 1], [0, 1])
def update(k):
    line.set_ydata([0, 1 / (k - 2)])
live(figure, update, k=slider(0, 4, 1, 1))
"""


@pytest.mark.parametrize(
    ("code", "found"), [(BROKEN, "ZeroDivisionError"), (BROKEN.replace("1 / (k - 2)", "1"), "still")]
)
def test_a_broken_callback_is_found(code, found):
    """The test above is not vacuous: an update that fails in the middle, and one that does nothing, are seen."""
    run = run_notebook(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)]))
    (panel,) = run.panels
    if found == "still":
        assert panel["errors"] == [] and panel["pictures"] == 1
    else:
        assert any(found in error for error in panel["errors"])


def test_a_failing_cell_is_found():
    run = run_notebook(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("assert 1 == 2")]))
    assert "AssertionError" in run.error
