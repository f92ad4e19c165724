"""Set-ups built again, and under hostile conditions, each provoked for real: interrupted, without network, half made...

CI runs this file by its name: every test builds an environment, some two, and `ir50p_lab test` is to be quick.
"""

import os
import shutil
import signal
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from mini_project import PYPROJECT, one_line

IMPORT_BOTH = "import pebble, ir50p_lab; print(ir50p_lab.__file__)"
NOTHING_SET = {"PIP_NO_INDEX": None, "PIP_FIND_LINKS": None, "PIP_RETRIES": "0", "PIP_DEFAULT_TIMEOUT": "5"}


@pytest.fixture
def without_uv(project, tmp_path):
    """A folder of wheels in which no uv fits this machine."""
    folder = tmp_path / "wheels"
    shutil.copytree(project.wheels, folder)
    (wheel,) = folder.glob("uv-*.whl")
    wheel.rename(str(wheel).replace("linux", "other"))
    return str(folder)


@pytest.mark.parametrize("setting", ["PIP_EXISTS_ACTION", "PIP_FIND_LINKS"])
def test_pip_does_the_work_where_uv_cannot(project, without_uv, setting):
    """A setting that uv has no counterpart of, or no uv."""
    value = {"PIP_EXISTS_ACTION": "i", "PIP_FIND_LINKS": without_uv}[setting]
    done = project.run("setup", variables={setting: value})
    assert done.returncode == 0, done.stderr
    assert "-m', 'uv'" not in project.log()
    assert project.python(IMPORT_BOTH).returncode == 0
    assert project.run("doctor", variables={"IR50P_ARM": None}).returncode == 0


@pytest.mark.parametrize("uv", [True, False])
def test_the_target_of_a_pip_conf_stays_empty(project, without_uv, tmp_path, uv):
    (tmp_path / "pip.conf").write_text(f"[install]\ntarget = {tmp_path / 'target'}\n")
    wheels = str(project.wheels) if uv else without_uv
    settings = {"PIP_CONFIG_FILE": str(tmp_path / "pip.conf"), "PIP_FIND_LINKS": wheels}
    done = project.run("setup", variables=settings)
    assert done.returncode == 0, done.stderr
    assert ("-m', 'uv'" in project.log()) == uv
    assert project.python(IMPORT_BOTH).returncode == 0 and not (tmp_path / "target").exists()


@pytest.mark.parametrize(("version", "code"), [("1.0", 0), ("2.0", 1)])
def test_uv_keeps_to_a_constraint_of_pip(project, version, code):
    (project.root / "constraints.txt").write_text(f"pebble=={version}\n")
    done = project.run("setup", variables={"PIP_CONSTRAINT": "constraints.txt"})
    assert done.returncode == code, done.stderr
    assert "-m', 'uv'" in project.log()


def test_rebuild_starts_from_nothing(tested):
    (tested.venv / "debris.txt").write_text("")
    done = tested.run("setup", "--rebuild", "--tests")
    assert done.returncode == 0, done.stderr
    assert "[2/5] packages of environment-test.txt" in done.stdout
    assert not (tested.venv / "debris.txt").exists()
    assert tested.python("import pebble, pebble_test").returncode == 0


def test_environment_behind_a_link_keeps_the_link(project, tmp_path):
    elsewhere = tmp_path / "bigger disk"
    elsewhere.mkdir()
    project.venv.symlink_to(elsewhere, target_is_directory=True)
    assert project.run("setup").returncode == 0
    assert project.venv.is_symlink()
    assert project.python(IMPORT_BOTH).returncode == 0


@pytest.fixture
def silent_index():
    """A package index that accepts a request and does not answer until the test is over."""
    asked, over = threading.Event(), threading.Event()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self):  # the name that http.server looks for
            asked.set()
            over.wait(300)

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    server.asked, server.over = asked, over
    server.variables = {
        "PIP_NO_INDEX": None,
        "PIP_FIND_LINKS": None,
        "PIP_INDEX_URL": f"http://127.0.0.1:{server.server_port}/simple",
        "PIP_RETRIES": "0",
    } | {name: None for name in ("HTTP_PROXY", "http_proxy", "ALL_PROXY", "all_proxy")}
    yield server
    over.set()
    server.shutdown()
    server.server_close()


@pytest.mark.skipif(os.name == "nt", reason="process groups and signals of POSIX")
@pytest.mark.parametrize("by", ["Ctrl-C", "termination"])
def test_stopped_in_the_middle(project, silent_index, by):
    process = project.start("setup", variables=silent_index.variables)
    assert silent_index.asked.wait(300)
    if by == "Ctrl-C":
        os.killpg(process.pid, signal.SIGINT)  # the launcher and pip, as a terminal does
    else:
        process.terminate()  # the launcher alone; reading to the end of its pipes shows that nothing else holds them
    _, errors = process.communicate(timeout=300)
    assert process.returncode == 130
    assert "Traceback" not in errors
    if by == "Ctrl-C":
        (line,) = errors.strip().splitlines()
        assert line.startswith("Stopped.")
    repaired = project.run("setup")
    assert "half made" in repaired.stdout
    assert project.python(IMPORT_BOTH).returncode == 0


@pytest.mark.skipif(os.name == "nt", reason="process groups and signals of POSIX")
def test_kill_9_in_the_middle_and_the_orphaned_pip_is_waited_for(project, silent_index):
    process = project.start("setup", variables=silent_index.variables)
    assert silent_index.asked.wait(300)
    process.kill()  # its pip lives on and still holds the lock
    process.wait(timeout=300)
    again = project.start("setup")
    lines = iter(again.stdout.readline, "")
    assert next(lines).startswith("Another set-up is at work in this folder: waiting")
    silent_index.over.set()  # pip gets no answer and ends
    rest = "".join(lines)
    again.communicate(timeout=300)
    assert again.returncode == 0
    assert "half made (a set-up was interrupted): building it again" in rest
    assert project.python(IMPORT_BOTH).returncode == 0
    process.stdout.close()
    process.stderr.close()


def test_two_setups_at_once_build_once(project):
    first, second = project.start("setup"), project.start("setup")
    outputs = [process.communicate(timeout=300)[0] for process in (first, second)]
    assert first.returncode == second.returncode == 0
    assert sorted("Set-up finished" in output for output in outputs) == [False, True]
    assert all("Ready" in output for output in outputs)


def test_no_network(project):
    closed = NOTHING_SET | {"PIP_INDEX_URL": "http://127.0.0.1:9/simple"}  # nobody listens on port 9
    line = one_line(project.run("setup", variables=closed))
    assert line.startswith("Download failed: no connection to the download server.")
    assert "HTTPS_PROXY=http" in line
    assert "section 'Offline'" in line
    assert project.run("setup").returncode == 0  # with the network back, the next run repairs


BACKEND = """
def prepare_metadata_for_build_editable(*arguments):
    with open("/dev/full", "w") as file:  # this device answers every write with: no space left
        file.write("x")
build_editable = build_wheel = prepare_metadata_for_build_editable
"""


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="the device /dev/full of Linux")
def test_disk_full_in_the_middle_of_pip(project):
    # A real 'no space left on device' inside pip: the project's build step writes to the device that is always full.
    (project.root / "backend.py").write_text(BACKEND)
    pyproject = PYPROJECT.replace('"flit_core.buildapi"', '"backend"\nbackend-path = ["."]')
    (project.root / "pyproject.toml").write_text(pyproject)
    line = one_line(project.run("setup"))
    assert line.startswith(f"The disk is full: {project.root} could not be written. Free about 2 GB")
    (project.root / "pyproject.toml").write_text(PYPROJECT)
    assert "half made" in project.run("setup").stdout  # with space again, the next run repairs
