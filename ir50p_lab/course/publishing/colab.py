"""Copies of the notebooks for Google Colab: a first cell fetches the course and installs what the lock says.

`python -m ir50p_lab.course.publishing.colab FOLDER` writes them; the pages workflow does.
"""

import sys
import tomllib
from pathlib import Path

import nbformat

from ir50p_lab.home import PROJECT

_FIRST = """# Colab only: fetch the course and what it needs (some minutes, once a session).
# What you write is gone with the session: download notebooks/my_robot before you leave.
import os
if not os.path.isdir("/content/course"):
    !git clone --quiet --depth 1 {address} /content/course
    !pip install --quiet -r /content/course/environment.txt
    !pip install --quiet --no-deps --no-build-isolation -e /content/course
%cd /content/course/notebooks
from google.colab import output
output.enable_custom_widget_manager()"""


def write(folder):
    """Write a copy of each notebook into a folder."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    address = tomllib.loads((PROJECT / "pyproject.toml").read_text("utf-8"))["project"]["urls"]["Repository"]
    for path in (PROJECT / "notebooks").glob("[0-9A][0-9]_*.ipynb"):
        notebook = nbformat.read(path, as_version=4)
        notebook.cells.insert(0, nbformat.v4.new_code_cell(_FIRST.format(address=address), id="colab-00"))
        nbformat.write(notebook, folder / path.name)


if __name__ == "__main__":
    write(sys.argv[1])
