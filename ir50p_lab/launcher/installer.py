"""Packages into .venv: pip puts uv there and uv does the rest; pip does all of it where uv cannot.

uv reads neither pip.conf nor PIP_*, so what they say is translated for it.
"""

import ast
import os
import subprocess

from ir50p_lab.launcher import problems

#: pip's settings as options of uv; each may have several values, between blanks.
_OPTIONS = {
    "index-url": "--default-index",
    "extra-index-url": "--index",
    "find-links": "--find-links",
    "trusted-host": "--allow-insecure-host",
}
_FLAGS = {"no-index": "--no-index", "no-cache-dir": "--no-cache"}
#: pip's settings as environment variables of uv.
_VARIABLES = {
    "cert": ("SSL_CERT_FILE",),
    "client-cert": ("SSL_CLIENT_CERT",),
    "proxy": ("HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY"),
    "timeout": ("UV_HTTP_TIMEOUT",),
    "default-timeout": ("UV_HTTP_TIMEOUT",),
    "retries": ("UV_HTTP_RETRIES",),
}
#: pip's settings that do not touch what is installed, or that the set-up makes itself.
_WITHOUT_MEANING = set(
    "break-system-packages cache-dir config-file disable-pip-version-check log no-color no-compile no-input "
    "no-python-version-warning no-warn-script-location only-binary prefer-binary progress-bar quiet "
    "require-virtualenv require-venv root-user-action user verbose".split()
)


def for_uv(listing):
    """Translate what `pip config list` printed: (options, variables), None if a setting has no counterpart."""
    settings = {}
    for section in ("global.", "install.", ":env:."):  # what comes later is stronger
        for line in listing.splitlines():
            name, _, value = line.partition("=")
            if name.startswith(section):
                settings[name.removeprefix(section)] = ast.literal_eval(value)
    options, variables = ["--index-strategy", "unsafe-best-match"], {}  # as pip: all indexes are equal
    for name, value in settings.items():
        if name in _OPTIONS:
            options += [part for address in value.split() for part in (_OPTIONS[name], address)]
        elif name in _VARIABLES:
            variables |= dict.fromkeys(_VARIABLES[name], value)
        elif name in _FLAGS:
            options += [_FLAGS[name]] if _is_true(value) else []
        elif name not in _WITHOUT_MEANING and value:
            return None
    return options, variables


class Installer:
    """Installs into the environment of `python`; `lock` is a file descriptor that every installer holds open."""

    def __init__(self, python, variables, *, folder, log, lock, stream):
        self._python = [str(python), "-P", "-m"]
        self._variables = variables | {"PIP_USER": "0", "PYTHONIOENCODING": "utf-8", "PYTHONUNBUFFERED": "1"}
        self._folder, self._log, self._stream = folder, log, stream
        # An installer inherits the lock: after a 'kill -9' of the launcher the next set-up waits until it has ended.
        self._pass_fds = () if lock is None or os.name == "nt" else (lock,)
        self._install = [*self._python, "pip", "install", "--disable-pip-version-check", "--no-color", "-vv"]

    def fetch_uv(self, requirement):
        """Put uv there, to be used if it can do what pip is told to do; False if none fits this machine."""
        code, output = self._run([*self._install, "--only-binary", ":all:", requirement])
        if code:
            error = problems.from_output(output, code, self._folder, self._log)
            if isinstance(error, problems.NoWheelError):
                return False
            raise error
        translated = for_uv(self._run([*self._python, "pip", "config", "list"])[1])
        if translated is not None:
            options, variables = translated
            self._install = [*self._python, "uv", "pip", "install", "--python", self._python[0], *options]
            self._variables |= variables
        return True

    def install(self, *arguments):
        """Install with uv, or pip. Raises SetUpError."""
        code, output = self._run([*self._install, *arguments])
        if code:
            raise problems.from_output(output, code, self._folder, self._log)

    def _run(self, command):
        """Run to the end, each line shown on a terminal for as long as it is the last; (exit code, output)."""
        child = subprocess.Popen(
            command,
            env=self._variables,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            pass_fds=self._pass_fds,
        )
        output = []
        try:
            for line in child.stdout:
                output.append(line)
                self._show(line.strip())
            return child.wait(), "".join(output)
        finally:
            self._show("")
            _end(child)
            with open(self._log, "a", encoding="utf-8") as log:
                log.write("".join([f"{command}\n", *output]))

    def _show(self, text):
        if self._stream.isatty():
            self._stream.write(f"\r{'':78}\r{text[:78]}")
            self._stream.flush()


def _is_true(value):
    return value.lower() in ("1", "true", "yes", "on", "y", "t")


def _end(child):
    """Leave no installer behind that would go on writing after an interruption."""
    child.stdout.close()
    if child.poll() is None:
        try:
            child.wait(timeout=3)  # a Ctrl-C reached it too: let it tidy up
        except (subprocess.TimeoutExpired, KeyboardInterrupt):
            child.kill()
    child.wait()
