"""Runs a notebook in its own kernel and pushes its sliders in that same kernel."""

import json
from dataclasses import dataclass
from pathlib import Path

import nbformat

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
