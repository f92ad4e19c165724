"""What assistants are told: every function of the student's by name, and of none a line of its solution."""

import re

import solutions

from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.home import PROJECT

TEXTS = [(PROJECT / name).read_text(encoding="utf-8") for name in ("notebooks/TUTOR.md", "AGENTS.md")]


def test_they_name_every_function():
    assert re.findall(r"`(\w+)`", TEXTS[0].partition("2. **")[0])[1:] == list(ORDER)  # the first is check


def test_they_hold_no_solution():
    written = " ".join(" ".join(TEXTS).split())
    for name in ORDER:
        for line in solutions.source(name).splitlines():
            line = line.strip()
            assert len(line) < 12 or line.startswith(("def ", "class ", '"""')) or line not in written, (name, line)
