"""A student in a browser does 10 on the emulated board: guesses, fits a line wrongly, then rightly, and keeps it.

CI runs this file by its name: it takes a minute or two, and `ir50p_lab test` is to be quick.
"""

import re
import shutil
from contextlib import contextmanager

import nbformat
import pytest
import solutions
from a_student_keeps_all import run
from a_student_tunes import PLUG_IN, ROOT
from conftest import open_in_lab, running_lab

NOTEBOOK = ROOT / "notebooks" / "10_bench_measure.ipynb"
#: What is handed in first: a solution, spoilt (what in it, by what, words of what `check` says).
WRONG = {
    "fit_line": [
        ("slope, offset = np", "offset, slope = np", "changed places"),
        ("(len(x) - 2)", "len(x)", "you divide the squares by n"),
        ("offset, covariance", "offset, np.diag(covariance)", "a matrix is wanted"),
    ],
    "low_pass": [("2 * np.pi * ", "", "2 pi is missing"), ("y[0] = x[0]", "", "begins at 0")],
}


def handed_in(page, number, name):
    """Hand in each wrong answer, then the right one."""
    check = f'\n\n\ncheck("{name}", {name})'
    for old, new, words in WRONG[name]:
        text = solutions.source(name)
        assert old in text
        said = run(page, number, text.replace(old, new) + check)
        assert "not yet" in said and words in said, said
    assert "right, and yours" in run(page, number, solutions.source(name) + check)


@contextmanager
def opened(browser, path, home):
    """A notebook in a JupyterLab of its own; a student's own folder is `mine` in `home`."""
    shutil.copy(path, home)
    context = browser.new_context(viewport={"width": 1300, "height": 1000})
    page = context.new_page()
    with running_lab(home, IR50P_HOME=str(home / "mine")) as (address, _):
        open_in_lab(page, address.format(path.name))
        yield page
    context.close()


def code_cells(path, first):
    """Number and text of each cell with code, its questions answered; `first` stands before the first."""
    for number, cell in enumerate(nbformat.read(path, as_version=4).cells):
        if cell.cell_type == "code":
            source = re.sub(r'^(predict\("[^"]+"), \.\.\.', r"\1, 1.25", first + cell.source, flags=re.M)
            yield number, source.replace('"..."', '"as it had to come"')
            first = ""


@pytest.mark.notebook
@pytest.mark.emulator
def test_a_student_measures(browser, tmp_path):
    everything = ""
    with opened(browser, NOTEBOOK, tmp_path) as page:
        for number, source in code_cells(NOTEBOOK, first=PLUG_IN):
            if asked := re.search(r'^check\("(\w+)", \w+\)', source, re.M):
                handed_in(page, number, asked[1])
            else:
                everything += run(page, number, source)
        everything += run(page, number, 'connect("simulated").close()')  # the readings are of this arm
    assert "Bench: board on emulated" in everything and "The simulated arm instead" not in everything
    assert "Kept: calibration-1" in everything and "calibration: yours, calibration-2" in everything
