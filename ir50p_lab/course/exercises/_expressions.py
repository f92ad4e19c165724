"""Answers that are symbolic expressions, compared by their values at points of the exercise's choosing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ir50p_lab.course.exercises._answers import NotAnswered, Slip, Unreadable, kind_of, shorten, worth_having

_POINTS = 12
_SEED = 1905


@dataclass(frozen=True, eq=False)
class Expression:
    """A SymPy expression (or a matrix of them), in any equivalent form.

    right: the right expression. Symbols are told apart by name alone, so that the student's own symbols, with
        whatever assumptions, or q1(t), are as good as the package's.
    also: names that may appear although the right answer does not use them.
    tolerance: largest relative difference of the values at random points, where all symbols lie in 0.2 to 1.4.
    """

    right: Any
    also: tuple[str, ...] = ()
    tolerance: float = 1e-9
    because: str = "equivalent forms differ by rounding only"

    @property
    def solution(self):
        """The right expression."""
        return self.right

    @property
    def wanted(self) -> str:
        """What is asked for, in words, without the answer."""
        shape = getattr(self.right, "shape", ())
        what = f"a {' x '.join(map(str, shape))} matrix of expressions" if shape else "an expression"
        return f"{what} in {', '.join(self._names)}"

    @cached_property
    def _names(self) -> tuple[str, ...]:
        return tuple(sorted({str(s) for s in _renamed(self.right).free_symbols} | set(self.also)))

    @cached_property
    def _points(self) -> np.ndarray:
        return np.random.default_rng(_SEED).uniform(0.2, 1.4, (_POINTS, len(self._names)))

    def read(self, answer) -> np.ndarray:
        """Return the values of the student's expression at the points; Unreadable where there are none."""
        expression = _to_sympy(answer, self._names)
        shape = getattr(expression, "shape", ())
        wanted = getattr(self.right, "shape", ())
        if shape != wanted:
            if tuple(sorted(shape)) != tuple(sorted(wanted)) or 1 not in shape:
                form = f"a {' x '.join(map(str, shape))} matrix" if shape else "a single expression"
                raise Unreadable(form)
            expression = expression.reshape(*wanted)  # a row is as good as a column
        strangers = sorted({str(s) for s in expression.free_symbols} - set(self._names))
        if strangers:
            raise Unreadable(f"an expression with {', '.join(strangers)} in it, which the question does not use")
        return self._values(expression)

    def _values(self, expression) -> np.ndarray:
        import sympy

        if expression.has(sympy.zoo, sympy.nan, sympy.oo):
            raise Unreadable("an expression that has no finite value (a division by zero?)")
        evaluate = sympy.lambdify([sympy.Symbol(name) for name in self._names], expression, "numpy")
        with np.errstate(all="ignore"):
            values = np.array([np.asarray(evaluate(*point), dtype=complex) for point in self._points])
        if not np.all(np.isfinite(values)):
            raise Unreadable("an expression that has no finite value (a division by zero?)")
        return values

    def check_form(self, found) -> None:
        """Nothing to refuse: what could be read has the right form."""

    def read_wrong(self, wrong) -> np.ndarray:
        """Return the values of a slip: an expression, or a function of the right one."""
        return self.read(wrong(self.right) if _is_plain_function(wrong) else wrong)

    def is_right(self, found) -> bool:
        """Tell whether the values agree at every point."""
        return self.is_slip(found, self._values(_renamed(self.right)))

    def is_slip(self, found, wrong) -> bool:
        """Tell whether the values are those of the wrong expression at every point."""
        scale = max(1.0, float(np.max(np.abs(wrong))))
        return bool(np.max(np.abs(found - wrong)) <= self.tolerance * scale)

    def show(self, found) -> str:
        """Say what was found; the student's own expression stands in the cell above."""
        return "an expression"

    def remark(self, found) -> str:
        """Say how often the expression has the right value."""
        right = self._values(_renamed(self.right))
        if found.ndim == 1:
            return ""
        agrees = np.all(np.abs(found - right) <= 1e-9 * max(1.0, float(np.max(np.abs(right)))), axis=0)
        off = [str(list(map(int, i))) for i in np.argwhere(~np.atleast_1d(np.squeeze(agrees)))]
        return f"Not all of it is wrong; look again at {', '.join('answer' + i for i in off[:4])}." * bool(agrees.any())

    def common_slips(self) -> tuple[Slip, ...]:
        """Slips that every expression knows: the sign."""
        message = "Everything is right but the sign: which direction counts as positive?"
        return worth_having([Slip(lambda right: -right, message)], self)


def _is_plain_function(value) -> bool:
    return callable(value) and not hasattr(value, "free_symbols")


def _to_sympy(answer, names):
    """Return an answer as a SymPy expression or matrix whose symbols carry no assumptions."""
    import sympy

    if answer is Ellipsis:
        raise NotAnswered
    if isinstance(answer, list | tuple | np.ndarray):
        entries = np.array(answer, dtype=object)
        if entries.size and all(entry is Ellipsis for entry in entries.flat):
            raise NotAnswered
        answer = sympy.Matrix(answer)
    if isinstance(answer, str):
        try:
            answer = sympy.sympify(answer, locals={name: sympy.Symbol(name) for name in names})
        except Exception as error:
            raise Unreadable(f"the text {shorten(answer, 40)!r}, which is no expression") from error
    if answer is None or isinstance(answer, bool) or _is_plain_function(answer):
        raise Unreadable(kind_of(answer))
    if isinstance(answer, sympy.Equality):
        raise Unreadable("an equation; give its right-hand side alone")
    try:
        return _renamed(sympy.sympify(answer))
    except (sympy.SympifyError, TypeError, AttributeError):
        raise Unreadable(kind_of(answer)) from None


def _renamed(expression):
    """Return the expression with plain symbols, by name: assumptions are forgotten, q1(t) is q1, its rate qdot1."""
    import sympy
    from sympy.core.function import AppliedUndef

    expression = expression.doit()
    functions = {}
    for rate in expression.atoms(sympy.Derivative):  # the names of modelling.symbolic: q1, qdot1, qddot1
        name, order = rate.expr.func.__name__, rate.derivative_count
        functions[rate] = sympy.Symbol(f"{name[:1]}{'d' * order}ot{name[1:]}")
    expression = expression.subs(functions)
    functions = {f: sympy.Symbol(f.func.__name__) for f in expression.atoms(AppliedUndef)}
    expression = expression.subs(functions)
    return expression.subs({s: sympy.Symbol(s.name) for s in expression.free_symbols}, simultaneous=True)
