"""What a student hands in, a ZIP or a folder: the functions and the lab book as text, read and never unpacked."""

import json
import re
import zipfile
import zlib
from dataclasses import dataclass, field
from pathlib import Path

from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.errors import InputError

_MOST = {"function": 100_000, "lab book": 5_000_000}  # bytes of one file


class _Refused(Exception):  # noqa: N818  (becomes the verdict)
    """What was handed in is not read; the message says why."""


@dataclass
class Submission:
    """What one student handed in.

    name: of the ZIP or folder; functions: {name: text of its file}; trouble: why something was not read, or "".

    What the lab book says, which a text editor can change: predictions that were both guessed and measured, {name:
    entry}; attempts, {function: [what was said of each wrong answer]}; helped and partners, texts.
    """

    name: str
    functions: dict = field(default_factory=dict)
    trouble: str = ""
    predictions: dict = field(default_factory=dict)
    attempts: dict = field(default_factory=dict)
    helped: list = field(default_factory=list)
    partners: list = field(default_factory=list)


def submissions(folder):
    """Return all Submissions in a folder, sorted by name: ZIPs, and folders that contain my_robot or notebooks."""
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(f"'{folder}' is not a folder: give the one that holds the hand-ins of the class")
    found = [path for path in sorted(folder.iterdir()) if path.suffix.lower() == ".zip" or _home(path)]
    if not found:
        raise InputError(f"'{folder}' holds no hand-ins: neither ZIPs nor folders with my_robot in them")
    return [_submission(path) for path in found]


def _submission(path):
    made = Submission(path.stem if path.suffix.lower() == ".zip" else path.name)
    try:
        reader = _of_folder(path) if path.is_dir() else _of_zip(path)
        made.functions = {name: reader(f"my_robot/_{name}.py", _MOST["function"]) for name in ORDER}
        made.functions = {name: text for name, text in made.functions.items() if text is not None}
        _read_book(made, reader("results/lab_book.json", _MOST["lab book"]) or "{}")
    except (_Refused, OSError, ValueError, RuntimeError, zipfile.BadZipFile, zlib.error) as error:
        made.trouble = str(error)
    return made


def _home(path):
    """The folder that holds my_robot and results, or None."""
    return next((one for one in (path, path / "notebooks") if (one / "my_robot").is_dir()), None)


def _of_folder(folder):
    home = _home(folder).resolve()

    def read(name, most):
        path = home / name
        if not path.exists():
            return None
        if not path.resolve().is_relative_to(home) or not path.is_file():
            raise _Refused(f"{name} is not a plain file of the hand-in's own")
        with path.open("rb") as file:
            return _text(file, name, most)

    return read


def _of_zip(path):
    archive = zipfile.ZipFile(path)
    names = archive.namelist()
    for name in names:
        if name.startswith(("/", "\\")) or ".." in re.split(r"[/\\]", name) or ":" in name[:2]:
            raise _Refused(f"the ZIP holds a path that leads out of it: {name[:80]}")

    def read(name, most):
        inside = next((one for one in names if f"/{one}".endswith(f"/{name}")), None)
        if inside is None:
            return None
        with archive.open(inside) as file:
            return _text(file, name, most)

    return read


def _text(file, name, most):
    """The text of a file that is not too long: no more is unpacked than it may have."""
    content = file.read(most + 1)
    if len(content) > most:
        raise _Refused(f"{name} has more than {most:,} bytes")
    return content.decode("utf-8-sig", "replace")  # a comment in another encoding does no harm


def _read_book(made, text):
    """Take from a lab book what has the form of one; the rest stays out."""
    book = json.loads(text)
    book = book if isinstance(book, dict) else {}
    for name, entry in _pairs(book.get("predictions")):
        if not isinstance(entry, dict) or entry.get("late"):  # a guess after the answer does not count
            continue
        if _number(entry.get("guess")) and _number(entry.get("truth")):
            within = entry.get("within", 0.1)
            made.predictions[name] = {
                "guess": float(_first_guess(entry)),
                "truth": float(entry["truth"]),
                "within": within if _number(within) else 0.1,
                "unit": str(entry.get("unit", "")),
                "why": str(entry.get("why", "")),
            }
    for name, tries in _pairs(book.get("attempts")):
        if name.partition(".")[0] in ORDER:
            said = tries.values() if isinstance(tries, dict) else [""] * len(tries) if isinstance(tries, list) else ()
            made.attempts[name] = [str(one) for one in said]
    helped, partners = (book.get(key) if isinstance(book.get(key), list) else [] for key in ("helped", "partners"))
    made.helped = [str(one.get("text", "")) for one in helped if isinstance(one, dict)]
    made.partners = [str(one) for one in partners]


def _first_guess(entry):
    earlier = entry["earlier"] if isinstance(entry.get("earlier"), list) else []
    guesses = (one.get("guess") for one in earlier if isinstance(one, dict))
    return next(filter(_number, guesses), entry["guess"])


def _pairs(found):
    return found.items() if isinstance(found, dict) else ()


def _number(value):
    """Tell whether a value is a number of a sensible size; nan is none."""
    return isinstance(value, int | float) and abs(value) < 1e100
