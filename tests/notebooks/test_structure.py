"""The shape of every notebook: short cells, an opening, exercises, a slider, no stored outputs."""

import ast
import re
from statistics import median

import pytest
from notebook_runner import FOLDER, NOTEBOOKS

from ir50p_lab.course.exercises import exercises
from ir50p_lab.course.exercises._catalogue import everything


def cells(notebook, kind):
    return [cell for cell in notebook.cells if cell.cell_type == kind]


def lines(cell):
    """Return all lines that a reader sees, empty ones too."""
    return len(cell.source.splitlines())


def checked(notebook):
    return re.findall(r"""^check\(\s*["'](.+?)["']""", "\n".join(c.source for c in cells(notebook, "code")), re.M)


def test_there_are_notebooks():
    numbers = [path.name[:2] for path in NOTEBOOKS]
    assert numbers[:4] == ["00", "01", "02", "03"]
    assert len(set(numbers)) == len(numbers)
    assert sorted(FOLDER.glob("*.ipynb")) == NOTEBOOKS


def test_cells(notebook):
    sizes = [lines(cell) for cell in cells(notebook, "code")]
    assert median(sizes) < 8
    assert max(sizes) <= 25
    assert all(cell.source.strip() for cell in cells(notebook, "code")), "an empty code cell"


def test_stored_nothing(notebook):
    for cell in cells(notebook, "code"):
        assert cell.outputs == [] and cell.execution_count is None
    assert notebook.metadata.kernelspec.name == "python3"
    assert set(notebook.metadata) <= {"kernelspec", "language_info"}
    assert "widgets" not in notebook.metadata


def test_ids(path, notebook):
    ids = [cell.id for cell in notebook.cells]
    assert len(set(ids)) == len(ids)
    assert all(re.fullmatch(r"[a-z]+(-[a-z0-9]+)+", i) for i in ids), "ids are made by hand: pose-07"
    assert len({i.partition("-")[0] for i in ids}) == 1


def test_opening(path, notebook):
    first = notebook.cells[0]
    assert first.cell_type == "markdown"
    assert re.match(rf"# {path.name[:2]} · \S", first.source)
    for part in (r"\*\*You will\*\*", r"\*\*You need\*\*", r"about \d+ minutes", r"\*\*Runs without the arm:\*\* yes"):
        assert re.search(part, first.source), f"the opening lacks {part}"


def test_closing(notebook):
    last = notebook.cells[-1]
    assert last.cell_type == "markdown"
    assert re.search(r"^## What you know now$", last.source, re.M)


def test_arm(notebook):
    assert any("arm = load_arm()" in cell.source for cell in cells(notebook, "code")[:3])


def test_slider(notebook):
    assert any(re.search(r"\blive\(", cell.source) for cell in cells(notebook, "code"))


def test_exercises(path, notebook):
    names = checked(notebook)
    assert len(set(names)) == len(names)
    assert set(names) <= set(exercises())
    own = [exercise.name for stem, exercise in everything() if stem == path.stem]
    assert names == own, "the exercises of this notebook, in their order"


def test_exercises_are_stubs(notebook):
    for cell in cells(notebook, "code"):
        if re.search(r"^check\(", cell.source, re.M):
            assert re.search(r"^answer = \.\.\.|^answer = \(\.\.\.|^def answer\(.*\):\s*\.\.\.", cell.source, re.M)
            assert lines(cell) <= 6


def test_plain_python(notebook):
    for cell in cells(notebook, "code"):
        compile(cell.source, cell.id, "exec")  # no magics, no shell
        assert "pyplot" not in cell.source  # figures are objects here, see course/widgets
        assert "linalg.inv" not in cell.source
        assert not cell.metadata, "tags and other metadata are not used"


def test_figures_have_units(notebook):
    """Every label of an axis that stands in a notebook names its unit in brackets."""
    for cell in cells(notebook, "code"):
        for label in re.findall(r"""[xyz]label\(?=?\s*["']([^"']*)["']""", cell.source):
            assert re.search(r"\[.+\]", label), f"axis label {label!r} has no [unit]"


@pytest.mark.parametrize("stem", sorted({stem for stem, _ in everything()}))
def test_every_exercise_has_its_notebook(stem):
    assert (FOLDER / f"{stem}.ipynb").is_file()


def top_level_names(source):
    """Return the names that a cell binds, other than by import: assignments, loops, functions."""
    found = set()

    def visit(node):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
            return
        if isinstance(node, ast.Lambda | ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp):
            return
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
        for child in ast.iter_child_nodes(node):
            visit(child)

    visit(ast.parse(source))
    return found


def names_in_functions(source):
    """Return {function: names it reads} for the functions that a cell defines."""
    return {
        node.name: {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}
        - {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        - {arg.arg for arg in ast.walk(node.args) if isinstance(arg, ast.arg)}
        for node in ast.parse(source).body
        if isinstance(node, ast.FunctionDef)
    }


def lost_names(sources):
    """Return (cell, name, later cell) where a panel's update reads a name that a later cell binds anew.

    Run from top to bottom, all is well; but the panel above then moves the figure below, or nothing.
    """
    lost, known = [], {}
    for i, source in enumerate(sources):
        functions = names_in_functions(source)
        known |= functions
        if not re.search(r"\blive\(", source):
            continue
        reads, todo = set(), list(functions)
        while todo:
            new = known.get(todo.pop(), set()) - reads
            reads |= new
            todo += new
        for k, later in enumerate(sources[i + 1 :], start=i + 1):
            lost += [(i, name, k) for name in sorted(reads & top_level_names(later))]
    return lost


def test_panels_keep_their_names(notebook):
    sources = [cell.source for cell in cells(notebook, "code")]
    lost = [f"code cell {i}: `{name}` is bound anew in code cell {k}" for i, name, k in lost_names(sources)]
    assert not lost, "the sliders of an earlier panel stop working:\n" + "\n".join(lost)


def test_lost_names_are_found():
    panel = "a, b = 1, 2\ndef f(x):\n    c = a + x\n    return g(c)\nlive(figure, f, x=(0, 1, 0.1, 0))"
    helper = "def g(c):\n    return c + d"
    assert lost_names([helper, panel, "b = 3\nc = 4\nx = 5"]) == []
    assert lost_names([helper, panel, "for a in range(3):\n    pass"]) == [(1, "a", 2)]
    assert lost_names([helper, panel, "[a for a in range(3)]", "d = 1"]) == [(1, "d", 3)]
    assert lost_names([helper, panel, "def g(): ..."]) == [(1, "g", 2)]
