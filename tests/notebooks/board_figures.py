"""One figure a notebook for the board: `PYTHONPATH=. python tests/notebooks/board_figures.py FOLDER` writes 00 to 11.

They are the notebooks' own, drawn by the course's functions, as PNG or SVG; the student's book is not touched.
"""

import base64
import re
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from notebook_runner import NOTEBOOKS, run_notebook

#: The cell of each notebook, 00 to 11, whose figure is worth the board.
CELLS = (
    "start-36 pose-30 ik-16 speed-26 heavy-43 motion-14 traj-30 motor-18 parts-31 tune-05b measure-47 drive-20a"
).split()


def figure_of(path, cell_id):
    """(ending, bytes) of the last figure that a cell shows; the cells before it run in an empty home."""
    notebook = nbformat.read(path, as_version=4)
    last = [cell.get("id") for cell in notebook.cells].index(cell_id)
    notebook.cells = notebook.cells[: last + 1]
    with TemporaryDirectory() as home:
        run = run_notebook(notebook, variables={"IR50P_HOME": home, "IR50P_BENCH": "simulated"}, push=False)
    shown = [output["data"] for output in run.cells[last].outputs if "data" in output][-1]
    if "image/png" in shown:
        return "png", base64.b64decode(shown["image/png"])
    return "svg", base64.b64decode(re.search(r"image/svg\+xml;base64,([^\"]+)", shown["text/html"])[1])


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for one, cell_id in zip(NOTEBOOKS, CELLS, strict=False):
        ending, data = figure_of(one, cell_id)
        print((folder / f"{one.stem}.{ending}").write_bytes(data), one.stem)
