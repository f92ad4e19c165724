"""Answers that are functions: tried out on the inputs of the exercise, as the functions of `my_robot` are."""

import dis
import functools
import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.stops import ended
from ir50p_lab.course.checking.task import Mistake, Task
from ir50p_lab.course.exercises._answers import NotAnswered, Unreadable, kind_of
from ir50p_lab.course.exercises._numbers import shape_in_words


@dataclass(frozen=True, eq=False)
class Function:
    """A function of numbers or arrays; compared by its values on the cases.

    right: the right function; its argument names are the ones the question uses. It returns a number or an array, of
    the same shape for every case. cases: inputs, each a tuple of arguments (or the one argument itself).
    unit, tolerance: of the value, as in Number.
    """

    right: Callable
    cases: Sequence
    unit: str = ""
    tolerance: float = 1e-6

    @property
    def wanted(self) -> str:
        """What is asked for, in words, without the answer."""
        value = shape_in_words(np.shape(self.right(*self._inputs[0])))
        names = ", ".join(inspect.signature(self.right).parameters)
        return f"a function of ({names}) that returns {value}{f' in {self.unit}' * bool(self.unit)}"

    @property
    def _inputs(self):
        return [case if isinstance(case, tuple) else (np.array(case),) for case in self.cases]

    def read(self, answer) -> Callable:
        """Return the student's function, made to return an array where it returns numbers in another form."""
        if not callable(answer) or inspect.isclass(answer):
            raise Unreadable("a class" if inspect.isclass(answer) else _kind_of_value(answer))
        if _is_stub(answer):
            raise NotAnswered
        shape = np.shape(self.right(*self._inputs[0]))

        @functools.wraps(answer)
        def as_array(*args):
            result = answer(*args)
            try:
                array = np.asarray(result, dtype=float)
            except (TypeError, ValueError):
                return result
            if result is None:  # which NumPy reads as nan
                return None
            return array.reshape(shape) if np.squeeze(array).shape == shape else array

        return as_array

    def grade(self, answer, exercise):
        """Return the state, what to say and an input that fails, by the rules for functions of `my_robot`."""
        task = Task(
            name=exercise.name,
            asks=exercise.task,
            right=self.right,
            loan="",
            cases=lambda: self._inputs,
            slips=tuple(Mistake(wrong, message) for message, wrong in exercise.slips.items()),
            tolerance=self.tolerance,
            unit=self.unit,
        )
        found = grade(task, self.read(answer))
        if found.state == "right":
            return "right", f"right. {exercise.why}"
        if found.says in exercise.slips:
            return "slip", f"not yet: {found.says}", found.example
        return "wrong", f"not yet: {ended(found.says)} Expected: {self.wanted}. {exercise.hint}", found.example


def _is_stub(function) -> bool:
    """Tell whether a function's body is nothing but `...`, `pass` or a docstring."""
    code = getattr(function, "__code__", None)
    if code is None:
        return False
    steps = [step for step in dis.get_instructions(code) if step.opname not in ("RESUME", "NOP", "CACHE")]
    plain = all(step.opname in ("LOAD_CONST", "RETURN_CONST", "RETURN_VALUE") for step in steps)
    return plain and all(step.argval in (None, Ellipsis) for step in steps if "CONST" in step.opname)


def _kind_of_value(answer) -> str:
    """Return what stands where a function should be."""
    numbers = isinstance(answer, int | float | list | tuple | np.ndarray) and not isinstance(answer, bool)
    return "a value, not a function" if numbers else kind_of(answer)
