"""The progress file: which exercises are done, as readable JSON."""

from __future__ import annotations

import json
import os
from datetime import datetime
from pathlib import Path

from ir50p_lab import home
from ir50p_lab.errors import LabError

_VARIABLE = "IR50P_PROGRESS"


class ProgressError(LabError):
    """The progress file cannot be read or written; the message says what to do."""


def progress_path() -> Path:
    """Return where the progress file lies: $IR50P_PROGRESS, else progress.json in the student's folder."""
    chosen = os.environ.get(_VARIABLE)
    return Path(chosen).expanduser() if chosen else home.home() / "progress.json"


def _to_read() -> Path:
    """The progress file; where there is none yet, that of earlier versions in the project's root."""
    path, old = progress_path(), home.PROJECT / "progress.json"
    moved = os.environ.get(_VARIABLE) or os.environ.get(home.VARIABLE)
    return path if moved or path.exists() or not old.exists() else old


def read_progress() -> dict[str, str]:
    """Return {exercise: time of the first right answer}; empty when there is no file yet."""
    path = _to_read()
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        done = content["done"]
        if not all(isinstance(item, str) for pair in done.items() for item in pair):
            raise TypeError("not a table of names and times")
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise ProgressError(f"The progress file {path} cannot be read ({error.strerror}).") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ProgressError(
            f"The progress file {path} is damaged: rename or delete it, and a new one is begun."
        ) from error
    return done


def record(name: str) -> None:
    """Note that an exercise is done. The first time stays; the file is replaced in one step."""
    done = read_progress()
    if name in done:
        return
    done[name] = datetime.now().astimezone().isoformat(timespec="minutes")
    _write(progress_path(), {"about": "IR50P lab book: exercises done, and when", "done": dict(sorted(done.items()))})


def _write(path: Path, content: dict) -> None:
    try:
        home.home().mkdir(parents=True, exist_ok=True)
        home.replace_text(path, json.dumps(content, indent=2) + "\n")
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise ProgressError(
            f"The progress file {path} cannot be written ({reason}): "
            f"set {home.VARIABLE} to a folder that you may write to."
        ) from error
