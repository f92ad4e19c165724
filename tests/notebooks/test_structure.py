"""The shape of every notebook: short cells, an opening, exercises, a slider."""

import ast
import re
from itertools import pairwise

import nbformat
from minutes import core_of
from notebook_runner import FOLDER, NOTEBOOKS, REWRITTEN

from ir50p_lab.course.checking.numbers import everything
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.lab_book.names import titles
from ir50p_lab.course.robot.catalogue import NOTEBOOKS as FUNCTIONS
from ir50p_lab.course.robot.catalogue import STAGES, is_function

NUMBERS = {number.name: number.notebook for number in everything()}


def cells(notebook, kind):
    return [cell for cell in notebook.cells if cell.cell_type == kind]


def lines(cell):
    """Return all lines that a reader sees, empty ones too."""
    return len(cell.source.splitlines())


def checked(notebook):
    return re.findall(r"""^check\(\s*["'](.+?)["']""", "\n".join(c.source for c in cells(notebook, "code")), re.M)


def is_rewritten(path):
    return path.name[:2] in REWRITTEN


def test_there_are_notebooks():
    numbers = [path.name[:2] for path in NOTEBOOKS]
    assert set(REWRITTEN) <= set(numbers)
    assert len(set(numbers)) == len(numbers)
    assert sorted(FOLDER.glob("*.ipynb")) == NOTEBOOKS


CLAIM = re.compile(r"^\s*(?:assert |claim\()", re.M)
SHOWS = re.compile(
    r"^(?:print|predict|measured|claim|check|live|note|keep|Image)\(|^    print\(|\.progress\(\)|^[\w, ]+ = (?:check|(?:vision\.)?open_camera)\(",
    re.M,
)


def short_cells(path, notebook):
    """One idea a cell: short, of lines that need no scrolling, and at most two claims."""
    for cell in cells(notebook, "code"):
        assert cell.source.strip(), "an empty code cell"
        assert lines(cell) <= 15, cell.source
        assert all(len(line) <= 100 for line in cell.source.splitlines()), cell.source
        assert len(CLAIM.findall(cell.source)) <= 2, cell.source


def exercises_of_numbers_are_few_and_their_own(path, notebook):
    asked = [name for name in checked(notebook) if name in NUMBERS]
    assert asked == [name for name, stem in NUMBERS.items() if stem == path.stem], "those of this notebook, in order"
    assert len(asked) <= 2


def predictions(path, notebook):
    code = "\n".join(cell.source for cell in cells(notebook, "code"))
    assert 1 <= len(re.findall(r"^predict\(", code, re.M)) <= 6
    for name in re.findall(r'^predict\("([^"]+)", \.\.\.', code, re.M):
        assert f'measured("{name}"' in code, f"{name} is predicted and never measured"


def shows_something(source):
    last = ast.parse(source).body[-1]
    return bool(SHOWS.search(source)) or isinstance(last, ast.Expr)


def code_cells_show_something(path, notebook):
    """Imports, and cells that only define what the next one runs, may be silent."""
    silent = [cell for cell in cells(notebook, "code")[1:] if not shows_something(cell.source)]
    for cell in silent:
        following = notebook.cells[notebook.cells.index(cell) + 1]
        assert following.cell_type == "code" or lines(cell) <= 2, cell.source


def imports_are_few_and_from_the_rooms_themselves(path, notebook):
    """From at most six modules of the package, views from one room, and never from inside a room."""
    trees = [ast.parse(cell.source) for cell in cells(notebook, "code")]
    nodes = [node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    modules = {node.module for node in nodes if node.module.startswith("ir50p_lab")}
    depth = {name: name.count(".") for name in modules}
    deep = [name for name in modules if depth[name] > (2 if name.startswith("ir50p_lab.course.") else 1)]
    assert not deep, "take it from the face of its room"
    assert len(modules) <= 6, modules
    assert sum(count == 2 for count in depth.values()) <= 1, "views come from one room"


def functions_are_asked_for_in_their_notebook(path, notebook):
    asked = tuple(name for name in checked(notebook) if is_function(name))
    assert asked == tuple(one for name in FUNCTIONS.get(path.name[:2], ()) for one in (*STAGES.get(name, ()), name))
    for cell in cells(notebook, "code"):
        for name in re.findall(r'^check\("([\w.]+)", \w+\)', cell.source, re.M):
            if is_function(name):
                wanted = task(name)
                begin = rf"^(?:class {wanted.function}:\n.*?def __init__\(self, |def {wanted.function}\()"
                defined = re.search(begin + r"([^)]*)\):", cell.source, re.M | re.S)
                assert tuple(re.findall(r"(?:^|,\s+)(\w+)", defined[1])) == wanted.signature
                assert "..." in cell.source
                assert not imported_names(cell.source), "a function is taken with its cell, and may import NumPy alone"


def test_no_text_names_a_notebook_that_is_not_there():
    """Numbers of notebooks to come may be named (README says so); links to files may not lead nowhere."""
    for path in NOTEBOOKS:
        for target in re.findall(r"\]\(([^)#]+\.ipynb)\)", path.read_text(encoding="utf-8")):
            assert (FOLDER / target).exists(), f"{path.name} links to {target}"


def sections_are_marked(path, notebook):
    for cell in cells(notebook, "markdown"):
        for mark in re.findall(r"^#{2,3} .*$", cell.source, re.M):
            if (mark.startswith("## ") and "What you know now" not in mark) or "*(" in mark:
                (word,) = re.findall(r" \*\((core|more)\)\*$", mark)
                assert word in cell.metadata.get("tags", []) and cell.source.startswith(mark), mark


def core_meets_no_gap(path, notebook):
    """No cell of the core reads a name that only a section marked more has made."""
    core, bound, skipped = {cell.id for cell in core_of(notebook.cells)}, set(), set()
    for cell in cells(notebook, "code"):
        made = top_level_names(cell.source) | imported_names(cell.source)
        if cell.id in core:
            read = {node.id for node in ast.walk(ast.parse(cell.source)) if isinstance(node, ast.Name)}
            assert not read & skipped - bound - made, f"{cell.id} reads what more makes"
            bound |= made
        else:
            skipped |= made


def imported_names(source):
    """Return the names that a cell imports."""
    found = [node.names for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Import | ast.ImportFrom)]
    return {(one.asname or one.name).partition(".")[0] for names in found for one in names}


def ids(path, notebook):
    ids = [cell.id for cell in notebook.cells]
    assert len(set(ids)) == len(ids)
    assert all(re.fullmatch(r"[a-z]+(-[a-z0-9]+)+", i) for i in ids), "ids are made by hand: pose-07"
    assert len({i.partition("-")[0] for i in ids}) == 1


def opening(path, notebook):
    first = notebook.cells[0]
    assert first.cell_type == "markdown"
    assert re.match(rf"# {path.name[:2]} · \S", first.source)
    will, runs = r"\*\*You will( be able to)?\*\*", r"\*\*Runs without the arm(:\*\*|\*\*:) yes"
    minutes = () if path.name.startswith("A1") else (r"about \d+ minutes",)  # A1 is looked up, not read
    for part in (will, r"\*\*You need\*\*", *minutes, runs):
        assert re.search(part, first.source), f"the opening lacks {part}"


def closing(path, notebook):
    last = notebook.cells[-1]
    assert last.cell_type == "markdown"
    assert re.search(r"^## What you know now$", last.source, re.M)


def arm(path, notebook):
    if path.name[:2] in ("00", "19", "A1"):
        return  # the machine of the course, whatever arm comes later; drawn arms; a dictionary, whose sections stand alone
    assert any("arm = load_arm()" in cell.source for cell in cells(notebook, "code")[:3])


def something_moves(path, notebook):
    if path.name.startswith("A1"):
        return
    assert any(re.search(r"\b(live|LiveArm)\(", cell.source) for cell in cells(notebook, "code"))


def exercises_in_order(path, notebook):
    names = checked(notebook)
    assert len(set(names)) == len(names)
    assert all(name in NUMBERS or is_function(name) for name in names)


def exercises_are_stubs(path, notebook):
    if path.name.startswith("A"):
        return
    for cell in cells(notebook, "code"):
        if re.search(r"^check\(", cell.source, re.M):
            assert re.search(r"^answer = \.\.\.", cell.source, re.M)
            assert lines(cell) <= 6


def plain_python(path, notebook):
    for cell in cells(notebook, "code"):
        compile(cell.source, cell.id, "exec")  # no magics, no shell
        assert "pyplot" not in cell.source  # figures are objects here, see course/draw/widgets
        assert "linalg.inv" not in cell.source


def figures_have_units(path, notebook):
    """Every label of an axis that stands in a notebook names its unit in brackets."""
    for cell in cells(notebook, "code"):
        for label in re.findall(r"""[xyz]label\(?=?\s*["']([^"']*)["']""", cell.source):
            assert re.search(r"\[.+\]", label), f"axis label {label!r} has no [unit]"


def test_each_notebook_leads_to_the_next():
    numbered = [path for path in NOTEBOOKS if path.name[0] != "A"]
    for path, after in pairwise(numbered):
        text = nbformat.read(path, as_version=4).cells[-1].source
        title = nbformat.read(after, as_version=4).cells[0].source.splitlines()[0].removeprefix("# ")
        assert text.endswith(f"**Next**: [{title}]({after.name})"), path.name


def test_every_exercise_has_its_notebook():
    assert set(NUMBERS.values()) <= {path.stem for path in NOTEBOOKS}


def test_every_number_of_the_lab_book_has_a_title():
    """The report says in words what was predicted or measured: names.txt."""
    asked = set()
    for path in NOTEBOOKS:
        for cell in cells(nbformat.read(path, as_version=4), "code"):
            asked.update(re.findall(r'^ *(?:predict|measured)\("([\w.]+)"', cell.source, re.M))
    assert len(asked) > 100 and asked <= set(titles()), asked - set(titles())


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


def panels_keep_their_names(path, notebook):
    sources = [cell.source for cell in cells(notebook, "code")]
    lost = [f"code cell {i}: `{name}` is bound anew in code cell {k}" for i, name, k in lost_names(sources)]
    assert not lost, "the sliders of an earlier panel stop working:\n" + "\n".join(lost)


RULES = (
    short_cells,
    exercises_of_numbers_are_few_and_their_own,
    ids,
    opening,
    closing,
    arm,
    something_moves,
    exercises_in_order,
    plain_python,
    figures_have_units,
    panels_keep_their_names,
)
RULES_OF_THE_LAB_BOOK = (
    predictions,
    code_cells_show_something,
    functions_are_asked_for_in_their_notebook,
    sections_are_marked,
    core_meets_no_gap,
    imports_are_few_and_from_the_rooms_themselves,
)


def test_a_notebook_keeps_the_rules(path, notebook):
    for rule in (*RULES, *(RULES_OF_THE_LAB_BOOK if is_rewritten(path) else [exercises_are_stubs])):
        rule(path, notebook)


def test_lost_names_are_found():
    panel = "a, b = 1, 2\ndef f(x):\n    c = a + x\n    return g(c)\nlive(figure, f, x=(0, 1, 0.1, 0))"
    helper = "def g(c):\n    return c + d"
    assert lost_names([helper, panel, "b = 3\nc = 4\nx = 5"]) == []
    assert lost_names([helper, panel, "for a in range(3):\n    pass"]) == [(1, "a", 2)]
    assert lost_names([helper, panel, "[a for a in range(3)]", "d = 1"]) == [(1, "d", 3)]
    assert lost_names([helper, panel, "def g(): ..."]) == [(1, "g", 2)]
