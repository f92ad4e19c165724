"""A report on this machine, as you would paste it into a question, with a verdict at the end."""

import os
import platform
import shutil
import sys

from ir50p_lab.launcher.boards import board_name, permission_remedy
from ir50p_lab.launcher.environment import LOCK, UNWANTED
from ir50p_lab.launcher.problems import COMMAND


def report(environment, *, here=False):
    """Print the report; return 0 if the lab book can be opened, else 1."""
    root = environment.root
    _line("Python", f"{platform.python_version()}, {platform.architecture()[0]} ({sys.executable})")
    _line("System", f"{platform.platform()} {platform.machine()}")
    _line("Project", root)
    fault, cure = "", f"'{COMMAND} --here' prints the command that installs it"
    in_force = {name: value for name, value in sorted(os.environ.items()) if name in UNWANTED}
    if not here:
        fault = environment.fault()
        cure = f"Run '{COMMAND}' to set up" if fault else f"Run '{COMMAND} setup --rebuild'"
        _line("Environment", f"{environment.folder}: {fault or 'ready'}")
    else:
        for name, value in in_force.items():
            _line("Variables", f"{name}={value} (in force with --here)")
    found, faults = None, [f"the environment is {fault}"]
    if not fault:
        found, error = environment.look_inside(here=here)
        faults = _packages(found, here) if found else [f"the environment does not answer ({error})"]
        if here and "PYTHONPATH" in in_force and (not found or found["broken"]):
            cure = "Unset PYTHONPATH, whose folders come before the packages that are installed, and ask again"
    _line("Free disk", f"{shutil.disk_usage(root).free / 1e9:.1f} GB (the set-up needs 2)")
    if "IR50P_ARM" in os.environ:
        from ir50p_lab.home import path_setting, setting  # beside the launcher, but of the standard library, too

        if arm := setting("IR50P_ARM"):
            _line("Arm", f"{arm} (from IR50P_ARM)")
            if not path_setting("IR50P_ARM").is_file():
                faults.append(f"IR50P_ARM names a file that does not exist ({arm})")
    _ports(found["ports"] if found else None)
    verdict = f"not ready: {'; '.join(faults)}. {cure}." if faults else f"ready. Open the lab book with '{COMMAND}'."
    print(f"Verdict: {verdict}")
    return 1 if faults else 0


def _line(title, text):
    print(f"{title:<14}{text}")


def _packages(found, here):
    """Compare what is installed with the lock, and say what cannot be imported; return the faults."""
    wanted = found["packages"]
    missing = [p for p in wanted if p["installed"] is None]
    other = [p for p in wanted if p["installed"] not in (None, p["wanted"])]
    same = len(wanted) - len(missing) - len(other)
    _line("Packages", f"{same} of {len(wanted)} as in {LOCK} (Python {found['python']})")
    lines = [f"missing: {p['name']} {p['wanted']}" for p in missing]
    lines += [f"differs: {p['name']} {p['installed']}, the lock has {p['wanted']}" for p in other]
    lines += [f"broken: import {name}: {why}" for name, why in found["broken"].items()]
    for line in lines:
        _line("", line)
    faults = {
        f"{len(missing)} packages are missing": missing,
        f"{len(other)} packages differ from the lock": other and not here,  # a hub brings its own versions
        f"{', '.join(found['broken'])} cannot be imported": found["broken"],
        "the lab book itself is not installed": found["project"] is None,
    }
    return [fault for fault, holds in faults.items() if holds]


def _ports(ports):
    usb = [port for port in ports or [] if port["vid"] is not None]
    if not usb:
        _line("Serial ports", "not looked at (pyserial comes with the set-up)" if ports is None else "no USB board")
    for port in usb:
        text = f"{port['device']} {port['vid']:04X}:{port['pid']:04X} {port['description']}"
        board = board_name(port["vid"], port["pid"])
        if board:
            text += f" ({board})"
        if os.name != "nt" and not os.access(port["device"], os.R_OK | os.W_OK):
            text += f", no permission: {permission_remedy(port['device'])}"
        _line("Serial ports", text)
