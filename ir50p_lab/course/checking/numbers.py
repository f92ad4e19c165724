"""Number exercises: found by their names; an answer is compared with the right one, and a sentence tells."""

import difflib
import importlib
from dataclasses import replace
from pathlib import Path

import numpy as np

from ir50p_lab.course.checking.note import Note, show
from ir50p_lab.course.checking.number import shape_in_words
from ir50p_lab.course.checking.tasks import of_notebook, task
from ir50p_lab.course.lab_book.progress import record
from ir50p_lab.course.lab_book.student_file import LabBookError
from ir50p_lab.course.robot.catalogue import ORDER, is_function, stays
from ir50p_lab.errors import InputError

_KINDS = {  # what stands where a number should, in words a student knows
    "NoneType": "None (is there a `return` missing?)",
    "str": "text in quotes",
    "ellipsis": "dots (...) that are still to be replaced",
    "list": "rows of different lengths",
    "function": "a function, not what it returns",
}


class _Unreadable(Exception):  # noqa: N818  (turned into a sentence, never shown as an error)
    """The answer has the wrong form; the message names what was found."""


def check_number(name, answer=...):
    """Show what was found in an answer; a right one is recorded in the progress file. Raises nothing."""
    try:
        note = grade_number(find(name), answer)
        if note.state == "right":
            record(note.name)
    except InputError as error:
        note = Note("unknown", "check", str(error))
    except LabBookError as error:
        note = replace(note, text=f"{note.text} (Not noted: {error})")
    show(note)


def solution(name):
    """Return the right answer, for instructors.

    name: of a number exercise ("pose-3"): its number, or an array (a copy) is returned. Of a function of `my_robot`
    ("rot_z"), or of a stage of one ("PID.p"): the text of a right one, without checks of its arguments (`my_robot`
    itself has it as a function). Of a function that stays in its notebook: its lines, in the names of that notebook.
    Raises InputError for an unknown name, and for a function that is still to come.
    """
    if stays(str(name)):
        return of_notebook(name).solution_text
    return task(name).solution_text if is_function(str(name)) else find(name).right.copy()[()]


def everything(holding=""):
    """Return the Numbers of all rooms in the order of the notebooks.

    holding: only rooms whose file holds this text are imported.
    """
    found = []
    for path in sorted(Path(__file__).parents[1].glob("*/numbers.py")):
        if path != Path(__file__) and holding in path.read_text(encoding="utf-8"):
            found += importlib.import_module(f"ir50p_lab.course.{path.parent.name}.numbers").NUMBERS
    return sorted(found, key=lambda one: one.notebook)


def find(name):
    """Return the Number of this name. Raises InputError, which names the nearest ones."""
    if not isinstance(name, str):
        raise InputError('The name of the exercise comes first, as text: check("start-1", answer).')
    wanted = name.strip().lower()
    for one in everything(holding=f'"{wanted}"'):
        if one.name == wanted:
            return one
    known = [one.name for one in everything()]
    nearest = difflib.get_close_matches(wanted, [*known, *ORDER], 3, 0.4) or known[:3]
    raise InputError(f"There is no exercise {name!r}. Nearest names: {', '.join(nearest)}.")


def grade_number(number, answer):
    """Compare an answer with the right one; return a Note. Raises nothing, whatever the answer does.

    The state of the Note is "open" (still the stub), "right", "mistake" (a known one), "wrong", or "unreadable".
    """
    try:
        state, text = _compared(number, answer)
    except _Unreadable as problem:
        state, text = "unreadable", f"found {problem}; expected {number.wanted}."
    except Exception:  # of an object that raises when it is looked at
        state, text = "unreadable", f"found an object of type {type(answer).__name__}; expected {number.wanted}."
    return Note(state, number.name, text.strip())


def _compared(number, answer):
    """The state, and what to say."""
    entries = np.array(answer, dtype=object)
    if entries.size and all(entry is ... for entry in entries.flat):
        return "open", f"not answered yet. To find: {number.task}. Expected: {number.wanted}."
    found = _floats(entries)
    if np.squeeze(found).shape == np.squeeze(number.right).shape:
        found = found.reshape(number.right.shape)  # a (3, 1) column is as good as three numbers
    if found.shape != number.right.shape:
        raise _Unreadable(shape_in_words(found.shape))
    if np.all(number.near(found, number.right, number.tolerance)):
        return "right", f"right. {number.why}"
    for message, wrong in number.every_mistake.items():
        growth = max(1.0, np.max(np.abs(wrong)) / np.max(np.abs(number.right)))  # in mm: 1000 times less exact
        if np.all(number.near(found, wrong, growth * number.tolerance)):
            return "mistake", f"not yet, found {_shown(found)}. {message}"
    extra = " ".join(filter(None, (_remark(number, found), number.hint)))
    return "wrong", f"not yet, found {_shown(found)}; expected {number.wanted}: {number.task}. {extra}"


def _remark(number, found):
    """How far a wrong answer is right, without giving it away; or ""."""
    close = min(20 * number.tolerance, 0.1 * np.max(np.abs(number.right)))
    if np.all(number.near(found, number.right, close)):
        return f"It is close, but {f'{number.tolerance:.2g} {number.unit}'.strip()} is the limit ({number.because})."
    right = number.near(found, number.right, number.tolerance)
    off = [f"answer{list(map(int, place))}" for place in np.argwhere(~right)]
    return f"Not all of it is wrong; look again at {', '.join(off[:4])}." if right.any() else ""


def _floats(entries):
    """Numbers in any usual form, those of SymPy among them, as finite floats; _Unreadable says what else was found."""
    found = np.array([_to_float(entry) for entry in entries.flat]).reshape(entries.shape)
    if not np.all(np.isfinite(found)):
        raise _Unreadable("a value that is not finite: nan (not a number) or inf")
    return found


def _to_float(entry):
    try:
        if not isinstance(
            entry, bool | np.bool_ | str | complex
        ):  # which Python reads as numbers: never the answer here
            return float(entry)
    except (TypeError, ValueError):
        pass
    kind = type(entry).__name__
    raise _Unreadable(_KINDS.get(kind, f"an object of type {kind}"))


def _shown(found):
    """A number or an array as one short line."""
    return f"{found.item():.6g}" if found.ndim == 0 else f"[{', '.join(map(_shown, map(np.array, found)))}]"
