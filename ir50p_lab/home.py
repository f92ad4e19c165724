"""Where everything of the student's is kept, and what the environment variables IR50P_* say. Standard library only.

All variables are read here, in the same manner. Blanks and quotes around a value do not count (`set X="..."` of the
Windows prompt keeps them); an empty one counts as unset. In a path, '~' is the home folder, and a relative path counts
from the project's folder, wherever a notebook runs.
"""

import os
import tempfile
from pathlib import Path

from ir50p_lab.browser_tab import IN_BROWSER, quick_home
from ir50p_lab.errors import WrongFolderError

VARIABLE = "IR50P_HOME"
PROJECT = Path.cwd().parent if IN_BROWSER else Path(__file__).parents[1]  # in a browser the package is a wheel


def home():
    """Return the student's folder: $IR50P_HOME, else notebooks/ of the project. It may not exist yet."""
    kept = PROJECT / "notebooks"
    return path_setting(VARIABLE) or (quick_home(kept) if IN_BROWSER else kept)


def check_folder():
    """Raise WrongFolderError if the notebook is in another copy of the course than this package.

    This happens after a folder was copied together with its .venv: its Python imports the package of the old folder,
    and what the student writes would be kept there.
    """
    here = Path.cwd()
    copies = (
        one for one in (here, *here.parents) if (one / "environment.txt").is_file() and (one / "ir50p_lab").is_dir()
    )
    copy = next(copies, PROJECT)
    if not IN_BROWSER and not copy.samefile(PROJECT):
        raise WrongFolderError(
            f"This notebook is in {copy}, but its Python belongs to {PROJECT}: what you write would be kept there. "
            f"Close JupyterLab, open a terminal in {copy} and run 'python3 -m ir50p_lab' (Windows: "
            "'py -m ir50p_lab'): it sets up this copy."
        )


def setting(name):
    """Return the text of an environment variable, "" if it is unset.

    The paths in 'replay:FILE' (IR50P_BENCH) and 'folder:PATH' (IR50P_CAMERA) are those of `path_setting`.
    """
    text = _bare(os.environ.get(name, ""))
    kind, _, path = text.partition(":")
    return f"{kind}:{_in_project(path)}" if path and kind.lower() in ("replay", "folder") else text


def path_setting(name):
    """Return the Path that an environment variable names, None if it is unset."""
    text = setting(name)
    return _in_project(text) if text else None


def read_text(path, error):
    """Return the text of a file in UTF-8. Raises OSError, and `error` with the remedy for another encoding."""
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:  # plain letters in UTF-16 are UTF-8, too
        raise error(f"{path} is not in UTF-8: open it in an editor and save it with the encoding UTF-8")
    return text


def replace_text(path, text):
    """Write a file in one step: a crash leaves either the old one or the new one, whole. Raises OSError."""
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".", ignore_cleanup_errors=True) as folder:
        scratch = Path(folder, path.name)
        scratch.write_text(text, encoding="utf-8")
        os.replace(scratch, path)


def _bare(text):
    return text.strip(" \t\r\n\u00a0\"'")


def _in_project(path):
    return PROJECT / os.path.expanduser(_bare(path))
