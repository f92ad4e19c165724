"""Packages into .venv: pip puts uv there and uv does the rest; if uv cannot, pip does all of it.

uv reads neither pip.conf nor PIP_*, so what they say is translated for it, by pip_settings.toml.
"""

import ast
import contextlib
import os
import subprocess
import sys
import threading
import time
import tomllib
from pathlib import Path

from ir50p_lab.launcher import problems


def for_uv(listing):
    """Translate what `pip config list` printed into (options, variables); None if a setting has no counterpart."""
    settings = {}
    for section in ("global.", "install.", ":env:."):  # what comes later is stronger
        for line in listing.splitlines():
            name, _, value = line.partition("=")
            if name.startswith(section) and ast.literal_eval(value):  # to pip an empty one is not set
                settings[name.removeprefix(section)] = ast.literal_eval(value)
    table = tomllib.loads(Path(__file__).with_name("pip_settings.toml").read_text("utf-8"))
    options, variables = ["--index-strategy", "unsafe-best-match"], {}  # as pip: all indexes are equal
    for name, value in settings.items():
        if name in table["options"]:
            options += [f"{table['options'][name]}={address}" for address in value.split()]
        elif name in table["variables"]:
            variables |= dict.fromkeys(table["variables"][name], " ".join(value.split()))
        elif name == "no-index":
            options += ["--no-index"] if value.lower() in ("1", "true", "yes", "on", "y", "t") else []
        elif name not in table["without_meaning"]["names"]:
            return None
    return options, variables


class Installer:
    """Runs what installs into the `environment`; each such program holds the file `lock` open."""

    def __init__(self, environment, lock):
        self._environment = environment
        self._python = [str(environment.python), "-P", "-m"]
        self._install = [*self._python, "pip", "install", "--disable-pip-version-check", "--no-color", "-vv"]
        self._install += ["--target="]  # not the folder that a pip.conf may name
        own = {"PYTHONIOENCODING": "utf-8", "PYTHONUNBUFFERED": "1", "PIP_USER": "0"}
        variables = environment.variables() | own
        # Without the course's own settings: one that is wrong is told where it is used.
        self._variables = {name: value for name, value in variables.items() if not name.startswith("IR50P_")}
        # It inherits the lock: after a 'kill -9' of the launcher the next set-up waits until it has ended.
        self._pass_fds = () if os.name == "nt" else (lock.fileno(),)

    def fetch_uv(self, requirement):
        """Install uv, and use it if it fits this machine and can do what pip is told to do. Raises SetUpError."""
        try:
            self.install("--only-binary", ":all:", requirement)
        except problems.NoWheelError:
            return
        translated = for_uv(self.run([*self._python, "pip", "config", "list"]))
        if translated is not None:
            options, variables = translated
            self._install = [*self._python, "uv", "pip", "install", "--python", self._python[0], *options]
            self._variables |= variables

    def install(self, *arguments):
        """Install with uv, or pip. Raises SetUpError."""
        self.run([*self._install, *arguments])

    def run(self, command):
        """Run a command, showing its seconds and last line on a terminal; return its output. Raises SetUpError."""
        output = ""
        with (
            clock() as last,
            subprocess.Popen(
                command,
                env=self._variables,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                encoding="utf-8",
                errors="replace",
                pass_fds=self._pass_fds,
            ) as child,
        ):
            try:
                for line in child.stdout:
                    output += line
                    last[0] = line.strip()
            except BaseException:  # an interruption: leave no installer behind that would go on writing
                child.kill()
                raise
        with open(self._environment.log, "a", encoding="utf-8") as log:
            log.write(f"{command}\n{output}")
        if child.returncode:
            raise problems.from_output(output, child.returncode, self._environment.root, self._environment.log)
        return output


@contextlib.contextmanager
def clock():
    """Show on a terminal how long it has taken so far, and the text in the list that it gives."""
    ended, last, started = threading.Event(), [""], time.monotonic()

    def tick():
        while not ended.wait(0.25):
            _show(f"{time.monotonic() - started:4.0f} s  {last[0]}")

    ticking = threading.Thread(target=tick, daemon=True)
    ticking.start()
    try:
        yield last
    finally:
        ended.set()
        ticking.join()
        _show("")


def _show(text):
    if sys.stdout and sys.stdout.isatty():  # pythonw has none
        print(f"\r{'':78}\r{text[:78]}", end="", flush=True)
