"""Answers that are numbers: one, a vector or a matrix."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.course.exercises._answers import NotAnswered, Unreadable, kind_of


@dataclass(frozen=True, eq=False)
class Number:
    """A number or an array of numbers, compared entry by entry.

    right: number or array, computed by the package.
    unit: what the numbers are in, "rad", "m", "N m"; "" for none or several.
    tolerance: largest absolute difference of an entry that still counts as right; because: why that much
        (by default: how many decimals one types).
    angle: the entries are angles in rad, equal modulo 2 pi.
    """

    right: float | np.ndarray
    unit: str = ""
    tolerance: float = 1e-6
    because: str = ""
    angle: bool = False

    def __post_init__(self):
        """Hold the right answer as an array of floats."""
        object.__setattr__(self, "right", np.array(self.right, dtype=float))

    @property
    def wanted(self) -> str:
        """What is asked for, in words, without the answer."""
        return shape_in_words(self.right.shape) + f" in {self.unit}" * bool(self.unit)

    def read(self, answer) -> np.ndarray:
        """Return the student's answer as finite floats, in the shape of the right one if it can have it.

        Raises Unreadable where it holds anything but numbers.
        """
        found = to_floats(answer)
        if not np.all(np.isfinite(found)):
            bad = "nan (not a number)" if np.any(np.isnan(found)) else "an infinite value"
            raise Unreadable(bad if found.ndim == 0 else f"an array that holds {bad}")
        if np.squeeze(found).shape == np.squeeze(self.right).shape:
            found = found.reshape(self.right.shape)  # a (3, 1) column is as good as three numbers
        return found

    def grade(self, answer, exercise) -> tuple[str, str]:
        """Return the state and what to say."""
        found = self.read(answer)
        if self.agrees(found, self.right):
            return "right", f"right. {exercise.why}"
        for message, wrong in (exercise.slips | self.common_slips).items():
            if self.agrees(found, self.read(wrong(self.right) if callable(wrong) else wrong)):
                return "slip", f"not yet, found {show_number(found)}. {message}"
        # only now: the answer of a slip may have another shape, at which `remark` stops
        extra = " ".join(filter(None, (self.remark(found), exercise.hint)))
        return "wrong", f"not yet, found {show_number(found)}; expected {self.wanted}: {exercise.task}. {extra}"

    def agrees(self, found, value) -> bool:
        """Tell whether an answer is the right value or that of a slip, with the tolerance grown to its size."""
        size = np.max(np.abs(value), initial=0) / max(np.max(np.abs(self.right), initial=0), 1e-12)
        return bool(np.all(self._agreement(found, value, self.tolerance * max(1.0, size))))

    def remark(self, found) -> str:
        """Say how far a wrong answer is right, without giving it away. Raises Unreadable for another shape."""
        if found.shape != self.right.shape:
            raise Unreadable(shape_in_words(found.shape))
        near = min(20 * self.tolerance, 0.1 * np.max(np.abs(self.right), initial=0))
        if np.all(self._agreement(found, self.right, near)):
            limit = f"{self.tolerance:.2g}{' ' * bool(self.unit)}{self.unit}"
            return f"It is close, but {limit} is the limit ({self.because or self._decimals()})."
        agrees = self._agreement(found, self.right, self.tolerance)
        if agrees.ndim == 0 or not agrees.any():
            return ""
        off = [str(list(map(int, i))) for i in np.argwhere(~agrees)]
        return f"Not all of it is wrong; look again at {', '.join('answer' + i for i in off[:4])}."

    @property
    def common_slips(self) -> dict:
        """Slips that every exercise of this kind knows: sign, and the unit where it has one."""
        slips = {"The size is right, the sign is not: which direction counts as positive?": np.negative}
        if self.unit == "rad":
            slips["That is in degrees; inside the package every angle is in radians."] = np.rad2deg
        if self.unit == "m":
            slips["That is in millimetres, not in metres."] = lambda right: np.multiply(1000, right)
        return slips

    def _decimals(self) -> str:
        if self.tolerance <= 1e-6:
            return "only rounding may differ"
        decimals = round(-np.log10(self.tolerance))
        typed = f"{decimals} decimal{'s are' if decimals > 1 else ' is'}" if decimals > 0 else "whole numbers are"
        return f"{typed} what you would type"

    def _agreement(self, found, target, tolerance) -> np.ndarray:
        """Return which entries agree with the target."""
        if np.shape(found) != np.shape(target):
            return np.array(False)
        difference = np.subtract(found, target)
        if self.angle:
            difference = (difference + np.pi) % (2 * np.pi) - np.pi
        return np.abs(difference) <= tolerance


def to_floats(answer) -> np.ndarray:
    """Return numbers in any usual form as a float array; Unreadable says what was found instead.

    Lists, tuples, arrays, SymPy numbers and matrices are all read.
    """
    entries = np.array(answer, dtype=object)
    if entries.size == 0:
        raise Unreadable("something empty")
    unfinished = sum(entry is Ellipsis for entry in entries.flat)
    if unfinished == entries.size:
        raise NotAnswered
    if unfinished:
        raise Unreadable(f"an answer in which {unfinished} of {entries.size} entries are still ...")
    return np.array([_to_float(entry) for entry in entries.flat], dtype=float).reshape(entries.shape)


def _to_float(entry) -> float:
    """Return one entry as a float; bool and complex are numbers in Python, but never the answer here."""
    if getattr(entry, "free_symbols", None):
        names = ", ".join(sorted(map(str, entry.free_symbols)))
        raise Unreadable(f"an expression that still holds the symbol {names}")
    if isinstance(entry, bool | np.bool_ | str | list):
        raise Unreadable("rows of different lengths" if isinstance(entry, list) else kind_of(entry))
    try:
        return float(entry)
    except (TypeError, ValueError):
        raise Unreadable(kind_of(entry)) from None


def shape_in_words(shape: tuple[int, ...]) -> str:
    """Return what an array of this shape is called: 'a number', '3 numbers', 'a 4 x 4 matrix'."""
    if shape == ():
        return "a number"
    if len(shape) == 1:
        return f"{shape[0]} number{'s' * (shape[0] != 1)}"
    return f"a {' x '.join(map(str, shape))} {'matrix' if len(shape) == 2 else 'array'}"


def show_number(found) -> str:
    """Return a number or an array as one short line."""
    found = np.asarray(found)
    if found.ndim == 0:
        return f"{found.item():.6g}"
    return f"[{', '.join(map(show_number, found))}]"
