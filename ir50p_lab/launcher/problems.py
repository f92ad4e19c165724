"""Every way the set-up can fail, as one line that says what to do next."""

import errno
import os
import platform
import re
import sys

COMMAND = "py -m ir50p_lab" if os.name == "nt" else "python3 -m ir50p_lab"

#: What pip and the operating systems say when ...
_DISK_FULL = r"No space left on device|\[Errno 28\]|Disk quota exceeded|\[WinError 112\]|not enough space on the disk"
_NO_PERMISSION = r"\[Errno 13\]|Permission denied|\[WinError 5\]|Access is denied|Read-only file system|\[Errno 30\]"
_PATH_TOO_LONG = r"\[WinError 206\]|Windows Long Path support|File name too long|\[Errno 36\]"
_PROXY = r"ProxyError|Tunnel connection failed|Cannot connect to proxy|407 Proxy"
_CERTIFICATE = r"CERTIFICATE_VERIFY_FAILED|SSLError|SSLCertVerificationError"
_NETWORK = (
    r"connection broken by|NewConnectionError|ConnectTimeout|ReadTimeout|ConnectionResetError|ProtocolError"
    r"|IncompleteRead|Name or service not known|Temporary failure in name resolution|getaddrinfo failed"
    r"|Network is unreachable|Max retries exceeded|Could not fetch URL|HTTPError|HTTP error"
)
_NO_WHEEL = r"No matching distribution found for ([^\s;]+)"
_HALF_WHEEL = r"has an invalid wheel|BadZipFile|Wheel .* is invalid|File is not a zip file"
_ENSUREPIP = r"ensurepip is not available|No module named '?ensurepip"


class SetUpError(Exception):
    """Something the person at the keyboard can put right; its text says how."""


def disk_full(folder):
    """Disk or quota is full."""
    return SetUpError(
        f"The disk is full: {folder} could not be written. Free about 2 GB (emptying the recycle bin and "
        f"'{_python()} -m pip cache purge' help), then run '{COMMAND}' again; the set-up starts afresh by itself."
    )


def no_permission(folder):
    """The project folder (or .venv) may not be written."""
    return SetUpError(
        f"No permission to write in {folder}. Move the project into your home folder (or ask its owner for write "
        f"permission), then run '{COMMAND}' there."
    )


def no_venv_module(missing):
    """Python came without the module venv or ensurepip."""
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    return SetUpError(
        f"This Python {version} came without its module '{missing}', which makes the project's own environment. "
        f"Debian, Ubuntu: 'sudo apt install python{version}-venv', then run '{COMMAND}' again. "
        "Elsewhere: install Python from https://www.python.org/downloads/"
    )


def in_use(folder):
    """Windows does not delete files that a program holds open."""
    return SetUpError(
        f"{folder} is in use and cannot be rebuilt: close JupyterLab and every program that runs Python from it, "
        f"then run '{COMMAND}' again."
    )


def from_os_error(error, folder):
    """Turn an OSError of the launcher itself into a SetUpError."""
    if error.errno in (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC)):
        return disk_full(folder)
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return no_permission(folder)
    return SetUpError(f"The operating system refused: {error}. Put that right, then run '{COMMAND}' again.")


def from_output(output, returncode, folder, log):
    """Turn what a failed pip or venv printed into a SetUpError.

    The order matters: a full disk also shows as a broken connection, a missing connection also as a missing package.
    """
    if re.search(_DISK_FULL, output):
        return disk_full(folder)
    if re.search(_PATH_TOO_LONG, output):
        return SetUpError(
            f"The path {folder} is too long for this system: move the project to a short one, such as C:\\ir50p, "
            f"and run '{COMMAND}' there."
        )
    if re.search(_ENSUREPIP, output):
        return no_venv_module("ensurepip")
    if re.search(_PROXY, output):
        return no_network("the proxy refused the connection", "Check the address in HTTPS_PROXY")
    if re.search(_CERTIFICATE, output):
        return no_network(
            "the download server's certificate was not accepted",
            "Check the clock of this machine; behind a proxy that opens traffic, set PIP_CERT to its certificate file",
        )
    if re.search(_NETWORK, output):
        return no_network("no connection to the download server", "Check the network; behind a proxy set HTTPS_PROXY")
    if match := re.search(_NO_WHEEL, output):
        return no_wheel(match[1])
    if re.search(_HALF_WHEEL, output):
        return SetUpError(
            f"A downloaded package is damaged. Run '{_python()} -m pip cache purge', then '{COMMAND}' again "
            "(offline: copy the wheel folder once more)."
        )
    if re.search(_NO_PERMISSION, output):
        return no_permission(folder)
    if returncode < 0:
        return SetUpError(
            f"The installer was ended by signal {-returncode} (often: out of memory). "
            f"Close other programs, then run '{COMMAND}' again."
        )
    return SetUpError(
        f"The set-up failed: {_last_error(output)}. All of pip's output is in {log}; then run '{COMMAND}' again."
    )


def no_network(what, advice):
    """Nothing could be downloaded."""
    return SetUpError(
        f"Download failed: {what}. {advice} (for example HTTPS_PROXY=http://proxy.example:3128), then run "
        f"'{COMMAND}' again. Without any network: README.md, section 'Offline'."
    )


def no_wheel(requirement):
    """The index or the wheel folder answered, but has no file that fits this machine."""
    machine = f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"
    if os.environ.get("PIP_NO_INDEX", "").lower() not in ("", "0", "false", "no", "off"):
        return SetUpError(
            f"The wheel folder ({os.environ.get('PIP_FIND_LINKS', 'PIP_FIND_LINKS is not set')}) has no {requirement} "
            f"for {machine}. Fill it on a machine of the same kind: README.md, section 'Offline'."
        )
    return SetUpError(
        f"There is no ready-made package {requirement} for {machine}. Use a 64-bit Python 3.11 to 3.14 from "
        "https://www.python.org/downloads/ (on Macs with an Intel processor 3.11 to 3.13)."
    )


def _last_error(output):
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    errors = [line for line in lines if re.match(r"(ERROR|error|Error|\w*Error):", line)]
    line = (errors or lines or ["no output"])[-1]
    return re.sub(r"^(ERROR|error|Error): *", "", line).rstrip(".")


def _python():
    return "py" if os.name == "nt" else "python3"
