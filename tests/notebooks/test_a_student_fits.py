"""A scripted student goes through the core of 12 and 13: wrong answers first, then right ones, to a model."""

import re

import nbformat
import pytest
import solutions
import stripped
from minutes import core_of
from notebook_runner import FOLDER, run_notebook

from ir50p_lab.course.checking.tasks import of_notebook
from ir50p_lab.course.robot.catalogue import is_function, stays

#: Of each function: what the student first writes for a part of the solution, and what is said of it.
WRONG = {
    "least_squares": [("(len(y) - A.shape[1])", "len(y)", "divided by n:"), ("np.sqrt(", "(", "variances, squares")],
    "regressor": [
        ("[0, g * c23, g * c23]", "[0, 0, g * c23]", "the shoulder carries the forearm as well"),
        ("Y[joint, 10 + 2 * joint] = qd", "Y[joint, 10 + joint] = qd", "not yet"),
        ("g * c2,", "-g * c2,", "wrong sign"),
    ],
    "fit_percent": [("100 * ", "", "it is a share, from 0 to 1"), ("1 - missed", "missed", "what is missed")],
}


def gone_through(name, home, wrong=WRONG, first=()):
    """Outputs of the core of a notebook, as text, with each function first written wrongly, then rightly.

    first: earlier functions that the student has written before.
    """
    notebook = stripped.read(FOLDER / f"{name}.ipynb")
    checked = [
        f'from ir50p_lab.course import check\n\n\n{solutions.source(one)}\n\ncheck("{one}", {one})' for one in first
    ]
    cells, expected = list(map(nbformat.v4.new_code_cell, checked)), []
    for cell in core_of(notebook.cells):
        asked = re.match(r'.*^(?:\w+ = )?check\("(\w+)", [a-z]\w+\)', cell.source, re.M | re.S)
        if cell.cell_type == "code" and asked and is_function(asked[1]):
            right = solutions.source(asked[1])
            imports = "".join(line + "\n" for line in cell.source.splitlines() if line.startswith("from "))
            for old, new, words in wrong[asked[1]]:
                assert old in right
                spoilt = f'{imports}{right.replace(old, new)}\n\ncheck("{asked[1]}", {asked[1]})'
                cells.append(nbformat.v4.new_code_cell(spoilt))
                expected.append(words)
            cell.source = f'{imports}{right}\n\ncheck("{asked[1]}", {asked[1]})'
            expected.append(f"from now on my_robot.{asked[1]} is this")
        elif cell.cell_type == "code" and asked and stays(asked[1]):
            cell.source = f'{of_notebook(asked[1]).solution_text}\n\n{asked[1]} = check("{asked[1]}", {asked[1]})'
        cells.append(cell)
    notebook.cells = cells
    run = run_notebook(notebook, variables={"IR50P_HOME": str(home)}, push=False)
    assert not run.error, run.error
    outputs = [output for cell in run.cells for output in cell.get("outputs", [])]
    said = "".join(output.get("text", "") + str(output.get("data", "")) for output in outputs)
    for words in expected:
        assert words in said, words
    return said


@pytest.mark.notebook
def test_a_student_fits_a_model_and_keeps_it(tmp_path):
    gone_through("12_identification", tmp_path)
    assert "my_robot.regressor: yours" in (said := gone_through("13_is_the_model_good", tmp_path))
    assert "Kept: model-1" in said
    assert (tmp_path / "results" / "model-1.model").exists()
