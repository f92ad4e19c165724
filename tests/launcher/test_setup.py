"""The set-up from end to end: first time, again, after changes, after interruptions."""

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from ir50p_lab.launcher import environment as environment_module
from ir50p_lab.launcher.environment import Environment
from ir50p_lab.launcher.problems import SetUpError

IMPORT_BOTH = "import pebble, ir50p_lab; print(ir50p_lab.__file__)"


def test_first_setup_says_what_it_does_and_makes_the_package_importable_anywhere(project):
    done = project.run("setup")
    assert done.returncode == 0, done.stderr
    for step in ("[1/4]", "[2/4] packages of environment.txt", "[3/4]", "[4/4]", "Set-up finished"):
        assert step in done.stdout
    assert "-m', 'uv', 'pip', 'install'" in project.log()
    assert project.python(IMPORT_BOTH).stdout.strip() == str(project.root / "ir50p_lab" / "__init__.py")
    assert "pebble_test" not in os.listdir(next(project.venv.glob("[Ll]ib/**/site-packages")))


def test_second_setup_does_nothing(made):
    before = made.stamp.stat().st_mtime_ns
    done = made.run("setup")
    assert done.stdout == f"Ready: {made.venv}\n"
    assert made.stamp.stat().st_mtime_ns == before


def test_the_imports_of_the_check_compile_what_is_used(project):
    done = project.run("setup", variables={"PYTHONDONTWRITEBYTECODE": None})
    assert done.returncode == 0, done.stderr
    assert list(project.venv.glob("[Ll]ib/**/__pycache__/pebble.*.pyc"))


def test_warnings_as_errors_do_not_break_the_setup(project):
    done = project.run("setup", variables={"PYTHONWARNINGS": "error"})
    assert done.returncode == 0, done.stderr


def test_pip_does_the_work_where_a_setting_has_no_counterpart(project):
    (project.root / "constraints.txt").write_text("pebble==1.0\n")
    done = project.run("setup", variables={"PIP_CONSTRAINT": "constraints.txt"})
    assert done.returncode == 0, done.stderr
    assert "-m', 'uv'" not in project.log()
    assert project.python(IMPORT_BOTH).returncode == 0


def test_pip_does_the_work_where_no_uv_fits(project, tmp_path):
    folder = tmp_path / "wheels"
    shutil.copytree(project.wheels, folder)
    (wheel,) = folder.glob("uv-*.whl")
    wheel.rename(str(wheel).replace("linux", "other"))
    done = project.run("setup", variables={"PIP_FIND_LINKS": str(folder)})
    assert done.returncode == 0, done.stderr
    assert "-m', 'uv'" not in project.log()
    assert project.python(IMPORT_BOTH).returncode == 0
    assert project.run("doctor", variables={"IR50P_ARM": None}).returncode == 0


def test_changed_lock_file_rebuilds(project):
    assert project.run("setup").returncode == 0
    lock = project.root / "environment.txt"
    lock.write_text(lock.read_text().replace("pebble==1.0", "pebble-test==1.0"))
    done = project.run("setup")
    assert "out of date (environment.txt has changed): building it again" in done.stdout
    assert project.python("import pebble_test").returncode == 0
    assert project.python("import pebble").returncode == 1  # nothing of the old lock stays behind


def test_test_tools_are_added_in_place_and_stay(project):
    assert project.run("setup").returncode == 0
    done = project.run("setup", "--tests")
    assert "[1/1] test tools of environment-test.txt" in done.stdout
    assert project.python("import pebble, pebble_test").returncode == 0
    assert project.run("setup").stdout.startswith("Ready")
    assert project.run("setup", "--tests").stdout.startswith("Ready")


def test_copied_environment_is_rebuilt(project, made):
    shutil.copytree(made.venv, project.venv, symlinks=True)
    done = project.run("setup")
    assert f"made for another folder ({made.root}): building it again" in done.stdout
    assert str(project.root) in project.python(IMPORT_BOTH).stdout


def test_foreign_or_half_made_environment_is_rebuilt(project):
    (project.venv / "lib").mkdir(parents=True)
    (project.venv / "lib" / "debris.txt").write_text("left by an interrupted run")
    done = project.run("setup")
    assert "half made (a set-up was interrupted): building it again" in done.stdout
    assert done.returncode == 0
    assert not (project.venv / "lib" / "debris.txt").exists()


def test_environment_behind_a_link_keeps_the_link(project, tmp_path):
    elsewhere = tmp_path / "bigger disk"
    elsewhere.mkdir()
    project.venv.symlink_to(elsewhere, target_is_directory=True)
    assert project.run("setup").returncode == 0
    assert project.venv.is_symlink()
    assert project.python(IMPORT_BOTH).returncode == 0


def test_states_that_need_a_rebuild(made, monkeypatch):
    made_here = Environment(made.root)
    assert made_here.state().ready
    stamp = made.stamp.read_text()
    without_tests = json.loads(stamp) | {"environment-test.txt": None}
    try:
        made.stamp.write_text(json.dumps(without_tests))
        assert made_here.state().ready
        assert made_here.state(tests=True).reason == "without the test tools"
        assert not made_here.state(tests=True).rebuild
        for damage in ("", "[]", "{}", stamp[: len(stamp) // 2]):
            made.stamp.write_text(damage)
            assert made_here.state().reason.startswith("half made"), damage
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"root": "/elsewhere"}))
        assert made_here.state().reason == "made for another folder (/elsewhere)"
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"environment.txt": "old"}))
        assert made_here.state().reason == "out of date (environment.txt has changed)"
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"python": "3.10"}))
        assert made_here.state().reason.startswith("made with Python 3.10")
        made.stamp.write_text(json.dumps(json.loads(stamp) | {"environment-test.txt": "old"}))
        assert made_here.state().ready
        assert made_here.state(tests=True).reason == "behind environment-test.txt"
    finally:
        made.stamp.write_text(stamp)
    monkeypatch.setattr(made_here, "python", made.root / "gone")
    assert made_here.state().reason == "broken (its Python does not start)"


def test_line_ends_of_a_checkout_do_not_matter(made):
    lock = made.root / "environment.txt"
    text = lock.read_bytes()
    try:
        lock.write_bytes(text.replace(b"\n", b"\r\n"))
        assert Environment(made.root).state().ready
    finally:
        lock.write_bytes(text)


def test_variables_of_other_pythons_do_not_leak_in(made, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", "/opt/ros/python")
    monkeypatch.setenv("PYTHONHOME", "/nowhere")
    variables = Environment(made.root).variables()
    assert "PYTHONPATH" not in variables
    assert "PYTHONHOME" not in variables
    assert variables["PATH"].split(os.pathsep)[0] == str(Environment(made.root).scripts)
    assert variables["JUPYTER_PREFER_ENV_PATH"] == "1"


# -- interruptions: pip waits for a server that never answers, so the set-up is surely in the middle -----------------------


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
def test_ctrl_c_in_the_middle(project, silent_index):
    process = project.start("setup", variables=silent_index.variables)
    assert silent_index.asked.wait(300)
    os.killpg(process.pid, signal.SIGINT)  # the launcher and pip, as a terminal does
    _, errors = process.communicate(timeout=300)
    assert process.returncode == 130
    assert errors.strip().startswith("Stopped.")
    assert len(errors.strip().splitlines()) == 1
    repaired = project.run("setup")
    assert "half made" in repaired.stdout
    assert project.python(IMPORT_BOTH).returncode == 0


@pytest.mark.skipif(os.name == "nt", reason="process groups and signals of POSIX")
def test_termination_takes_pip_along(project, silent_index):
    process = project.start("setup", variables=silent_index.variables)
    assert silent_index.asked.wait(300)
    process.terminate()  # the launcher alone; reading to the end of its pipes shows that nothing else holds them
    _, errors = process.communicate(timeout=300)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert project.run("setup").returncode == 0


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


def test_drives_without_locks_are_set_up_all_the_same(project, monkeypatch):
    def no_locks(file, *, wait):
        raise OSError("no locks available")

    monkeypatch.setattr(environment_module, "_lock", no_locks)
    with Environment(project.root)._only_one(sys.stdout) as lock:
        assert lock is None


def test_an_error_while_building_releases_the_lock(project):
    environment = Environment(project.root)
    with pytest.raises(SetUpError, match="stop"), environment._only_one(sys.stdout):
        raise SetUpError("stop")
    code = "import fcntl, sys; fcntl.flock(open(sys.argv[1], 'a'), fcntl.LOCK_EX | fcntl.LOCK_NB)"
    command = [sys.executable, "-c", code, str(project.venv / "ir50p_lab-setup.lock")]
    assert subprocess.run(command).returncode == 0
