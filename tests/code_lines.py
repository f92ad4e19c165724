"""Code lines beside their budgets, of each folder of the package, of all of it and of the tests:
``python tests/code_lines.py``. Over budget, it fails.

A code line has code on it: blank lines, comments and docstrings do not count. JavaScript counts, what was built from it
does not.
"""

import ast
import io
import re
import sys
import tokenize
from pathlib import Path

BUILT = {"live_arm.js"}  # bundles
NOT_OURS = {"node_modules", "__pycache__"}
ROOT = Path(__file__).parents[1]
PACKAGE, TESTS = ROOT / "ir50p_lab", ROOT / "tests"
BUDGETS = {  # what there is; the design asks for less in bench, course, launcher, root and tests
    "modelling": 1150,
    "signals": 333,
    "controllers": 284,
    "simulation": 456,
    "bench": 2384,
    "identification": 1486,
    "vision": 2282,
    "course": 9158,  # without the next two
    "course/publishing": 698,
    "course/grading": 566,
    "launcher": 615,
    "root": 359,
}
BUDGET_OF_ALL, BUDGET_OF_TESTS, BUDGET_OF_SENTENCES = 19_771, 20_402, 2_000
LINES_A_TEXT = 75  # a function more than the twenty that BUDGET_OF_SENTENCES is for
_NO_CODE = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}


def python_lines(source):
    """Count the lines of a Python source that hold code."""
    code = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in _NO_CODE:
            code |= set(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            code -= set(range(node.lineno, node.end_lineno + 1))  # docstrings
    return len(code)


def javascript_lines(source):
    """Count the lines of a JavaScript source that hold code; a comment beside code is code."""
    source = re.sub(r"^\s*/\*.*?\*/", "", source, flags=re.MULTILINE | re.DOTALL)
    return sum(1 for line in source.splitlines() if line.strip() and not line.strip().startswith("//"))


def folder_lines(package=PACKAGE):
    """{folder: code lines}; files beside the folders are `root`."""
    found = dict.fromkeys(BUDGETS, 0) if package == PACKAGE else {}
    for path in sorted(package.rglob("*")):
        parts = path.relative_to(package).parts
        count = {".py": python_lines, ".js": javascript_lines}.get(path.suffix)
        if count and path.name not in BUILT and not NOT_OURS & set(parts):
            folder = parts[0] if len(parts) > 1 else "root"
            folder = inner if (inner := "/".join(parts[:2])) in BUDGETS else folder
            found[folder] = found.get(folder, 0) + count(path.read_text("utf-8"))
    return found


def sentences():
    """Lines of the texts that `check` speaks from, beside the functions that students write, and how many they may have."""
    texts = list(PACKAGE.glob("course/*/functions/*.txt"))
    more = sum("." not in path.stem for path in texts) - 20  # a stage of a class is no function
    lines = sum(len(path.read_text("utf-8").splitlines()) for path in texts)
    return lines, BUDGET_OF_SENTENCES + max(more, 0) * LINES_A_TEXT


def rows(product, tests):
    """(what, code lines, budget) of each folder, of all of the product and of all tests."""
    yield from (
        (folder, lines, BUDGETS.get(folder, 0)) for folder, lines in product.items()
    )  # a new folder has no budget
    yield "all", sum(product.values()), BUDGET_OF_ALL
    yield "tests", sum(tests.values()), BUDGET_OF_TESTS
    yield "sentences", *sentences()


def too_large(product, tests):
    """A sentence for each row that has more lines than it may."""
    for what, lines, budget in rows(product, tests):
        if lines > budget:
            yield f"{what}: {lines} code lines, {lines - budget} more than the {budget} it may have: leave some out"


def main():
    """Print the table; return 1 if a row is too large, else 0."""
    found = folder_lines(), folder_lines(TESTS)
    print(f"{'folder':<16}{'lines':>7}{'budget':>8}{'over':>7}")
    for what, lines, budget in rows(*found):
        print(f"{what:<16}{lines:>7}{budget:>8}{max(lines - budget, 0) or '':>7}")
    too_many = list(too_large(*found))
    for sentence in too_many:
        print(sentence, file=sys.stderr)
    return 1 if too_many else 0


if __name__ == "__main__":
    sys.exit(main())
