"""How far pip is, read from what it prints; what a terminal and a log file are shown."""

import io
import os
import sys

from ir50p_lab.launcher import pip_run
from ir50p_lab.launcher.pip_run import PipProgress, ProgressLine

#: pip 23.2: each package is looked up and fetched in turn.
IN_TURN = """\
Ignoring tzdata: markers 'sys_platform == "win32"' don't match your environment
Collecting numpy==2.4.6 (from -r environment.txt (line 1))
  Downloading numpy-2.4.6-cp311-cp311-manylinux_2_28_x86_64.whl (16.9 MB)
Requirement already satisfied: six==1.17.0 in ./.venv (from -r environment.txt (line 2))
Collecting tqdm==4.70.1 (from -r environment.txt (line 3))
  Using cached tqdm-4.70.1-py3-none-any.whl (78 kB)
Installing collected packages: numpy, tqdm
Successfully installed numpy-2.4.6 tqdm-4.70.1
"""
#: Newer pips look up all of them first.
LOOKUP_FIRST = """\
Collecting numpy==2.4.6 (from -r environment.txt (line 1))
  Downloading numpy-2.4.6-cp311-cp311-manylinux_2_28_x86_64.whl.metadata (6.6 kB)
Collecting lazy-loader==0.6 (from -r environment.txt (line 2))
  Downloading lazy_loader-0.6-py3-none-any.whl.metadata (6.4 kB)
Downloading numpy-2.4.6-cp311-cp311-manylinux_2_28_x86_64.whl (16.9 MB)
Downloading lazy_loader-0.6-py3-none-any.whl (12 kB)
Installing collected packages: numpy, lazy-loader
"""


def follow(text, requirements):
    """The progress after each line: (stage, done, total)."""
    progress = PipProgress(requirements)
    steps = []
    for line in text.splitlines():
        progress.read(line)
        steps.append((progress.stage, progress.done, progress.total))
    return progress, steps


def test_packages_fetched_in_turn():
    progress, steps = follow(IN_TURN, 4)
    assert steps[0] == ("collecting", 0, 3)
    assert steps[5] == ("collecting", 3, 3)
    assert steps[6] == ("installing", 0, 2)
    assert progress.megabytes == 16.9  # what comes from the cache is no download


def test_packages_looked_up_first():
    progress, steps = follow(LOOKUP_FIRST, 2)
    assert steps[3] == ("collecting", 2, 2)
    assert steps[4] == ("fetching", 1, 2)
    assert steps[5] == ("fetching", 2, 2)
    assert steps[6] == ("installing", 0, 2)
    assert abs(progress.megabytes - 16.912) < 1e-9


def test_wheels_of_a_folder_count_and_are_named():
    progress, steps = follow("Processing /media/usb/my wheels/numpy-2.4.6-cp311-any.whl (from -r e.txt (line 1))", 1)
    assert steps == [("collecting", 1, 1)]
    assert progress.detail == "numpy 2.4.6"


def test_trouble_is_shown_until_something_arrives():
    progress, _ = follow("WARNING: Retrying (Retry(total=4)) after connection broken by 'x'", 1)
    assert "no answer from the download server" in progress.detail
    progress.read("Collecting six==1.17.0")
    assert progress.detail == "six 1.17.0"


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_terminal_has_one_line_that_is_rewritten_and_removed():
    terminal = Terminal()
    line = ProgressLine(terminal)
    line.show("collecting", 1, 3, "a long name")
    line.show("collecting", 2, 3, "b")
    line.clear()
    assert "\n" not in terminal.getvalue()
    _, first, second, blank, end = terminal.getvalue().split("\r")
    assert first.strip() == "collecting 1/3 (33 %) a long name"
    assert second.strip() == "collecting 2/3 (66 %) b"
    assert len(second) == len(first)  # nothing of the longer text stays
    assert blank.strip() == end == ""


def test_a_log_file_has_a_line_every_tenth_of_the_way():
    log = io.StringIO()
    line = ProgressLine(log)
    for done in range(101):
        line.show("installing", done, 100, "ignored")
    line.clear()
    lines = log.getvalue().splitlines()
    assert len(lines) == 11
    assert lines[3].strip() == "installing 30/100 (30 %)"


def test_installed_packages_are_counted_while_pip_is_silent(monkeypatch):
    monkeypatch.setattr(pip_run, "_TICK", 0.01)
    # Speaks once, then is silent until it has been looked at often enough to be told to go on.
    code = "print('Installing collected packages: a, b, c', flush=True); import sys; sys.stdin.read(1)"
    ready, go = os.pipe()
    counts = iter([5, 6, 7])

    def count():
        number = next(counts, None)
        if number is None:
            os.write(go, b"x")
            return 7
        return number

    popen = pip_run.subprocess.Popen
    monkeypatch.setattr(pip_run.subprocess, "Popen", lambda *a, **options: popen(*a, **options | {"stdin": ready}))
    log = io.StringIO()
    result = pip_run.run(
        [sys.executable, "-c", code], env=dict(os.environ), stream=log, requirements=3, count_installed=count
    )
    os.close(ready)
    os.close(go)
    assert result == (0, "Installing collected packages: a, b, c\n")
    lines = [line.strip() for line in log.getvalue().splitlines()]
    assert [line for line in lines if line.startswith("installing")] == [
        "installing 0/3 (0 %)",
        "installing 1/3 (33 %)",
        "installing 2/3 (66 %)",
    ]
