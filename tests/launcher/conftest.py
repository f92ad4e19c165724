"""Miniature projects for the tests of the launcher."""

import pytest
from mini_project import MiniProject, repack, write_wheel

STRANGE = "robot räume δ"  # a path may have a space and letters beyond ASCII
#: In the place of JupyterLab and pytest: says how it was started and ends as the test wants it to.
STAND_IN = """
import json, os, signal, sys, time
if "--stay" in sys.argv:  # before anything is said: who reads it may end this at once
    signal.signal(signal.SIGINT, signal.SIG_DFL)
told = ("IR50P_ARM", "IR50P_HOME", "VIRTUAL_ENV", "JUPYTER_PREFER_ENV_PATH")
print(json.dumps({"argv": sys.argv[1:], "cwd": os.getcwd(), "prefix": sys.prefix} | {n: os.environ.get(n) for n in told}))
sys.stdout.flush()
if "--stay" in sys.argv:
    signal.pause()
sys.exit(int(os.environ.get("STAND_IN_CODE", "0")))
"""


@pytest.fixture(scope="session")
def wheels(tmp_path_factory):
    """A wheel folder: build tool and uv as installed here, and two packages of one line each."""
    folder = tmp_path_factory.mktemp("wheels")
    repack(folder, "flit-core")
    repack(folder, "uv")
    stand_ins = {"jupyterlab/__main__.py": STAND_IN, "jupyterlab/labapp.py": "", "ipykernel/kernelapp.py": ""}
    write_wheel(folder, "pebble", {"pebble.py": "weight = 3\n"} | stand_ins)
    write_wheel(folder, "pebble_test", {"pebble_test.py": "weight = 3\n", "pytest/__main__.py": STAND_IN})
    return folder


@pytest.fixture
def project(tmp_path, wheels):
    """A fresh miniature."""
    return MiniProject(tmp_path / STRANGE, wheels)


@pytest.fixture(scope="session")
def made(tmp_path_factory, wheels):
    """A miniature that is set up once, `first` being how that went; tests must leave it ready."""
    project = MiniProject(tmp_path_factory.mktemp("made") / STRANGE, wheels)
    project.first = project.run("setup")
    assert project.first.returncode == 0, project.first.stdout + project.first.stderr
    return project


@pytest.fixture(scope="session")
def tested(made):
    """The same with the test tools, `added` being how they came."""
    made.added = made.run("setup", "--tests")
    assert made.added.returncode == 0, made.added.stdout + made.added.stderr
    return made
