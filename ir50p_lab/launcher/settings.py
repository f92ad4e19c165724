"""The environment variables IR50P_*, read in one way by everything. Standard library only.

Blanks and quotes around a value do not count (`set X="..."` of the Windows prompt keeps them); an empty one is unset.
In a path, '~' is the home folder, and a relative one counts from the project's folder, wherever a notebook runs.
"""

import os
from pathlib import Path

PROJECT = Path(__file__).parents[2]


def setting(name):
    """Text of an environment variable, "" where it is unset.

    The paths in 'replay:FILE' (IR50P_BENCH) and 'folder:PATH' (IR50P_CAMERA) are those of `path_setting`.
    """
    text = _bare(os.environ.get(name, ""))
    kind, _, path = text.partition(":")
    return f"{kind}:{_in_project(path)}" if path and kind.lower() in ("replay", "folder") else text


def path_setting(name):
    """Path that an environment variable names, None where it is unset."""
    text = setting(name)
    return _in_project(text) if text else None


def _bare(text):
    return text.strip(" \t\r\n\u00a0\"'")


def _in_project(path):
    return PROJECT / os.path.expanduser(_bare(path))
