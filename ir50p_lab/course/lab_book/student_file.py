"""Files that belong to the student, as readable JSON: written whole or not at all, with a remedy if one is damaged."""

import json
from contextlib import contextmanager

from ir50p_lab import home
from ir50p_lab.errors import LabError


class LabBookError(LabError):
    """The lab book or the progress cannot be read or written; the message says what to do."""


def read_json(path, empty, is_right):
    """Return the content laid over `empty`, a dict; `empty` alone if there is no file yet.

    is_right: function of the content. Raises LabBookError if it returns False, and for a file that cannot be read.
    """
    why = "it holds something else"
    try:
        content = json.loads(path.read_text(encoding="utf-8-sig"))
        if is_right(content):
            return {**empty, **content}
    except FileNotFoundError:
        return empty
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        why = getattr(error, "strerror", None) or error
    raise LabBookError(f"{path} cannot be read ({why}): mend it, or rename it, and a new one is begun")


@contextmanager
def writing(path, folder):
    """Make the folder; whatever goes wrong while a file is written there becomes a LabBookError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield
    except OSError as error:
        reason = error.strerror or type(error).__name__
        remedy = f"set {home.VARIABLE} to a folder that you may write to"
        raise LabBookError(f"{path} cannot be written ({reason}): {remedy}") from error


def write_json(path, content, folder):
    """Write a file in one step, and make its folder if need be. Raises LabBookError."""
    with writing(path, folder):
        home.replace_text(path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
