"""Answers that are functions, tried out on the inputs of the exercise."""

from __future__ import annotations

import dis
import inspect
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ir50p_lab.course.exercises._answers import NotAnswered, Slip, Unreadable, kind_of, shorten, worth_having
from ir50p_lab.course.exercises._numbers import Number, show_number


@dataclass(frozen=True, eq=False)
class Function:
    """A function of numbers or arrays; compared by its values on the cases.

    right: the right function; its argument names are the ones the question uses.
    cases: inputs, each a tuple of arguments (or a single number or array, for one argument). A function that
        takes scalars only is as good as one that takes arrays, f(q1, q2, q3) as good as f(q).
    angles_in: the arguments are angles in rad (then degrees are a slip with a message of its own).
    unit, tolerance, because, angle, any_order: of the value, as in Number.
    """

    right: Callable
    cases: Sequence
    unit: str = ""
    tolerance: float = 1e-6
    because: str = "only rounding may differ"
    angles_in: bool = False
    angle: bool = False
    any_order: bool = False

    @property
    def solution(self) -> Callable:
        """The right function."""
        return self.right

    @property
    def wanted(self) -> str:
        """What is asked for, in words, without the answer."""
        return f"a function of ({', '.join(self._names)}) that returns {self._values[0].wanted}"

    @property
    def _names(self) -> tuple[str, ...]:
        return tuple(inspect.signature(self.right).parameters)

    @cached_property
    def _inputs(self) -> tuple[tuple, ...]:
        return tuple(case if isinstance(case, tuple) else (case,) for case in self.cases)

    @cached_property
    def _values(self) -> tuple[Number, ...]:
        """The right value of each case, with what counts as equal."""
        return tuple(
            Number(self.right(*args), self.unit, self.tolerance, self.because, self.angle, self.any_order)
            for args in self._inputs
        )

    def read(self, answer) -> list[np.ndarray]:
        """Return the values of the student's function on the cases; Unreadable where there are none."""
        if not callable(answer) or inspect.isclass(answer):
            raise Unreadable("a class" if inspect.isclass(answer) else kind_of_value(answer))
        if _is_stub(answer):
            raise NotAnswered
        spread = self._takes_entries(answer)
        return [
            self._read_case(answer, args, value, spread) for args, value in zip(self._inputs, self._values, strict=True)
        ]

    def _read_case(self, answer, args, value, spread) -> np.ndarray:
        where = ", ".join(f"{name} = {show_number(arg)}" for name, arg in zip(self._names, args, strict=False))
        try:
            result = _call(answer, args, spread)
        except Exception as error:
            raise Unreadable(
                f"a function that stops with {type(error).__name__}: {shorten(error)} (called with {where})"
            ) from None
        try:
            return value.read(result)
        except Unreadable as problem:
            raise Unreadable(f"a function that returns {problem} (called with {where})") from None

    def check_form(self, found) -> None:
        """Raise Unreadable if the values have another shape than the right ones."""
        for value, one in zip(self._values, found, strict=True):
            try:
                value.check_form(one)
            except Unreadable as problem:
                raise Unreadable(f"a function that returns {problem}") from None

    def read_wrong(self, wrong) -> list[np.ndarray]:
        """Return the values of a slip's function."""
        return [value.read(_call(wrong, args, False)) for args, value in zip(self._inputs, self._values, strict=True)]

    def is_right(self, found) -> bool:
        """Tell whether the values agree in every case."""
        return all(value.is_right(one) for value, one in zip(self._values, found, strict=True))

    def is_slip(self, found, wrong) -> bool:
        """Tell whether the values are those of a slip's function in every case."""
        return all(value.is_slip(*pair) for value, *pair in zip(self._values, found, wrong, strict=True))

    def show(self, found) -> str:
        """Show the first case that is wrong: its input, and what the student's function made of it."""
        i = self._first_wrong(found)
        args = ", ".join(
            f"{name} = {show_number(arg)}" for name, arg in zip(self._names, self._inputs[i], strict=False)
        )
        return f"a function that returns {show_number(found[i])} for {args}"

    def remark(self, found) -> str:
        """Say in how many cases the function is right."""
        right = sum(value.is_right(one) for value, one in zip(self._values, found, strict=True))
        cases = f"It is right in {right} of {len(self._inputs)} cases. " if right else ""
        return cases + self._values[self._first_wrong(found)].remark(found[self._first_wrong(found)])

    def _first_wrong(self, found) -> int:
        wrong = [i for i, value in enumerate(self._values) if not value.is_right(found[i])]
        return wrong[0] if wrong else 0

    def common_slips(self) -> tuple[Slip, ...]:
        """Slips that every function knows: sign, degrees out, degrees in."""
        right = self.right
        slips = [
            Slip(
                lambda *args: np.negative(right(*args)),
                "The size is right, the sign is not: which direction counts as positive?",
            )
        ]
        if self.unit == "rad":
            slips.append(
                Slip(
                    lambda *args: np.rad2deg(right(*args)),
                    "It returns degrees; inside the package every angle is in radians.",
                )
            )
        if self.angles_in:
            slips.append(
                Slip(
                    lambda *args: right(*map(np.deg2rad, args)),
                    "It treats its input as degrees; the angles it gets are in radians.",
                )
            )
        return worth_having(slips, self)

    def _takes_entries(self, answer) -> bool:
        """Tell whether the function wants the entries of the one vector argument one by one."""
        try:
            signature = inspect.signature(answer)
        except (TypeError, ValueError):
            return False  # a built-in: it will say itself what it misses
        args = self._inputs[0]
        try:
            signature.bind(*args)
        except TypeError:
            if len(args) == 1 and np.ndim(args[0]) == 1:
                try:
                    signature.bind(*args[0])
                except TypeError:
                    pass
                else:
                    return True
            raise Unreadable(f"a function of ({', '.join(signature.parameters)})") from None
        return False


def _call(function, args, spread):
    """Call a function with copies of the inputs; where scalars do not work, try arrays of one entry."""
    fresh = [np.array(arg) if np.ndim(arg) else arg for arg in args]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if spread:
            return function(*fresh[0])
        try:
            return function(*fresh)
        except Exception:
            if any(np.ndim(arg) for arg in args):
                raise
            try:
                return function(*(np.array([float(arg)]) for arg in args))
            except Exception:
                return function(*args)  # raises the first error again


def _is_stub(function) -> bool:
    """Tell whether a function's body is nothing but `...`, `pass` or a docstring."""
    code = getattr(function, "__code__", None)
    if code is None:
        return False
    steps = [step for step in dis.get_instructions(code) if step.opname not in ("RESUME", "NOP", "CACHE")]
    plain = all(step.opname in ("LOAD_CONST", "RETURN_CONST", "RETURN_VALUE") for step in steps)
    return plain and all(step.argval in (None, Ellipsis) for step in steps if "CONST" in step.opname)


def kind_of_value(answer) -> str:
    """Return what stands where a function should be."""
    numbers = isinstance(answer, int | float | list | tuple | np.ndarray) and not isinstance(answer, bool)
    return "a value, not a function" if numbers else kind_of(answer)
