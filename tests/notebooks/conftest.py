"""Every notebook is run once per session, in its own kernel; its sliders are pushed in that same kernel."""

import json
from dataclasses import dataclass
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("[0-9][0-9]_*.ipynb"))

PUSH_SLIDERS = (Path(__file__).parent / "push_sliders.py").read_text(encoding="utf-8")


@dataclass(frozen=True)
class Run:
    """What came of running a notebook: error of the first cell that failed (or ""), report on its panels."""

    error: str
    panels: list
    cells: list


def run_notebook(notebook, folder=FOLDER, timeout=120):
    """Run a notebook (not the file: nothing is written), then push the sliders of its panels. Returns Run."""
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    notebook = notebook.copy()
    notebook.cells = [*notebook.cells, nbformat.v4.new_code_cell(PUSH_SLIDERS)]
    client = NotebookClient(
        notebook, timeout=timeout, kernel_name="python3", resources={"metadata": {"path": str(folder)}}
    )
    try:
        client.execute()
    except CellExecutionError as error:
        return Run(str(error), [], notebook.cells)
    said = "".join(output.get("text", "") for output in notebook.cells[-1].outputs)
    return Run("", json.loads(said), notebook.cells[:-1])


@pytest.fixture(scope="session")
def runs(tmp_path_factory):
    """Return a function path -> Run that runs each notebook once."""
    done = {}

    def run(path):
        if path not in done:
            with pytest.MonkeyPatch.context() as patch:
                patch.setenv("IR50P_PROGRESS", str(tmp_path_factory.mktemp("progress") / "progress.json"))
                patch.setenv("PYDEVD_DISABLE_FILE_VALIDATION", "1")  # a debugger's notice on stderr
                done[path] = run_notebook(nbformat.read(path, as_version=4))
        return done[path]

    return run


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def path(request):
    """Every notebook."""
    return request.param


@pytest.fixture
def notebook(path):
    """The notebook as nbformat reads it."""
    return nbformat.read(path, as_version=4)
