"""A report on this machine, as one would paste it into a question, with a verdict at the end."""

import json
import os
import platform
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from ir50p_lab.launcher import inventory
from ir50p_lab.launcher.boards import board_name, permission_remedy
from ir50p_lab.launcher.environment import LOCK, NEEDED_GB
from ir50p_lab.launcher.problems import COMMAND


def report(environment, *, here=False, stream=None):
    """Print the report; return 0 if the lab book can be opened, else 1."""
    stream = stream or sys.stdout
    root = environment.root

    def line(title, text):
        print(f"{title:<14}{text}", file=stream)

    line("Python", f"{platform.python_version()}, {platform.architecture()[0]} ({sys.executable})")
    line("System", f"{platform.platform()} {platform.machine()}")
    line("Project", str(root))
    faults = []
    if not (root / LOCK).is_file():
        line("Lock", f"{LOCK} is missing")
        return _verdict(
            stream, [f"this is not the project's folder: {LOCK} is missing"], "Run it where it was unpacked"
        )

    state = environment.state()
    cure = f"Run '{COMMAND}' to set up"
    if here:
        found = inventory.collect(root / LOCK)
        cure = f"'{COMMAND} --here' prints the command that installs it"
    else:
        line("Environment", f"{environment.folder}: {state.reason}")
        found = _look_inside(environment) if state.ready else None
        if state.ready and found is None:
            faults.append("the environment does not answer")
        elif not state.ready:
            faults.append(f"the environment is {state.reason}")
    if found:
        faults += _packages(found, root, line, here)
        if faults and not here:
            cure = f"Run '{COMMAND} setup --rebuild'"

    free = shutil.disk_usage(root).free / 1e9
    line("Free disk", f"{free:.1f} GB")
    if free < NEEDED_GB and not state.ready and not here:
        faults.append(f"the set-up needs {NEEDED_GB:.0f} GB of disk, {free:.1f} GB are free")
    arm = os.environ.get("IR50P_ARM")
    if arm:
        line("Arm", f"{arm} (from IR50P_ARM)")
        if not Path(arm).is_file():
            faults.append(f"IR50P_ARM names a file that does not exist ({arm})")
    _ports(found, line)
    return _verdict(stream, faults, cure)


def _look_inside(environment):
    """Run the inventory inside .venv; None if that fails."""
    command = [str(environment.python), "-P", inventory.__file__, str(environment.root / LOCK)]
    done = subprocess.run(command, env=environment.variables(), capture_output=True, encoding="utf-8")
    try:
        return json.loads(done.stdout)
    except ValueError:
        return None


def _packages(found, root, line, here):
    """Compare what is installed with the lock; return the faults."""
    wanted = found["packages"]
    missing = [package for package in wanted if package["installed"] is None]
    other = [package for package in wanted if package["installed"] not in (None, package["wanted"])]
    line(
        "Packages",
        f"{len(wanted) - len(missing) - len(other)} of {len(wanted)} as in {LOCK} (Python {found['python']})",
    )
    direct = _direct_dependencies(root)
    key = [f"{p['name']} {p['installed']}" for p in wanted if p["name"] in direct and p["installed"]]
    for i in range(0, len(key), 5):
        line("", ", ".join(key[i : i + 5]))
    for package in missing:
        line("", f"missing: {package['name']} {package['wanted']}")
    for package in other:
        line("", f"differs: {package['name']} {package['installed']}, the lock has {package['wanted']}")
    faults = []
    if missing:
        faults.append(f"{len(missing)} packages are missing")
    if other and not here:  # a hub brings its own versions
        faults.append(f"{len(other)} packages differ from the lock")
    if found["project"] is None:
        line("", "missing: ir50p-lab (this project, installed editable)")
        faults.append("the lab book itself is not installed")
    return faults


def _direct_dependencies(root):
    with open(root / "pyproject.toml", "rb") as file:
        dependencies = tomllib.load(file)["project"]["dependencies"]
    return {dependency.split(">")[0].split("=")[0].strip() for dependency in dependencies}


def _ports(found, line):
    ports = found and found["ports"]
    if ports is None:
        line("Serial ports", "not looked at (pyserial comes with the set-up)")
        return
    usb = [port for port in ports if port["usb"]]
    others = len(ports) - len(usb)
    if not usb:
        line("Serial ports", "no USB board" + (f" ({others} ports without USB id)" if others else ""))
    for port in usb:
        allowed = os.name == "nt" or os.access(port["device"], os.R_OK | os.W_OK)
        advice = "" if allowed else f", no permission: {permission_remedy(port['device'])}"
        board = board_name(*(int(part, 16) for part in port["usb"].split(":")))
        known = f" ({board})" if board else ""
        line("Serial ports", f"{port['device']} {port['usb']} {port['description']}{known}{advice}")


def _verdict(stream, faults, cure):
    if faults:
        print(f"Verdict: not ready: {'; '.join(faults)}. {cure}.", file=stream)
        return 1
    print(f"Verdict: ready. Open the lab book with '{COMMAND}'.", file=stream)
    return 0
