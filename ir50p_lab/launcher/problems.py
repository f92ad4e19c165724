"""Every way the set-up can fail, as one line that says what to do next."""

import os
import platform
import re
import sysconfig

COMMAND = "py -m ir50p_lab" if os.name == "nt" else "python3 -m ir50p_lab"
_PYTHON = "py" if os.name == "nt" else "python3"
_AGAIN = f"then run '{COMMAND}' again"
_NO_NETWORK = (
    f" (for example HTTPS_PROXY=http://proxy:3128), {_AGAIN}. Without any network: README.md, section 'Offline'."
)
_IN_USE = "Close JupyterLab and all that runs Python from .venv; that may be all. " if os.name == "nt" else ""
#: Signs of a problem in what the system, pip or uv say, and what to do then. The order matters: a full disk also shows
#: as a broken connection.
_PROBLEMS = {
    r"No space left on device|\[Errno 28\]|Dis[ck] quota exceeded|\[WinError 112\]|not enough space on the": (
        "The disk is full: {folder} could not be written. Free about 2 GB (emptying the recycle bin helps, and so does "
        f"'{_PYTHON} -m pip cache purge'), {_AGAIN}; the set-up starts afresh by itself."
    ),
    r"\[WinError 206\]|Windows Long Path support|File name too long|\[Errno 36\]": (
        "The path {folder} is too long for this system: move the project to a short one, such as C:\\ir50p, "
        f"and run '{COMMAND}' there."
    ),
    r"No module named '?ensurepip|ModuleNotFoundError: .*\b(venv|ensurepip)|ensurepip is not\s+available": (
        "This Python came without its modules 'venv' and 'ensurepip', which make the project's own environment. "
        f"Debian, Ubuntu: 'sudo apt install python{sysconfig.get_python_version()}-venv', {_AGAIN}. "
        "Elsewhere: install Python from https://www.python.org/downloads/"
    ),
    r"ProxyError|[Tt]unnel (connection failed|error)|Cannot connect to proxy|407 Proxy": (
        f"Download failed: the proxy refused the connection. Check the address in HTTPS_PROXY{_NO_NETWORK}"
    ),
    r"CERTIFICATE_VERIFY_FAILED|SSLError|SSLCertVerificationError|invalid peer certificate": (
        "Download failed: the download server's certificate was not accepted. Check the clock of this machine; behind "
        f"a proxy that opens traffic, set PIP_CERT to its certificate file{_NO_NETWORK}"
    ),
    r"connection broken by|NewConnectionError|ConnectTimeout|ReadTimeout|ConnectionResetError|ProtocolError"
    r"|IncompleteRead|Name or service not known|Temporary failure in name resolution|getaddrinfo failed"
    r"|Network is unreachable|Max retries exceeded|Could not fetch URL|HTTPError|HTTP error"
    r"|Failed to fetch|error sending request|tcp connect error": (
        "Download failed: no connection to the download server. Check the network; behind a proxy set HTTPS_PROXY"
        f"{_NO_NETWORK}"
    ),
    r"has an invalid wheel|BadZipFile|Wheel .* is invalid|invalid package format|zip file": (
        f"A downloaded package is damaged. Run '{_PYTHON} -m pip cache purge', then '{COMMAND}' again "
        "(offline: copy the wheel folder once more)."
    ),
    r"\[Errno (1|13|30)\]|Permission denied|\[WinError 5\]|Access is denied|Read-only file system": (
        f"No permission to write in {{folder}}. {_IN_USE}Move the project into your home folder (or ask its owner for "
        f"write permission), then run '{COMMAND}' there."
    ),
    r"\[Errno 17\]|\[WinError 183\]": (
        f"A file, or a link that leads nowhere, is in the place of a folder: {{file}}. Remove or rename it, {_AGAIN}."
    ),
}
#: What pip and uv say when there is no package for this machine, as with a missing connection; one group names it.
_NO_WHEEL = (
    r"No matching distribution found for ([^\s;]+)"
    r"|(?:not found in the (?:provided package locations|package registry)|there is no version of|has no wheels with)"
    r"[^.]*? you require ([^\s,;]+)"
)


class SetUpError(Exception):
    """Something the person at the keyboard can put right; its text says how."""


class NoWheelError(SetUpError):
    """The index or the wheel folder answered, but has no file that fits this machine."""


def from_error(error, folder):
    """Turn an OSError or ImportError of the launcher itself into a SetUpError."""
    text, file = str(error), getattr(error, "filename", None)
    if getattr(error, "errno", None) is not None:  # without the path: that may have any words in it
        windows = getattr(error, "winerror", None)
        text = f"[WinError {windows}] {error.strerror}" if windows else f"[Errno {error.errno}] {error.strerror}"
    return _known(f"{type(error).__name__}: {text}", folder, file or ".venv") or SetUpError(
        f"The operating system refused: {error}. Put that right, {_AGAIN}."
    )


def from_output(output, code, folder, log):
    """Turn what a failed installer or venv printed into a SetUpError."""
    # an index that lacks a package says so with 404; the next one may have it
    output = "".join(line for line in output.splitlines(keepends=True) if "404 Client Error" not in line)
    known = _known(output, folder)
    missing = re.search(_NO_WHEEL, output)
    if known or missing:
        return known or _no_wheel(missing[1] or missing[2])
    if code < 0:
        return SetUpError(
            f"The installer was ended by signal {-code} (often: out of memory). Close other programs, {_AGAIN}."
        )
    return SetUpError(f"The set-up failed: {_last_error(output)}. All that was printed is in {log}; {_AGAIN}.")


def _known(text, folder, file=".venv"):
    for sign, advice in _PROBLEMS.items():
        if re.search(sign, text):
            return SetUpError(advice.format(folder=folder, file=file))
    return None


def _no_wheel(requirement):
    machine = f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"
    if os.environ.get("PIP_NO_INDEX", "").lower() not in ("", "0", "false", "no", "off"):
        return NoWheelError(
            f"The wheel folder ({os.environ.get('PIP_FIND_LINKS', 'PIP_FIND_LINKS is not set')}) has no {requirement} "
            f"for {machine}. Fill it on a machine of the same kind: README.md, section 'Offline'."
        )
    return NoWheelError(
        f"There is no ready-made package {requirement} for {machine}. Use a 64-bit Python 3.11 to 3.14 from "
        "https://www.python.org/downloads/ (on Macs with an Intel processor 3.11 to 3.13)."
    )


def _last_error(output):
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    errors = [line for line in lines if re.match(r"(ERROR|error|Error|\w*Error):", line)]
    line = (errors or lines or ["no output"])[-1]
    return re.sub(r"^(ERROR|error|Error): *", "", line).rstrip(".")
