"""The IR50P lab book. In the project's folder (on Windows write py instead of python3):

  python3 -m ir50p_lab [...]          set up .venv on first use, then open JupyterLab on notebooks/
  python3 -m ir50p_lab test [...]     set up with the test tools, then run the tests and every notebook
                                      (--quick: no notebooks; --everywhere: as on other processors, other arms)
  python3 -m ir50p_lab export [...]   notebooks as pages that need no network: HTML, and PDF where a browser is
  python3 -m ir50p_lab targets [...]  measure what the project set out to reach, as tables beside the thesis
  python3 -m ir50p_lab setup          only set up (--rebuild: from nothing; --tests: with the test tools)
  python3 -m ir50p_lab bench-test     first power-on of the arm, joint by joint (rehearse: bench-test simulated)
  python3 -m ir50p_lab report         your lab report: predictions, figures, functions (--name "Your Name")
  python3 -m ir50p_lab update FOLDER  take over what is yours from an older copy of the course
  python3 -m ir50p_lab doctor         what is installed, what is missing, serial ports, verdict

  --here         use the Python that runs this instead of .venv (Binder, JupyterHub); installs nothing
  --arm FILE     use the arm in this file instead of the IR50P (the same as IR50P_ARM=FILE)

Further arguments go to JupyterLab, to pytest (paths count from the project's folder) or to the targets:

  py -m ir50p_lab --no-browser --port 9999
  py -m ir50p_lab test -k pose
  py -m ir50p_lab targets vision --quick    (or identification, computed_torque; without a name all of them)
"""

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from ir50p_lab.launcher import doctor, inventory, update
from ir50p_lab.launcher.environment import LOCK, TEST_LOCK, Environment
from ir50p_lab.launcher.problems import COMMAND, SetUpError, from_os_error

ROOT = Path(__file__).resolve().parents[2]

COMMANDS = ("lab", "test", "targets", "setup", "doctor", "bench-test", "export", "report", "update")


def main(arguments, root=ROOT):
    """Run the command line; return the exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # paths may have letters that the console does not
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), _stop)
    try:
        return _run(list(arguments), Path(root))
    except SetUpError as problem:
        print(problem, file=sys.stderr)
        return 1
    except OSError as error:
        print(from_os_error(error, root), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"\nStopped. Run '{COMMAND}' again whenever you like: it takes up what is missing.", file=sys.stderr)
        return 130


def _run(arguments, root):
    if arguments[:1] in (["-h"], ["--help"], ["help"]):
        print(__doc__, end="")
        return 0
    here = _take_flag(arguments, "--here")
    arm = _take_value(arguments, "--arm")
    command = arguments.pop(0) if arguments and arguments[0] in COMMANDS else "lab"
    if command == "lab" and arguments and not arguments[0].startswith("-") and not Path(arguments[0]).exists():
        raise SetUpError(f"There is neither a command nor a file '{arguments[0]}'. Try '{COMMAND} --help'.")
    environment = Environment(root)
    if command == "doctor":
        return doctor.report(environment, here=here)
    if command == "setup":
        return _setup(arguments, environment, here)
    if command == "update":
        return update.take_over(arguments, root)
    tests = command in ("test", "targets")  # both need the test tools
    if here:
        _check_here(environment.root, TEST_LOCK if tests else LOCK)
        python, variables = sys.executable, dict(os.environ)
    else:
        environment.ensure(tests=tests)
        python, variables = str(environment.python), environment.variables()
    if arm is not None:
        if not Path(arm).is_file():
            raise SetUpError(f"There is no arm file '{arm}'. Write one with Arm.save, or give its path.")
        variables["IR50P_ARM"] = str(Path(arm).resolve())
    if tests:
        with tempfile.TemporaryDirectory() as home:  # neither the student's results are used nor others left behind
            variables["IR50P_HOME"] = home
            module = "tests" if command == "test" else "tests.targets"
            return _attend([python, "-m", module, *arguments], variables, environment.root)
    modules = {
        "bench-test": "ir50p_lab.bench.bench_test",
        "export": "ir50p_lab.publishing",
        "report": "ir50p_lab.publishing.report",
    }
    if command in modules:
        return _attend([python, "-m", modules[command], *arguments], variables)
    code = _attend([python, *_lab_command(environment.root, arguments)], variables)
    return 0 if code == 128 + signal.SIGINT else code  # Ctrl-C is how one ends JupyterLab


def _setup(arguments, environment, here):
    rebuild, tests = _take_flag(arguments, "--rebuild"), _take_flag(arguments, "--tests")
    if arguments:
        raise SetUpError(f"setup does not know '{arguments[0]}'. Try '{COMMAND} --help'.")
    if here:
        _check_here(environment.root, TEST_LOCK if tests else LOCK)
    else:
        environment.ensure(tests=tests, rebuild=rebuild)
    print("Everything is in place." if here else f"Ready: {environment.folder}")
    return 0


def _lab_command(root, arguments):
    """JupyterLab on notebooks/, or on the file or folder given as the first argument."""
    target = [] if arguments and not arguments[0].startswith("-") else [str(root / "notebooks")]
    if hasattr(os, "geteuid") and os.geteuid() == 0 and "--allow-root" not in arguments:
        arguments = [*arguments, "--allow-root"]  # containers run as root; JupyterLab would only refuse
    print("Opening JupyterLab. If no browser opens, copy the address http://... below into one; Ctrl-C here ends it.")
    return ["-P", "-m", "jupyterlab", *target, *arguments]


def _attend(command, variables, folder=None):
    """Run a program to its end. Ctrl-C is for it to answer: it sits at the same terminal."""
    sys.stdout.flush()
    child = subprocess.Popen(command, env=variables, cwd=folder)
    while True:
        try:
            code = child.wait()
            return code if code >= 0 else 128 - code  # ended by a signal: as a shell counts it
        except _TerminatedError:
            child.terminate()
        except KeyboardInterrupt:
            continue


def _check_here(root, lock):
    """Raise SetUpError unless the running Python has the packages of the lock, in whatever version."""
    found = inventory.packages(root / lock)
    missing = [package["name"] for package in found if package["installed"] is None]
    project = inventory.installed_version("ir50p-lab") is None
    if not missing and not project:
        return
    python = "py" if os.name == "nt" else sys.executable
    steps = [f"{python} -m pip install -r {root / lock}"] if missing else []
    if project:
        missing.append("ir50p-lab")
        steps.append(f"{python} -m pip install --no-deps --no-build-isolation -e {root}")
    names = ", ".join(missing[:6]) + (f" and {len(missing) - 6} more" if len(missing) > 6 else "")
    raise SetUpError(f"This Python ({sys.executable}) lacks {names}. Install with: {' && '.join(steps)}")


class _TerminatedError(KeyboardInterrupt):
    """The launcher itself was asked to end (SIGTERM, terminal closed)."""


def _stop(signum, frame):
    raise _TerminatedError


def _take_flag(arguments, name):
    if name not in arguments:
        return False
    arguments.remove(name)
    return True


def _take_value(arguments, name):
    arguments[:] = [part for a in arguments for part in (a.split("=", 1) if a.startswith(f"{name}=") else [a])]
    if name not in arguments:
        return None
    place = arguments.index(name)
    _, *value = arguments[place : place + 2]
    if not value:
        raise SetUpError(f"{name} needs a file after it. Try '{COMMAND} --help'.")
    del arguments[place : place + 2]
    return value[0]
