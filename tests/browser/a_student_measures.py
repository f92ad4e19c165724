"""A student in a browser does 10 on the emulated board: guesses, fits a line wrongly, then rightly, and keeps it.

CI runs this file by its name: it takes a minute or two, and `ir50p_lab test` is to be quick.
"""

import re
import shutil

import nbformat
import pytest
import solutions
from a_student_tunes import PLUG_IN, ROOT
from conftest import running_lab
from test_a_student import run
from test_live_arm_in_lab import KERNEL_IDLE

NOTEBOOK = ROOT / "notebooks" / "10_bench_measure.ipynb"
#: What is handed in first: a solution, spoilt (what in it, by what, words of what `check` says).
WRONG = {
    "fit_line": [
        ("slope, offset = np", "offset, slope = np", "changed places"),
        ("(len(x) - 2)", "len(x)", "a line has two numbers"),
        ("offset, covariance", "offset, np.diag(covariance)", "a matrix is asked for"),
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


@pytest.mark.notebook
@pytest.mark.emulator
def test_a_student_measures(browser, tmp_path):
    shutil.copy(NOTEBOOK, tmp_path)
    page = browser.new_context().new_page()
    said = {}
    with running_lab(tmp_path, IR50P_HOME=str(tmp_path / "mine")) as (address, _):
        page.goto(address.format(NOTEBOOK.name), wait_until="commit")
        page.wait_for_function(KERNEL_IDLE, timeout=90_000)
        for number, cell in enumerate(nbformat.read(NOTEBOOK, as_version=4).cells):
            if cell.cell_type != "code":
                continue
            source = (PLUG_IN if not said else "") + cell.source
            if asked := re.search(r'^check\("(\w+)", \w+\)', source, re.M):
                handed_in(page, number, asked[1])
            else:
                source = re.sub(r'^(predict\("[^"]+"), \.\.\.', r"\1, 1.25", source)
                said[number] = run(page, number, source.replace('"..."', '"as it had to come"'))
    everything = "".join(said.values())
    assert "Bench: board on emulated" in everything and "The simulated arm instead" not in everything
    assert "Kept: calibration-1" in everything and "calibration: yours, calibration-2" in everything
