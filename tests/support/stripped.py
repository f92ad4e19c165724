"""Notebooks as they are shipped, without what JupyterLab stores in them: the tests run these.

`python tests/support/stripped.py`, which CI runs, fails if a file of the repository is not such a one.
"""

import sys
from collections import Counter
from pathlib import Path

import nbformat

FOLDER = Path(__file__).parents[2] / "notebooks"
MARKS = ({"tags": ["core"]}, {"tags": ["more"]})  # of sections
#: As JupyterLab writes it when a notebook is opened, but for the version, which is that of its Python.
METADATA = {
    "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
    "language_info": {
        "codemirror_mode": {"name": "ipython", "version": 3},
        "file_extension": ".py",
        "mimetype": "text/x-python",
        "name": "python",
        "nbconvert_exporter": "python",
        "pygments_lexer": "ipython3",
        "version": "3.11.7",
    },
}


def read(path):
    """The notebook as it is shipped: no outputs, no metadata but METADATA, no empty cells."""
    return strip(nbformat.read(path, as_version=4))


def strip(notebook):
    """A copy without what JupyterLab stores."""
    notebook = nbformat.from_dict(notebook | {"metadata": METADATA})
    notebook.cells = [cell for cell in notebook.cells if cell.source.strip()]
    for cell in notebook.cells:
        if cell.metadata not in MARKS:
            cell.metadata.clear()
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    return notebook


def left_out(notebook):
    """What `strip` leaves out, in words: 'outputs: 3, empty cells: 1'; "" if it is nothing."""
    found = Counter()
    for cell in notebook.cells:
        found["outputs"] += len(cell.get("outputs", []))
        found["execution counts"] += cell.get("execution_count") is not None
        found["cells with metadata"] += bool(cell.metadata) and cell.metadata not in MARKS
        found["empty cells"] += not cell.source.strip()
    named = {key: value for key, value in notebook.metadata.items() if key != "language_info"}  # of another Python
    found["entries of metadata"] += len({**named, "kernelspec": METADATA["kernelspec"]}) - 1
    found["other kernels"] += named.get("kernelspec") != METADATA["kernelspec"]
    return ", ".join(f"{what}: {count}" for what, count in found.items() if count)


def sentences():
    """A sentence for each notebook of the course in which JupyterLab has stored something."""
    for path in sorted(FOLDER.glob("*.ipynb")):
        if said := left_out(nbformat.read(path, as_version=4)):
            yield f"{path.name} was read without what JupyterLab has stored in it: {said}"


def is_shipped(path):
    """Whether a file is byte for byte what JupyterLab would write of the stripped notebook."""
    return path.read_text(encoding="utf-8") == nbformat.writes(read(path)) + "\n"


if __name__ == "__main__":
    others = [path.name for path in sorted(FOLDER.glob("*.ipynb")) if not is_shipped(path)]
    sys.exit(f"not as JupyterLab would write the stripped notebook: {', '.join(others)}" if others else 0)
