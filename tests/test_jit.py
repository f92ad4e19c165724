"""Compiled code: code of other sources is never used."""

import ast
import os
import re
import subprocess
import sys

from ir50p_lab import jit


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


def names_set(path):
    """Names that a module sets itself: constants, functions, classes."""
    body = ast.parse(path.read_text("utf-8")).body
    targets = [target for node in body if isinstance(node, ast.Assign) for target in node.targets]
    constants = {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
    return constants | {getattr(node, "name", None) for node in body}


def test_compiled_code_reads_constants_from_the_files_that_set_them():
    """Those count for the folder's name; files that only pass them on would not do."""
    seen = 0
    for path in jit._PACKAGE.rglob("*.py"):
        tree = ast.parse(path.read_text("utf-8"))
        imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
        origins = {alias.asname or alias.name: (node.module, alias.name) for node in imports for alias in node.names}
        functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
        compiled = [
            one for one in functions if re.search(r"(jit|kernel)\(", " ".join(map(ast.unparse, one.decorator_list)))
        ]
        for node in (node for one in compiled for statement in one.body for node in ast.walk(statement)):
            module, name = origins.get(getattr(node, "id", None), ("", ""))
            home = jit._PACKAGE.parent.joinpath(*module.split(".")).with_suffix(".py")
            if home.is_file():  # else no module of ours, or a package of which the name is a module
                assert name in names_set(home), f"{path} takes {name} from {module}, which does not set it"
                seen += 1
    assert seen > 30


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
