"""The IR50P lab book. In the project's folder (on Windows write py instead of python3):

  python3 -m ir50p_lab [...]          set up .venv on first use, then open JupyterLab on notebooks/
  python3 -m ir50p_lab test [...]     set up with the test tools, then run the tests and every notebook
                                      (--quick: no notebooks; --everywhere: as on other processors, other arms)
  python3 -m ir50p_lab export [...]   notebooks as pages that need no network: HTML, and PDF where a browser is
  python3 -m ir50p_lab book [FOLDER]  all notebooks, the texts and a reference as a book with a search (default: book)
  python3 -m ir50p_lab targets [...]  measure what the project set out to reach, as tables beside the thesis
  python3 -m ir50p_lab setup          only set up (--rebuild: from nothing; --tests: with the test tools)
  python3 -m ir50p_lab bench-test     first power-on of the arm, joint by joint (rehearse: bench-test simulated)
  python3 -m ir50p_lab report         your lab report: predictions, figures, functions (--name "Your Name")
  python3 -m ir50p_lab try-page       write docs/try/index.html again, README's page to try; then animation: its picture
  python3 -m ir50p_lab site [...]     the course as a site that runs in a browser tab (--pyodide FOLDER|URL)
  python3 -m ir50p_lab update FOLDER  take over what is yours from an older copy of the course, or a browser tab's ZIP
  python3 -m ir50p_lab pack           all that is yours, recordings and reports of bench-test too, as one ZIP to send
  python3 -m ir50p_lab grade FOLDER   check what a class has handed in: a table (CSV) and a page (HTML)
  python3 -m ir50p_lab judge FILE     race a hand-in of notebook 19 on arms that nobody has seen (--arms 20)
  python3 -m ir50p_lab doctor         what is installed, what is missing, serial ports, verdict

  --here         use the Python that runs this instead of .venv (Binder, JupyterHub); installs nothing
  --arm FILE     use the arm in this file instead of the IR50P (the same as IR50P_ARM=FILE)

Further arguments go to JupyterLab, to pytest (paths count from the project's folder) or to the targets:

  py -m ir50p_lab --no-browser --port 9999
  py -m ir50p_lab test -k pose
  py -m ir50p_lab targets vision --quick    (or identification, computed_torque, hostile, unknown_arm)
"""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from ir50p_lab.launcher import doctor, inventory
from ir50p_lab.launcher.environment import LOCK, TEST_LOCK, Environment
from ir50p_lab.launcher.problems import COMMAND, SetUpError, from_error

ROOT = Path(__file__).resolve().parents[2]

#: What runs in the environment, with the arguments that follow.
_MODULES = {
    "lab": "jupyterlab",
    "test": "tests",
    "targets": "tests.targets",
    "bench-test": "ir50p_lab.bench.bench_test",
    "export": "ir50p_lab.course.publishing",
    "book": "ir50p_lab.course.publishing.book",
    "report": "ir50p_lab.course.publishing.report",
    "try-page": "ir50p_lab.course.publishing.try_page",
    "animation": "tests.support.animation",
    "site": "ir50p_lab.course.publishing.site",
    "update": "ir50p_lab.course.lab_book.update",
    "pack": "ir50p_lab.course.publishing.take_home",
    "grade": "ir50p_lab.course.grading",
    "judge": "ir50p_lab.course.grading.judge",
}
#: What asks the launcher to end: `kill`, and a terminal that is closed (not on Windows).
_ENDS = {signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)}


def main(arguments, root=ROOT):
    """Run the command line; return the exit code."""
    for stream in filter(None, (sys.stdout, sys.stderr)):  # pythonw has none
        if hasattr(stream, "reconfigure"):  # paths may have letters that the console does not
            stream.reconfigure(errors="replace", line_buffering=True)
    for number in _ENDS:
        signal.signal(number, signal.default_int_handler)  # as Ctrl-C
    try:
        return _run(arguments, Path(root))
    except (SetUpError, argparse.ArgumentError) as problem:
        print(problem, file=sys.stderr)
        return 1
    except (OSError, ImportError) as error:
        print(from_error(error, root), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"\nStopped. Run '{COMMAND}' again whenever you like: it goes on with what is missing.", file=sys.stderr)
        return 130


def _run(arguments, root):
    if arguments[:1] in (["-h"], ["--help"], ["help"]):
        print(__doc__, end="")
        return 0
    if not (root / LOCK).is_file():
        raise SetUpError(
            f"{root} is not the project's folder: it has no {LOCK}. Run '{COMMAND}' in the folder that was cloned or "
            "unpacked."
        )
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False, exit_on_error=False)
    parser.add_argument("--here", action="store_true")
    parser.add_argument("--arm", metavar="FILE")
    options, arguments = parser.parse_known_args(arguments)
    command = arguments.pop(0) if arguments[:1] and arguments[0] in (*_MODULES, "setup", "doctor") else "lab"
    file = command == "lab" and bool(arguments) and not arguments[0].startswith("-")
    if file and not Path(arguments[0]).exists():
        raise SetUpError(f"There is neither a command nor a file '{arguments[0]}'. Try '{COMMAND} --help'.")
    if command in ("test", "targets", "animation") and not (root / "tests").is_dir():
        raise SetUpError(f"{root} came without tests: '{command}' needs the repository, cloned or unpacked.")
    environment = Environment(root)
    if command == "doctor":
        return doctor.report(environment, here=options.here)
    if command == "setup":
        for unknown in set(arguments) - {"--rebuild", "--tests"}:
            raise SetUpError(f"setup does not know '{unknown}'. Try '{COMMAND} --help'.")
        _ready(environment, options.here, tests="--tests" in arguments, rebuild="--rebuild" in arguments)
        print("Everything is in place." if options.here else f"Ready: {environment.folder}")
        return 0
    tests = command in ("test", "targets", "animation")
    python, variables = _ready(environment, options.here, tests=tests)
    if options.arm is not None:
        if not Path(options.arm).is_file():
            raise SetUpError(f"There is no arm file '{options.arm}'. Write one with Arm.save, or give its path.")
        variables["IR50P_ARM"] = str(Path(options.arm).resolve())
    if tests:
        with tempfile.TemporaryDirectory() as home:  # neither the student's results are used nor others left behind
            start = [python, "-m", _MODULES[command], *arguments]
            return _attend(start, variables | {"IR50P_HOME": home}, environment.root)
    if command == "lab":
        notebooks = [] if file else [str(environment.root / "notebooks"), *_first_page(environment.root)]
        arguments = [*notebooks, *arguments, "--allow-root"]  # containers run as root; JupyterLab would only refuse
        print(
            "Opening JupyterLab. If no browser opens, copy the address http://... below into one; Ctrl-C here ends it."
        )
    code = _attend([python, "-P", "-m", _MODULES[command], *arguments], variables)
    return 0 if command == "lab" and code == 128 + signal.SIGINT else code  # Ctrl-C is how one ends JupyterLab


def _first_page(root):
    """Return the option that opens JupyterLab on 00; [] once the student has files: it opens what was open last."""
    pages = [path.name for path in (root / "notebooks").glob("00_*.ipynb")]
    if pages:
        from ir50p_lab.home import home  # beside the launcher, but of the standard library, too

        if any((home() / name).exists() for name in ("progress.json", "results", "my_robot", "recordings")):
            return []
    return [f"--LabApp.default_url=/lab/tree/{page}" for page in pages]


def _ready(environment, here, *, tests, rebuild=False):
    """Make .venv ready, or see that this Python has what the lock asks for, in whatever version: Python, variables."""
    if not here:
        environment.ensure(tests=tests, rebuild=rebuild)
        return str(environment.python), environment.variables()
    lock = environment.root / (TEST_LOCK if tests else LOCK)
    installed = {package["name"]: package["installed"] for package in inventory.packages(lock)}
    installed["ir50p-lab"] = inventory.installed_version("ir50p-lab")
    missing = [name for name, version in installed.items() if version is None]
    if missing:
        pip = f"{'py' if os.name == 'nt' else sys.executable} -m pip install"
        raise SetUpError(
            f"This Python ({sys.executable}) lacks {', '.join(missing)}. Install with: {pip} -r {lock} && "
            f"{pip} --no-deps --no-build-isolation -e {environment.root}"
        )
    return sys.executable, dict(os.environ)


def _attend(command, variables, folder=None):
    """Run a program to its end. Ctrl-C is for it to answer: it sits at the same terminal."""
    signal.signal(signal.SIGINT, lambda *_: None)  # not SIG_IGN, which the program would inherit
    child = subprocess.Popen(command, env=variables, cwd=folder)
    for number in _ENDS:
        signal.signal(number, lambda *_: child.terminate())
    code = child.wait()
    return code if code >= 0 else 128 - code  # ended by a signal: as a shell counts it
