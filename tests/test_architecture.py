"""Modules import in one direction, imports inside functions included; no class name stands for two things."""

import ast
import collections
import graphlib
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "ir50p_lab"


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


def test_no_import_circle():
    trees = modules()
    home = homes(trees)
    assert home  # the packages are read as they are written
    graph = {name: set(imports(tree, trees, home)) - {name} for name, tree in trees.items()}
    graphlib.TopologicalSorter(graph).prepare()  # raises CycleError with the circle


def test_no_class_name_twice():
    names = (node.name for tree in modules().values() for node in ast.walk(tree) if isinstance(node, ast.ClassDef))
    counted = collections.Counter(names)
    del counted["PID"]  # the stand-in for the student's class bears the name of the student's
    assert [name for name, count in counted.items() if count > 1] == []
