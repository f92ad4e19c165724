"""The test command: what runs together, what alone, what is left out."""

import sys
from types import SimpleNamespace

import pytest
from marks import MARKS, TESTS

from tests import __main__ as command
from tests import everywhere


@pytest.fixture
def started(monkeypatch):
    """What is started in the place of pytest; `codes`: how it ends."""
    runs = SimpleNamespace(commands=[], codes=[0, 0])

    def run(line, **options):
        runs.commands.append(line[3:])
        return SimpleNamespace(returncode=runs.codes[len(runs.commands) - 1])

    monkeypatch.setattr(command.subprocess, "run", run)
    return runs


def test_what_measures_time_runs_alone_after_the_rest(started):
    assert command.main(["-k", "pose"]) == 0
    together, alone = started.commands
    assert together == [*everywhere.PARALLEL, "--timing=without", "-k", "pose"]
    assert alone == ["-p", "no:xdist", "--timing=only", "-k", "pose"]
    assert everywhere.PARALLEL[0] == "-n" and int(everywhere.PARALLEL[1]) > 1


@pytest.mark.parametrize(
    ("codes", "code"), [((0, 5), 0), ((5, 1, 1), 1), ((0, 1, 0), 0), ((1, 0), 1), ((1, 1, 0), 1), ((5, 5), 5)]
)
def test_exit_code_and_a_second_try_for_what_measures_time(started, codes, code):
    started.codes = codes
    assert command.main([]) == code
    assert len(started.commands) == len(codes)
    assert ("--last-failed" in started.commands[-1]) == (len(codes) == 3)


def test_marked_files_exist():
    for places in MARKS.values():
        for place in places:
            assert (TESTS / place).exists(), place


# -- everywhere --------------------------------------------------------------------------------------------------------


@pytest.fixture
def two_legs(monkeypatch, tmp_path):
    """Two legs over a project of one file; a leg fails where FAULT is set."""
    (tmp_path / "test_one.py").write_text("def test_it(): pass\n")
    monkeypatch.setattr(everywhere, "ROOT", tmp_path)
    monkeypatch.setattr(everywhere, "STATE", tmp_path / ".everywhere")
    monkeypatch.setattr(everywhere, "READ", ("test_one.py",))
    monkeypatch.setattr(everywhere, "legs", lambda: {"native": {}, "faulty": {"FAULT": "1"}})

    def run(name, variables, arguments):
        tests = (tmp_path / "test_one.py").read_text().count("def ")
        failed = ["test_one::test_it"] if "FAULT" in variables else []
        return {"passed": tests - len(failed), "failed": failed, "seconds": 1, "code": len(failed)}

    (tmp_path / ".everywhere").mkdir()
    monkeypatch.setattr(everywhere, "run", run)
    return tmp_path


def test_legs_that_passed_are_remembered_until_a_file_changes(two_legs, capsys):
    assert everywhere.main([]) == 1
    rows = [line.split() for line in capsys.readouterr().out.splitlines() if line]
    assert ["native", "1", "0"] == rows[-3][:3]
    assert ["faulty", "0", "1"] == rows[-2][:3]
    assert rows[-1] == ["test_one::test_it"]
    assert everywhere.main(["native"]) == 0
    assert "an earlier run" in capsys.readouterr().out
    with open(two_legs / "test_one.py", "a") as file:
        file.write("def test_new(): pass\n")
    everywhere.main([])
    out = capsys.readouterr().out
    assert "an earlier run" not in out
    assert [line.split()[:3] for line in out.splitlines() if line.startswith("native ")] == [["native", "2", "0"]]


LINEAR_ALGEBRA = """
import numpy as np, scipy.linalg
A, b = np.diag([3.0, 7.0]), np.ones(2)
exact = b / np.diag(A)
for x in (np.linalg.solve(A, b), scipy.linalg.solve(A, b), np.linalg.lstsq(A, b)[0], np.linalg.pinv(A) @ b):
    print(float(np.abs(x / exact - 1).max()))
assert np.linalg.lstsq(A, b)[2] == 2  # a rank is whole
assert np.linalg.svd(A).S.shape == (2,)
"""


def test_other_rounding_reaches_every_python_that_is_started():
    variables = everywhere.os.environ | everywhere.legs()["rounding"]
    done = everywhere.subprocess.run(
        [sys.executable, "-c", LINEAR_ALGEBRA], env=variables, capture_output=True, text=True, check=True
    )
    errors = [float(line) for line in done.stdout.split()]
    assert len(errors) == 4
    assert all(1e-14 < error < 1e-11 for error in errors)


def test_dispatch_is_off_where_it_says_so():
    code = (
        "import numpy as np, cv2; "
        "print(np.show_config(mode='dicts')['SIMD Extensions'].get('found', [])); print(cv2.getCPUFeaturesLine())"
    )
    variables = everywhere.legs()["no-dispatch"]
    done = everywhere.subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        env=everywhere.os.environ | variables,
        capture_output=True,
        text=True,
        check=True,
    )
    numpy_found, opencv = done.stdout.splitlines()
    assert numpy_found == "[]"
    features = [feature for feature in opencv.split() if feature.startswith("*")]
    assert features and all(feature.endswith("?") for feature in features)
