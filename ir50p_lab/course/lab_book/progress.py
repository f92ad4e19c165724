"""The progress file: which exercises are done, as readable JSON."""

from datetime import datetime
from pathlib import Path

from ir50p_lab import home
from ir50p_lab.course.lab_book.student_file import read_json, write_json


def progress_path() -> Path:
    """Return where the progress file is: $IR50P_PROGRESS, else progress.json in the student's folder."""
    return home.path_setting("IR50P_PROGRESS") or home.home() / "progress.json"


def read_progress() -> dict[str, str]:
    """Return {exercise: time of the first right answer}, empty if there is no file yet. Raises LabBookError."""
    return read_json(progress_path(), {"done": {}}, _is_progress)["done"]


def _is_progress(content):
    return all(isinstance(item, str) for pair in content["done"].items() for item in pair)


def record(name: str) -> None:
    """Record that an exercise is done. The first time stays; the file is replaced in one step. Raises LabBookError."""
    done = read_progress()
    if name in done:
        return
    done[name] = datetime.now().astimezone().isoformat(timespec="minutes")
    content = {"about": "IR50P lab book: exercises done, and when", "done": dict(sorted(done.items()))}
    write_json(progress_path(), content, home.home())
