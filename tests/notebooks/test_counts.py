"""What README, docs and notebooks count is what there is: notebooks, functions, subjects, gigabytes, minutes at the arm.

Hours and minutes are `minutes.py`'s, predictions `predictions.py`'s, what the tab loads `tests/browser/a_visitor_in_the_tab.py`'s.
"""

import inspect
import re
from importlib.metadata import distributions

import nbformat
import pytest
import yaml
from code_lines import BUDGETS, folder_lines
from notebook_runner import NOTEBOOKS, ROOT, run_notebook
from packaging.requirements import Requirement

from ir50p_lab.bench.protocol import WATCHDOG_MS
from ir50p_lab.course.fitting.gripper_views import motions
from ir50p_lab.course.publishing import site
from ir50p_lab.course.robot import catalogue
from ir50p_lab.modelling import IR50P

ONES = "zero one two three four five six seven eight nine".split()
TENS = ["", "", "twenty-", "thirty-", "forty-"]


def spelled(number):
    return (TENS[number // 10] + ONES[number % 10]).removesuffix("-zero")


def text(name):
    """A file, or the cells of a notebook by its number, without breaks of lines."""
    if name.isdigit():
        (path,) = (one for one in NOTEBOOKS if one.name.startswith(name))
        cells = nbformat.read(path, as_version=4).cells
        return " ".join(" ".join(cell.source for cell in cells).split())
    return " ".join((ROOT / name).read_text("utf-8").split())


LAST = list(catalogue.NOTEBOOKS)[-1]
*TO, BESIDE = site.NOTEBOOKS
SUBJECTS = spelled(sum("course" not in name and name not in ("launcher", "root") for name in folder_lines()))
PYODIDE = yaml.safe_load((ROOT / ".github/workflows/pages.yml").read_text("utf-8"))["jobs"]["site"]["env"]["PYODIDE"]
WATCHDOG = f"{WATCHDOG_MS / 1000:g}"
LONGEST = inspect.signature(run_notebook).parameters["timeout"].default
TOLD = [
    ("README.md", r"a browser tab \((.*?)\)", f"{TO[0]} to {TO[-1]}, and {BESIDE}"),
    ("docs/where_it_runs.md", r"(\d\d to \d\d, and (?:of )?\d\d) except", f"{TO[0]} to {TO[-1]}, and {BESIDE}"),
    ("README.md", r"In each of 00 to (\d+)", LAST),
    ("docs/with_the_arm.md", r"00 to 09 and 12 to (\d+)", LAST),
    ("00", r"You write them yourself\*\*, in 00 to (\d+)", LAST),
    ("00", r"made of (\S+) functions", spelled(len(catalogue.ORDER))),
    ("README.md", r"in (\w+) subjects", SUBJECTS),
    ("docs/developing.md", r"[Tt]he (\w+) subjects", SUBJECTS),
    ("docs/developing.md", r"counted .*?, (\S+) at most", f"{BUDGETS['sentences']:,}"),
    ("docs/developing.md", r"without a warning within (\d+) s", str(LONGEST)),
    ("docs/developing.md", r"no command came for (.*?) s", WATCHDOG),
    ("docs/on_the_wall.md", r"brakes by itself within (.*?) s", WATCHDOG),
    ("docs/developing.md", r"--pyodide (\S+) --to", PYODIDE),
]


@pytest.mark.parametrize(("name", "told", "number"), TOLD)
def test_what_is_told_is_what_there_is(name, told, number):
    found = re.findall(told, text(name))
    assert found and {one.replace("of ", "") for one in found} == {number}, found


@pytest.mark.parametrize("number", catalogue.NOTEBOOKS)
def test_the_instructor_is_told_what_each_notebook_gives(number):
    row = re.search(rf"^\| {number} \|.*$", (ROOT / "docs/instructor.md").read_text("utf-8"), re.M)[0]
    assert tuple(re.findall(r"`(\w+)`", row)) == catalogue.NOTEBOOKS[number]


def test_the_minutes_at_the_arm_are_enough():
    """By the seconds of the runs; in 12 eight more of each of the five for the way there and back."""
    parts = text("12").split("## 8 ")[0], *text("13").split("## 8 ")
    run = r"views\.(?:go|follow)\((?:[^()]|\([^()]*\))*, (\d+)\)"
    seconds = [sum(map(int, re.findall(run, part))) for part in parts]
    seconds[0] += sum(length for _, length in motions(IR50P)) + 5 * 8
    told = re.findall(r"(?:needs the arm for|for the arm,) (\d)(?: and (\d))? minutes", text("12") + text("13"))
    told = [int(one) for pair in told for one in pair if one]
    assert told == [-(-one // 60) for one in seconds], seconds
    page = (ROOT / "docs/instructor.md").read_text("utf-8")
    assert f"| {told[0]} minutes, or" in page and f"| {told[1]} minutes and {told[2]}, or" in page


def test_the_gigabytes_of_the_set_up():
    """What `.venv` takes is these files, uv, and a tenth that Python compiles on the way."""
    locks = [
        {Requirement(line).name for line in (ROOT / lock).read_text("utf-8").splitlines() if not line.startswith("#")}
        for lock in ("environment.txt", "environment-test.txt")
    ]
    for names, told in ((locks[0], r"(\S+) GB on disk"), (locks[1] - locks[0], r"(\S+) GB more")):
        size = sum(map(_size, names)) / 1e9
        assert 0.95 < float(re.search(told, text("README.md"))[1].strip("(")) / size < 1.25, size


def _size(name):
    """Bytes of an installed package; none of one that this system does without."""
    files = [file.locate() for one in distributions(name=name) for file in one.files if file.suffix != ".pyc"]
    return sum(file.stat().st_size for file in files if file.is_file())
