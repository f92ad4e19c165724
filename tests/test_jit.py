"""Compiled code: code of other sources is never used."""

import os
import subprocess
import sys

import numpy as np
import pytest

from ir50p_lab import jit
from ir50p_lab.modelling.kernel import kernel


def test_another_compiled_source_another_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(jit, "_PACKAGE", tmp_path)
    (tmp_path / "bench").mkdir()
    (tmp_path / "plain.py").write_text("x = 1")
    (tmp_path / "bench/limits.py").write_text("LIMIT = 1")
    law = "from ir50p_lab.bench.limits import LIMIT\n@jit()\ndef f(x): ..."
    changes = [
        ("law.py", law),
        ("plain.py", "x = 2"),  # does not count
        ("bench/limits.py", "LIMIT = 2"),
        ("law.py", law.replace("x", "y")),
        ("new.py", "@jit()\ndef g(): ..."),
    ]
    seen = []
    for name, text in changes:
        (tmp_path / name).write_text(text)
        jit.cache_folder.cache_clear()
        seen.append(jit.cache_folder())
    jit.cache_folder.cache_clear()
    assert seen[0] == seen[1] and len(set(seen)) == 4


def test_importing_it_leaves_garbage_collector_and_numba_alone():
    look = (
        "import gc, numba; state = lambda: (gc.isenabled(), gc.get_freeze_count(), numba.config.CACHE_DIR); b = state()"
    )
    code = f"{look}\nimport ir50p_lab.modelling.dynamics\nassert state() == b, (b, state())"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_processes_that_compile_at_once_leave_a_cache_that_can_be_used(tmp_path):
    """numba names a ufunc's machine code by a count of its own, which differs from process to process."""
    call = """
import sys
from numba.core.bytecode import FunctionIdentity

for _ in range(int(sys.argv[1])):
    next(FunctionIdentity._unique_ids)
from ir50p_lab.modelling import load_arm, forward_kinematics

forward_kinematics(load_arm(), [0.1, 0.2, 0.3])
"""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    start = [[sys.executable, "-c", call, str(9 * k)] for k in range(4)]
    at_once = [subprocess.Popen(command, env=environment) for command in start[1:]]
    assert [process.wait() for process in at_once] == [0, 0, 0]
    subprocess.run(start[0], env=environment, check=True)


@pytest.fixture
def nowhere(tmp_path, monkeypatch):
    """A read-only installation of a user without a home: folders that cannot be made, whoever asks (root, too)."""
    blocked = tmp_path / "a file"
    blocked.write_text("")
    monkeypatch.setattr(jit, "_PACKAGE", blocked)
    monkeypatch.setattr(jit.numba.config, "CACHE_DIR", "")
    for name in ("HOME", "USERPROFILE", "IR50P_HOME"):
        monkeypatch.setenv(name, str(blocked))
    yield blocked
    jit.cache_folder.cache_clear()


def place():
    jit.cache_folder.cache_clear()
    return jit.cache_folder() and jit.cache_folder().parent


def test_the_first_place_that_takes_files(nowhere, tmp_path, monkeypatch):
    assert place() is None
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "mine"))
    assert place() == tmp_path / "mine" / ".cache"
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("USERPROFILE", str(tmp_path / "home"))
    assert place() == tmp_path / "home" / ".cache"
    monkeypatch.setattr(jit, "_PACKAGE", tmp_path / "package")
    assert place() == tmp_path / "package" / "__pycache__"
    monkeypatch.setattr(jit.numba.config, "CACHE_DIR", str(tmp_path / "numba"))
    assert place() == tmp_path / "numba"
    monkeypatch.setattr(jit.numba.config, "CACHE_DIR", str(nowhere))
    assert place() == tmp_path / "package" / "__pycache__"


def test_without_any_place_everything_runs(nowhere, monkeypatch):
    def no_home():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(jit.Path, "home", no_home)
    assert place() is None
    assert jit.jit()(lambda x: 2 * x)(1.5) == 3.0
    assert kernel("(n)->(n)")(twice)()(np.array([1.5])) == [3.0]


def twice(x, result):
    result[:] = 2 * x
