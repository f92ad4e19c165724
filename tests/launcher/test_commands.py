"""The command line: what is started, where, with which arguments. Stand-ins take the place of JupyterLab and pytest."""

import io
import json
import os
import signal
import sys
from pathlib import Path

import pytest
from mini_project import one_line

from ir50p_lab.launcher import commands, installer, inventory


def told(done):
    """What the stand-in said about how it was started."""
    return json.loads(done.stdout.splitlines()[-1])


def test_lab_opens_the_notebooks_with_the_python_of_the_environment(made):
    done = made.run(variables={"IR50P_ARM": None})
    assert done.returncode == 0
    assert "If no browser opens, copy the address" in done.stdout
    start = told(done)
    assert start["argv"] == [str(made.root / "notebooks"), "--allow-root"]
    assert start["prefix"] == start["VIRTUAL_ENV"] == str(made.venv)
    assert start["JUPYTER_PREFER_ENV_PATH"] == "1"
    assert start["IR50P_ARM"] is None


def test_lab_opens_on_00_until_something_is_the_students(made, tmp_path):
    page = made.root / "notebooks" / "00_start_here.ipynb"
    page.write_text("{}")
    home = tmp_path / "mine"

    def arguments(*more):
        return told(made.run(*more, variables={"IR50P_HOME": f'"{home}"'}))["argv"]

    try:
        on_00 = [str(page.parent), "--LabApp.default_url=/lab/tree/00_start_here.ipynb", "--allow-root"]
        assert arguments() == on_00
        home.mkdir()
        assert arguments() == on_00
        assert arguments("notebooks") == ["notebooks", "--allow-root"]  # one's own choice
        (home / "results").mkdir()
        assert arguments() == [str(page.parent), "--allow-root"]
    finally:
        page.unlink()


def test_further_arguments_go_to_jupyter(made):
    start = told(made.run("--no-browser", "--port", "9999"))
    assert start["argv"] == [str(made.root / "notebooks"), "--no-browser", "--port", "9999", "--allow-root"]
    start = told(made.run("lab", "notebooks", "--no-browser"))
    assert start["argv"] == ["notebooks", "--no-browser", "--allow-root"]


@pytest.mark.parametrize(("command", "module"), [("test", "tests"), ("targets", "tests.targets")])
def test_tests_and_targets_run_in_the_project_with_the_test_tools(tested, tmp_path, command, module):
    folder = tested.root / module.replace(".", "/")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "__main__.py").write_text(MODULE)
    done = tested.run(command, "vision", "--quick")
    assert done.returncode == 7, done.stderr
    start = json.loads(done.stdout.splitlines()[-1])
    assert start["argv"] == ["vision", "--quick"] and start["cwd"] == str(tested.root)
    assert start["prefix"] == str(tested.venv)
    assert start["home"] and not Path(start["home"]).exists()  # the student's own is neither read nor written


MODULE = """
import json, os, sys
import pebble_test
print(json.dumps({"argv": sys.argv[1:], "cwd": os.getcwd(), "prefix": sys.prefix, "home": os.environ["IR50P_HOME"]}))
sys.exit(7)
"""


def test_another_arm(tested, tmp_path):
    arm = tmp_path / "arm.toml"
    arm.write_text("")
    assert told(tested.run("--arm", str(arm)))["IR50P_ARM"] == str(arm)
    assert told(tested.run(f"--arm={arm}"))["IR50P_ARM"] == str(arm)
    assert told(tested.run(variables={"IR50P_ARM": str(arm)}))["IR50P_ARM"] == str(arm)  # inherited
    assert "no arm file 'nowhere.toml'. Write one with Arm.save" in one_line(tested.run("--arm", "nowhere.toml"))
    assert "argument --arm: expected one argument" in one_line(tested.run("test", "--arm"))


@pytest.mark.skipif(os.name == "nt", reason="process groups and signals of POSIX")
@pytest.mark.parametrize(("signal_sent", "code"), [(signal.SIGINT, 0), (signal.SIGTERM, 128 + signal.SIGTERM)])
def test_ending_jupyterlab(made, signal_sent, code):
    process = made.start("--stay")
    assert process.stdout.readline().startswith("Opening JupyterLab")
    assert json.loads(process.stdout.readline())["argv"]
    if signal_sent == signal.SIGINT:
        os.killpg(process.pid, signal_sent)  # as a terminal does: both get it
    else:
        process.terminate()  # the launcher alone: passes it on
    _, errors = process.communicate(timeout=300)
    assert process.returncode == code
    assert errors == ""


def test_help_names_both_systems_and_needs_no_environment(project):
    for argument in ("--help", "-h", "help"):
        done = project.run(argument)
        assert done.returncode == 0
        for command in ("python3 -m ir50p_lab", "py -m ir50p_lab", *"test targets setup doctor --here --arm".split()):
            assert command in done.stdout
    assert not project.venv.exists()


def test_words_that_are_no_command(project):
    assert "neither a command nor a file 'tset'" in one_line(project.run("tset"))
    assert "setup does not know '--fast'" in one_line(project.run("setup", "--fast"))
    assert not project.venv.exists()


# -- --here ----------------------------------------------------------------------------------------------------------------


def test_here_says_what_is_missing_and_how_to_install_it(project):
    line = one_line(project.run("--here"))
    assert "lacks pebble" in line
    assert f"-m pip install -r {project.root / 'environment.txt'}" in line
    assert not project.venv.exists()
    assert "pebble-test" in one_line(project.run("--here", "test"))
    assert "pebble-test" in one_line(project.run("--here", "targets"))


def test_here_uses_the_running_python(tested):
    own = tested.command
    tested.command = lambda *arguments: [str(tested.interpreter), "-m", "ir50p_lab", *arguments]
    try:
        assert told(tested.run("--here", "--no-browser"))["prefix"] == str(tested.venv)
        assert tested.run("setup", "--here", "--tests").stdout == "Everything is in place.\n"
    finally:
        tested.command = own


def test_here_without_the_lab_book_itself(tested, monkeypatch, capsys):
    versions = inventory.installed_version
    monkeypatch.setattr(inventory, "packages", lambda lock: [])
    monkeypatch.setattr(inventory, "installed_version", lambda name: None if name == "ir50p-lab" else versions(name))
    assert commands.main(["setup", "--here"], root=tested.root) == 1
    error = capsys.readouterr().err
    assert "lacks ir50p-lab" in error
    assert "pip install --no-deps --no-build-isolation -e" in error


# -- the command line within this process ----------------------------------------------------------------------------------


def test_errors_of_the_system_and_ctrl_c_end_in_one_line(made, monkeypatch, capsys):
    for error, code, text in [
        (OSError(28, "No space left on device"), 1, "The disk is full"),
        (KeyboardInterrupt(), 130, "Stopped. Run"),
    ]:
        monkeypatch.setattr(commands, "Environment", lambda root, error=error: (_ for _ in ()).throw(error))
        assert commands.main(["setup"], root=made.root) == code
        assert capsys.readouterr().err.strip().startswith(text)


def test_without_streams_as_under_pythonw(monkeypatch):
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", None)
    assert commands.main(["--help"]) == 0
    installer._show("a line")
    monkeypatch.setattr(sys, "stdout", io.StringIO())  # has no reconfigure
    assert commands.main(["--help"]) == 0
