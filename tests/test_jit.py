"""Compiled code: code of other sources is never used."""

import os
import subprocess
import sys

from ir50p_lab import jit


def test_another_compiled_source_another_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(jit, "_PACKAGE", tmp_path)
    (tmp_path / "plain.py").write_text("x = 1")
    (tmp_path / "law.py").write_text("@jit()\ndef f(x): ...")
    seen = set()
    for name, text in (("plain.py", "x = 2"), ("law.py", "@jit()\ndef f(y): ..."), ("new.py", "@jit()\ndef g(): ...")):
        jit.cache_folder.cache_clear()
        seen.add(jit.cache_folder())
        (tmp_path / name).write_text(text)
    jit.cache_folder.cache_clear()
    seen.add(jit.cache_folder())
    jit.cache_folder.cache_clear()
    assert len(seen) == 3  # the plain file does not count


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
