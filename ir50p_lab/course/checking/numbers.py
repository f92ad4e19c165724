"""Number exercises: a number, a vector or a matrix beside the right one, and a sentence on what was found.

A subject's own are data in its `numbers.py`, found there by their names:

    NUMBERS = (
        Number("dyn-6", "04_inertia", "the gear ratio N with which ...", N, tolerance=0.5, why=..., slips=...),
    )

Rules for authors (`tests/course/test_numbers_of_rooms.py` tries every one, and asks for another route to it):
- `right` comes from the package and from constants of the file (IR50P, not load_arm()): no variable of the student's,
  no other arm, may move it. The notebook states the same constants.
- At least three slips, sign and unit included (those are known: `_COMMON`), none equal to another or to the right
  answer. Their sentences say what is wrong and where to look, never the answer.
- At most two a notebook, in its order.
"""

import difflib
import importlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ir50p_lab.course.checking.note import Note, show
from ir50p_lab.course.lab_book.progress import record
from ir50p_lab.course.lab_book.student_file import LabBookError
from ir50p_lab.course.robot.catalogue import ORDER, is_function, of_notebook, stays, task
from ir50p_lab.errors import InputError

_COMMON = {  # slips that are known without being told, of any unit ("") and of one
    "": {"The size is right, the sign is not: which direction counts as positive?": np.negative},
    "rad": {"That is in degrees; inside the package every angle is in radians.": np.rad2deg},
    "m": {"That is in millimetres, not in metres.": lambda right: 1000 * right},
}
_KINDS = {  # what stands where a number should, in words a student knows
    "NoneType": "None (is there a `return` missing?)",
    "str": "text in quotes",
    "ellipsis": "dots (...) that are still to be replaced",
    "list": "rows of different lengths",
    "function": "a function, not what it returns",
}


@dataclass(frozen=True, eq=False)
class Number:
    """A question whose answer is a number or an array of numbers, compared entry by entry.

    name: "pose-3". notebook: the name of its file, without the end.
    task: the question in one line, without a full stop. right: number or array.
    tolerance: largest absolute difference of an entry that still counts as right; because: why that much.
    why: one line that a right answer earns.
    slips: {what to say: a typical wrong answer, or a function of the right one (np.negative)}.
    unit: what the numbers are in, "rad", "m", "N m"; "" for none or several.
    angle: the entries are angles in rad, equal modulo 2 pi.
    hint: said to a wrong answer that is no known slip.
    """

    name: str
    notebook: str
    task: str
    right: float | np.ndarray
    tolerance: float
    why: str
    slips: dict
    unit: str = ""
    because: str = "it allows for rounding"
    angle: bool = False
    hint: str = ""

    def __post_init__(self):
        """Hold the right answer as an array of floats."""
        object.__setattr__(self, "right", np.array(self.right, dtype=float))

    @property
    def wanted(self):
        """What is asked for, in words, without the answer."""
        return _shape_in_words(self.right.shape) + f" in {self.unit}" * bool(self.unit)

    @property
    def every_slip(self):
        """{what to say: wrong answer}: its own, then the common ones."""
        slips = self.slips | _COMMON[""] | _COMMON.get(self.unit, {})
        return {message: wrong(self.right) if callable(wrong) else wrong for message, wrong in slips.items()}

    def near(self, found, target, tolerance):
        """Tell for each entry whether it is as near to that of the target as the tolerance."""
        off = np.subtract(found, target)
        if self.angle:
            off = (off + np.pi) % (2 * np.pi) - np.pi
        return np.abs(off) <= tolerance


class _Unreadable(Exception):  # noqa: N818  (turned into a sentence, never shown as an error)
    """The answer has the wrong form; the message names what was found."""


def check_number(name, answer=...):
    """Show what was found in an answer; a right one is noted in the progress file. Raises nothing."""
    try:
        note = grade(find(name), answer)
        if note.state == "right":
            record(note.name)
    except InputError as error:
        note = Note("unknown", "check", str(error))
    except LabBookError as error:
        note = replace(note, text=f"{note.text} (Not noted: {error})")
    show(note)


def solution(name):
    """Return the right answer, for instructors.

    name: of a number exercise ("pose-3"): its number, or an array (a copy). Of a function of `my_robot` ("rot_z"), or
    of a stage of one ("PID.p"): the text of a right one, without checks of its arguments; `my_robot` itself has it as
    a function. Of a function that stays in its notebook: its lines, in the names of that notebook. Raises InputError
    for an unknown name, and for a function that is still to come.
    """
    if stays(str(name)):
        return of_notebook(name).loan
    return task(name).loan if is_function(str(name)) else find(name).right.copy()[()]


def everything(holding=""):
    """Return the Numbers of all rooms in the order of the notebooks; only rooms that hold this text are imported."""
    found = []
    for path in sorted(Path(__file__).parents[1].glob("*/numbers.py")):
        if path != Path(__file__) and holding in path.read_text(encoding="utf-8"):
            found += importlib.import_module(f"ir50p_lab.course.{path.parent.name}.numbers").NUMBERS
    return sorted(found, key=lambda one: one.notebook)


def find(name):
    """Return the Number of this name; InputError names the nearest ones."""
    if not isinstance(name, str):
        raise InputError('The name of the exercise comes first, as text: check("start-1", answer).')
    wanted = name.strip().lower()
    for one in everything(holding=f'"{wanted}"'):
        if one.name == wanted:
            return one
    known = [one.name for one in everything()]
    nearest = difflib.get_close_matches(wanted, [*known, *ORDER], 3, 0.4) or known[:3]
    raise InputError(f"There is no exercise {name!r}. Nearest names: {', '.join(nearest)}.")


def grade(number, answer):
    """Compare an answer with the right one: a Note. Never raises, whatever the answer does.

    Its state is "open" (still the stub), "right", "slip" (a known one), "wrong", or "unreadable".
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
        raise _Unreadable(_shape_in_words(found.shape))
    if np.all(number.near(found, number.right, number.tolerance)):
        return "right", f"right. {number.why}"
    for message, wrong in number.every_slip.items():
        growth = max(1.0, np.max(np.abs(wrong)) / np.max(np.abs(number.right)))  # in mm: 1000 times less exact
        if np.all(number.near(found, wrong, growth * number.tolerance)):
            return "slip", f"not yet, found {_shown(found)}. {message}"
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


def _shape_in_words(shape):
    """What an array of this shape is called: 'a number', '3 numbers', 'a 4 x 4 matrix'."""
    if len(shape) < 2:
        return f"{shape[0]} number{'s' * (shape[0] != 1)}" if shape else "a number"
    return f"a {' x '.join(map(str, shape))} {'matrix' if len(shape) == 2 else 'array'}"


def _shown(found):
    """A number or an array as one short line."""
    return f"{found.item():.6g}" if found.ndim == 0 else f"[{', '.join(map(_shown, map(np.array, found)))}]"
