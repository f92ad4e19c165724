"""The progress file: which exercises are done, as readable JSON."""

from __future__ import annotations

import json
import os
import tempfile
from datetime import datetime
from pathlib import Path

from ir50p_lab.errors import LabError

_VARIABLE = "IR50P_PROGRESS"


class ProgressError(LabError):
    """The progress file cannot be read or written; the message says what to do."""


def progress_path() -> Path:
    """Return where the progress file lies: $IR50P_PROGRESS, else progress.json in the project root."""
    chosen = os.environ.get(_VARIABLE)
    if chosen:
        return Path(chosen).expanduser()
    root = Path(__file__).resolve().parents[3]
    return (root if (root / "pyproject.toml").is_file() else Path.cwd()) / "progress.json"


def read_progress() -> dict[str, str]:
    """Return {exercise: time of the first right answer}; empty when there is no file yet."""
    path = progress_path()
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        done = content["done"]
        if not all(isinstance(item, str) for pair in done.items() for item in pair):
            raise TypeError("not a table of names and times")
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise ProgressError(f"The progress file {path} cannot be read ({error.strerror}).") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
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
    """Write a file beside the old one, then swap: a crash leaves the old or the new one, whole."""
    scratch = None
    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=path.parent, prefix=".progress-", suffix=".tmp", delete=False
        ) as file:
            scratch = file.name
            file.write(json.dumps(content, indent=2) + "\n")
        os.replace(scratch, path)
    except OSError as error:
        if scratch is not None:
            Path(scratch).unlink(missing_ok=True)
        reason = error.strerror or type(error).__name__
        raise ProgressError(
            f"The progress file {path} cannot be written ({reason}): "
            f"set {_VARIABLE} to a file in a folder that you may write to."
        ) from error
