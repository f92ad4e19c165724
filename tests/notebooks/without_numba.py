"""The course in a browser tab, as far as CPython can show it: no numba, OpenCV, pyserial, no worker processes.

CI runs this file by its name. That the numbers are the same as with numba is a test of its own.
"""

import os
import re
import subprocess
import sys

import nbformat
import numpy as np
import pytest
from minutes import core_of
from notebook_runner import NOTEBOOKS, ROOT, run_notebook

from ir50p_lab.course.publishing import site

LACKING = {"PYTHONPATH": f"{ROOT / 'tests' / 'browser_tab'}{os.pathsep}{ROOT}"}
NUMBERS = """
import numpy as np
from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P, forward_dynamics, mass_matrix
from ir50p_lab.signals import hold
from ir50p_lab.simulation import simulate
q = np.random.default_rng(1).uniform(-1, 1, (5, 3))
pid = PID(kp=300, ki=50, kd=30, limit_pwm=255)
run = simulate(IR50P, pid, hold((0.3, 0.4, -0.6)), q0=(0, 0.8, -0.8), duration=1, period=0.01, stops=True, table=0.0)
free = simulate(IR50P.without_friction(), None, None, q0=(0, 0.8, -0.8), duration=0.2, period=0.01)
with SimulatedBench(IR50P, seed=3, q0=(0, 1.5, -2.0)) as bench:
    for sample in bench.run(seconds=0.5, reference=hold((0.1, 1.6, -2.1))):
        bench.drive(pid.step(sample.t, sample.q, sample.reference))
kept = [mass_matrix(IR50P, q), forward_dynamics(IR50P, q, q, q), run.q, free.q, bench.recording.q]
np.save({!r}, np.concatenate([np.ravel(one) for one in kept]))
"""

CHECKS = """
import numpy as np
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.robot.catalogue import NOTEBOOKS
from ir50p_lab.course.publishing.site import NOTEBOOKS as tab
import solutions
written = solutions.load()
for name in (name for number in tab for name in NOTEBOOKS[number]):
    assert grade(task(name), getattr(written, name)).state == "right", name
told = grade(task("rot_z"), lambda angle: written.rot_z(-angle))
assert "it turns the wrong way round" in told.says, told
"""


@pytest.mark.notebook
@pytest.mark.parametrize(
    "path", [path for path in NOTEBOOKS if path.name[:2] in site.NOTEBOOKS], ids=lambda path: path.stem
)
def test_a_notebook_runs_without_what_a_browser_lacks(path, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    if path.name.startswith("16"):
        notebook.cells = core_of(notebook.cells)  # what needs OpenCV is marked more
    run = run_notebook(notebook, timeout=120, variables=LACKING | {"IR50P_HOME": str(tmp_path)}, push=False)
    if run.error:
        pytest.fail(f"{path.name}, {run.error}", pytrace=False)


def test_the_numbers_are_those_of_the_compiled_code(tmp_path):
    found = []
    for variables in ({}, LACKING):
        place = str(tmp_path / f"{len(found)}.npy")
        subprocess.run([sys.executable, "-c", NUMBERS.format(place)], env=os.environ | variables, check=True, cwd=ROOT)
        found.append(np.load(place))
    np.testing.assert_allclose(*found, rtol=1e-9, atol=1e-9)


def test_functions_are_checked():
    """Right ones are taken, and a wrong one is told why."""
    paths = os.pathsep.join([LACKING["PYTHONPATH"], str(ROOT / "tests" / "support")])
    subprocess.run([sys.executable, "-c", CHECKS], env=os.environ | {"PYTHONPATH": paths}, check=True, cwd=ROOT)


def test_the_site_holds_what_its_notebooks_read(tmp_path):
    site._contents(tmp_path)
    pages = "".join(page.read_text(encoding="utf-8") for page in (tmp_path / "notebooks").glob("*.ipynb"))
    read = re.findall(r'data_file\(\\?"(.+?)\\?"\)', pages)
    assert read and all((tmp_path / "data" / name).exists() for name in read), read
