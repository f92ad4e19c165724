"""What notebook 11 says about faults that it cannot show: the words of the package itself."""

import re

import nbformat
from notebook_runner import FOLDER

from ir50p_lab.bench import SerialBench
from ir50p_lab.modelling import IR50P


def test_the_message_of_a_pulled_cable_is_quoted_rightly():
    notebook = nbformat.read(FOLDER / "11_bench_drive.ipynb", as_version=4)
    text = " ".join(" ".join(cell.source.split()) for cell in notebook.cells if cell.cell_type == "markdown")
    (quoted,) = re.findall(r'`BoardLostError`: "\.\.\. (.+?)"', text)
    assert quoted in str(SerialBench("COM3", arm=IR50P)._lost("went away"))
