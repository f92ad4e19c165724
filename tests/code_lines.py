"""Code lines beside the design's budgets, of each folder of the package, of all of it and of the tests:
``python tests/code_lines.py``. It fails above the budget, or where there was more already, above what there was.

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
FOLDERS = {  # their budgets are the design's; nobody raises one
    "modelling": 1290,
    "signals": 380,
    "controllers": 309,
    "simulation": 460,
    "bench": 2220,
    "identification": 1440,
    "vision": 2080,
    "course": 7650,  # without the next two
    "course/publishing": 590,
    "course/grading": 540,
    "launcher": 530,
    "root": 230,
}
BUDGETS = FOLDERS | {"all": 17_719, "tests": 20_000, "sentences": 2_800}
#: What was over its budget on 30 November 2026. A figure here only falls: set it to what is left after each cut.
STILL = {
    "bench": 2384,
    "identification": 1473,
    "vision": 2281,
    "course": 8840,
    "course/publishing": 698,
    "launcher": 613,
    "root": 359,
    "all": 19_388,
    "tests": 20_241,
}
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
    found = dict.fromkeys(FOLDERS, 0) if package == PACKAGE else {}
    for path in sorted(package.rglob("*")):
        parts = path.relative_to(package).parts
        count = {".py": python_lines, ".js": javascript_lines}.get(path.suffix)
        if count and path.name not in BUILT and not NOT_OURS & set(parts):
            folder = parts[0] if len(parts) > 1 else "root"
            folder = inner if (inner := "/".join(parts[:2])) in FOLDERS else folder
            found[folder] = found.get(folder, 0) + count(path.read_text("utf-8"))
    return found


def sentences():
    """Lines of the texts that `check` speaks from, beside the functions that students write."""
    texts = PACKAGE.glob("course/*/functions/*.txt")
    return sum(len(path.read_text("utf-8").splitlines()) for path in texts)


def count_all():
    """{row of the table: its lines}."""
    product = folder_lines()
    more = {"all": sum(product.values()), "tests": sum(folder_lines(TESTS).values()), "sentences": sentences()}
    return product | more


def too_large(lines):
    """A sentence for each row that has more lines than it may; a new folder has no budget."""
    for what, count in lines.items():
        most = max(STILL.get(what, 0), BUDGETS.get(what, 0))
        if count > most:
            yield f"{what}: {count} lines, {count - most} more than the {most} it may have: leave some out"


def main():
    """Print the table; return 1 if a row has more lines than it may, else 0."""
    lines = count_all()
    print(f"{'folder':<18}{'lines':>7}{'budget':>8}{'over':>7}{'at most':>9}")
    for what, count in lines.items():
        budget = BUDGETS.get(what, 0)
        print(f"{what:<18}{count:>7}{budget:>8}{max(count - budget, 0) or '':>7}{STILL.get(what, budget):>9}")
    over = lines["all"] - BUDGETS["all"]
    if over > 0:
        print(f"The package is {over} lines, {over / BUDGETS['all']:.1%}, over the design's budget.")
    for sentence in too_large(lines):
        print(sentence, file=sys.stderr)
    return 1 if any(too_large(lines)) else 0


if __name__ == "__main__":
    sys.exit(main())
