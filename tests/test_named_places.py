"""Files, sections and commands that a message or an advice names exist."""

import re
from pathlib import Path

import pytest

from ir50p_lab.launcher import commands

ROOT = Path(__file__).parents[1]
SPEAKING = [
    *ROOT.rglob("ir50p_lab/**/*.py"),
    *ROOT.rglob("ir50p_lab/**/*.t*xt"),
    *ROOT.rglob("ir50p_lab/**/*.toml"),
    *ROOT.glob("docs/*.md"),
    *ROOT.glob("notebooks/*.ipynb"),
    ROOT / "README.md",
    ROOT / "notebooks" / "TUTOR.md",
]


def text_of(path):
    text = path.read_text("utf-8")
    return text if path.suffix == ".md" else re.sub(r"\\?\\?\n\s*|\"\s*\n\s*f?\"", " ", text)


@pytest.mark.parametrize("path", SPEAKING, ids=lambda path: str(path.relative_to(ROOT)))
def test_what_is_named_exists(path):
    text = text_of(path)
    for file in re.findall(r"\b(docs/[\w/]+\.(?:md|csv)|README\.md|notebooks/TUTOR\.md)\b", text):
        assert (ROOT / file).is_file(), file
    for file, section in re.findall(r"\b((?:docs/\w+|README)\.md),\s+section\s+'([^']+)'", text):
        assert re.search(rf"^#+ {re.escape(section)}$", (ROOT / file).read_text("utf-8"), re.MULTILINE), section
    known = {*commands._MODULES, "setup", "doctor", "help"}
    for command in re.findall(r"python3? -m ir50p_lab ([a-z][a-z-]+)\b", text):
        assert command in known, command


def test_nbval_is_documented_as_ci_runs_it():
    line = "pytest --nbval --nbval-current-env -n auto --dist loadfile --nbval-cell-timeout=600 "
    for place in (".ci/run", "docs/instructor.md", "docs/developing.md"):
        assert f".venv/bin/python -m {line}" in (ROOT / place).read_text("utf-8"), place
