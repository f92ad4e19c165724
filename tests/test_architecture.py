"""Modules import in one direction, imports inside functions and by `importlib` included; no class name stands for two things."""

import ast
import collections
import functools
import graphlib
import re
import sys
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "ir50p_lab"
#: What each folder builds on, beside the files next to the folders; `launcher` is the standard library's and ours alone.
MODELS = {"launcher", "modelling", "signals"}
LAYERS = {
    "launcher": set(),
    "signals": {"modelling"},
    "modelling": {"launcher"},
    "controllers": MODELS,
    "simulation": MODELS | {"controllers"},
    "bench": MODELS | {"controllers", "simulation"},
    "identification": MODELS | {"controllers", "simulation"},
    "vision": {"modelling"},
    "vision.reaching": MODELS | {"controllers", "bench", "vision"},  # the last step, alone
    "course": MODELS | {"controllers", "simulation", "bench", "identification", "vision", "vision.reaching"},
    "course.grading": {"course"},
    "course.publishing": MODELS  # commands; the book's reference names what all subjects offer
    | {"controllers", "simulation", "bench", "identification", "vision", "course"},
}
#: Rooms of `course` below all subjects, and what each builds on there.
ROOMS = {
    "draw": set(),
    "lab_book": {"draw"},
    "printed": set(),
    "robot": {"draw"},
    "checking": {"lab_book", "robot"},
    "my_robot": {"robot", "checking"},  # a file
    "live_arm": {"draw", "robot", "checking", "my_robot"},
}
#: They look a function or an exercise up by its name, in the room of its subject: from below, and on purpose.
FINDERS = {"ir50p_lab.course.checking.tasks", "ir50p_lab.course.checking.numbers"}
#: No command and no page: what stands without the course.
SUBJECTS = {"modelling", "signals", "controllers", "simulation", "bench", "identification", "vision"}
#: What else a subject builds on: the motion that its model is fitted to; frames and Jacobian of the arm's links; 11's circle.
SUBJECTS_TOO = {
    "camera": {"images"},
    "torque": {"fitting"},
    "dynamics": {"kinematics"},
    "at_the_bench": {"kinematics", "motion"},
    "reaching": {"images", "camera", "kinematics", "torque"},
    "unknown": {"images", "torque", "at_the_bench", "camera", "fitting", "motion"},
}


@functools.cache
def modules():
    """{dotted name: syntax tree}."""
    found = {}
    for path in PACKAGE.rglob("*.py"):
        parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
        found[".".join(parts).removesuffix(".__init__")] = ast.parse(path.read_text("utf-8"))
    return found


def homes(trees):
    """{(package, name): module} of the names that packages load on first use."""
    found = {}
    for package, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.keyword) and node.arg == "submod_attrs":
                for module, names in ast.literal_eval(node.value).items():
                    found |= {(package, name): f"{package}.{module}" for name in names}
    return found


def imports(tree, trees, home):
    """Modules of the package that a module imports anywhere."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module in trees:
            for name in (alias.name for alias in node.names):
                inner = f"{node.module}.{name}"
                yield inner if inner in trees else home.get((node.module, name), node.module)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in trees)
        elif isinstance(node, ast.Call) and ast.unparse(node.func) in ("importlib.import_module", "import_module"):
            wanted = re.compile(named_by(node.args[0]))
            yield from filter(wanted.fullmatch, trees)


def named_by(argument):
    """What `import_module` is handed as a pattern: a literal, or an f-string with a fixed beginning; else of nothing."""
    parts = argument.values if isinstance(argument, ast.JoinedStr) else [argument]
    if not isinstance(parts[0], ast.Constant):
        return "(?!)"
    return "".join(re.escape(part.value) if isinstance(part, ast.Constant) else r"[\w.]+" for part in parts)


def test_no_import_circle():
    trees = modules()
    home = homes(trees)
    assert home  # the packages are read as they are written
    graph = {name: set(imports(tree, trees, home)) - {name} for name, tree in trees.items()}
    graphlib.TopologicalSorter(graph).prepare()  # raises CycleError with the circle


def layer(module):
    """The folder that a module belongs to; "" for files beside the folders."""
    parts = module.split(".")[1:]
    folders = (".".join(parts[:2]), *parts[:1])
    return next((name for name in folders if name in LAYERS), "")


def test_imports_point_one_way_and_a_subject_stands_without_the_course():
    assert not any("course" in LAYERS[name] for name in SUBJECTS)
    trees = modules()
    home = homes(trees)
    for name, tree in trees.items():
        above = set(LAYERS) - LAYERS.get(layer(name), set()) - {layer(name)}
        if name == "ir50p_lab.__main__":
            above -= {"launcher"}
        for other in imports(tree, trees, home):
            assert layer(other) not in above, f"{name} imports {other}"


def test_rooms_of_the_course_build_on_what_lies_below():
    trees = modules()
    home = homes(trees)
    for name, tree in trees.items():
        if layer(name) == "course" and name != "ir50p_lab.course":
            room = name.split(".")[2]
            below = {room} | ROOMS.get(room, set(ROOMS) | SUBJECTS_TOO.get(room, set()))
            found = {other for other in imports(tree, trees, home) if layer(other) == "course"} - {"ir50p_lab.course"}
            if name in FINDERS:
                found = {other for other in found if other.split(".")[2] in ROOMS}
            assert {other for other in found if other.split(".")[2] not in below} == set(), f"{name} reaches up"


def test_no_room_bears_a_public_name():
    """A folder would hide the function, or the package beside `course`."""
    rooms = {path.name for path in (PACKAGE / "course").iterdir() if path.is_dir()}
    taken = {name for package, name in homes(modules()) if package == "ir50p_lab.course"} | set(LAYERS)
    assert rooms >= set(ROOMS) - {"my_robot"} and rooms & taken == set()


def test_the_launcher_starts_with_the_standard_library_alone():
    trees = modules()
    for name in ("ir50p_lab", "ir50p_lab.__main__", *(name for name in trees if layer(name) == "launcher")):
        for node in trees[name].body:  # what it imports in functions runs in .venv, or is tried
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                module = node.module if isinstance(node, ast.ImportFrom) else node.names[0].name
                own = module.startswith("ir50p_lab.launcher")
                assert own or module.split(".")[0] in sys.stdlib_module_names, f"{name} imports {module}"


def test_no_class_name_twice():
    names = (node.name for tree in modules().values() for node in ast.walk(tree) if isinstance(node, ast.ClassDef))
    counted = collections.Counter(names)
    del counted["PID"]  # the stand-in for the student's class bears the name of the student's
    assert [name for name, count in counted.items() if count > 1] == []


def test_every_name_has_a_reader():
    """Functions, classes and constants that stand in one place only, of package, tests and notebooks, are read nowhere."""
    root = PACKAGE.parent
    places = [
        *PACKAGE.rglob("*.py"),
        *PACKAGE.rglob("*.txt"),
        *PACKAGE.rglob("src/*.js"),
        *PACKAGE.glob("course/draw/*.js"),
    ]
    places += [*(root / "tests").rglob("*.py"), *(root / "notebooks").glob("*.ipynb")]
    counted = collections.Counter(word for path in places for word in re.findall(r"\w+", path.read_text("utf-8")))
    named = set()
    for tree in modules().values():
        named |= {node.name for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        targets = [target for node in tree.body if isinstance(node, ast.Assign) for target in node.targets]
        named |= {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
    hooks = r"__\w+__|_repr_\w+_|visit_\w+|inline_math|block_math|latex_environment"  # of IPython, ast, nbconvert
    hooked = re.compile(hooks)
    assert sorted(name for name in named if counted[name] < 2 and not hooked.fullmatch(name)) == []
