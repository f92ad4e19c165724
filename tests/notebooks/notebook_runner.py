"""Runs a notebook in its own kernel and pushes its sliders in that same kernel."""

import json
import os
import re
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from traitlets.config import Config

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("[0-9A][0-9]_*.ipynb"))  # 00, 01 ... and the appendices A1, A2
#: These obey the rules of the lab book; the others, until theirs is written, the old.
REWRITTEN = tuple(f"{number:02d}" for number in range(20))
#: Notebooks that keep results for later ones or load them.
CHAIN = [path for path in NOTEBOOKS if re.search(r"\b(save|load)_result\b", path.read_text(encoding="utf-8"))]

PUSH_SLIDERS = (Path(__file__).parent / "push_sliders.py").read_text(encoding="utf-8")


@dataclass(frozen=True)
class Run:
    """What came of running a notebook: the first thing that is wrong with a cell (or ""), report on its panels."""

    error: str
    panels: list
    cells: list


def run_notebook(notebook, folder=FOLDER, timeout=120, variables=None, push=True):
    """Run a notebook (not the file: nothing is written), then push the sliders of its panels if `push`.

    variables: environment of its kernel, beside those of this process.
    """
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError

    notebook = notebook.copy()
    last = PUSH_SLIDERS if push else 'print("[]")'
    notebook.cells = [*notebook.cells, nbformat.v4.new_code_cell(last)]
    environment = os.environ | (variables or {})
    environment["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # a debugger's notice on stderr
    where = {"metadata": {"path": str(folder)}}
    try:
        with sockets() as config:
            NotebookClient(notebook, timeout=timeout, kernel_name="python3", resources=where, config=config).execute(
                env=environment
            )
    except CellTimeoutError as error:
        return Run(str(error), [], notebook.cells)
    except CellExecutionError:
        return Run(complaint(notebook.cells), [], notebook.cells)
    said = "".join(output.get("text", "") for output in notebook.cells[-1].outputs)
    return Run(complaint(notebook.cells), json.loads(said), notebook.cells[:-1])


@contextmanager
def sockets():
    """Config of a kernel spoken to through files: a free port may be taken by any program before the kernel binds it."""
    with TemporaryDirectory() as folder:
        yield Config({"KernelManager": {"transport": "ipc", "ip": f"{folder}/kernel"} if os.name == "posix" else {}})


def complaint(cells):
    """Say which cell raised or wrote to stderr (a warning is a message to somebody else) first, and what; or ""."""
    for number, cell in enumerate(cells):
        for output in cell.get("outputs", []):
            if output.output_type == "error":
                said = "\n".join(output.traceback)
            elif output.get("name") == "stderr":
                said = f"on stderr: {output.text}"
            else:
                continue
            said = re.sub(r"\x1b\[[\d;]*m", "", said)  # colours
            return f"cell {number} (counted from 0, text cells included), id {cell.get('id')}:\n{cell.source}\n\n{said}"
    return ""
