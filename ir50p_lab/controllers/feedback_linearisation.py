"""Feedback linearisation of any system x' = f(x) + g(x) u, y = h(x), in symbols    (2.8)-(2.17).

Computed torque is this for an arm: relative degree 2 on each joint. Here is the general tool, for small examples.
SymPy is imported when a function is called.
"""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers


@dataclass(frozen=True)
class FeedbackLinearisation:
    """y^(r) = alpha(x) + beta(x) u: what `feedback_linearise` found    (2.8).

    relative_degree: r, how often y must be differentiated until u shows; coordinates: (y, y', ..., y^(r-1)) as
    functions of x; alpha = L_f^r h; beta = L_g L_f^(r-1) h, zero where the law has no answer; hidden: n - r states
    that y does not show (zero dynamics; their stability is not looked at); x: the symbols of the state.
    """

    x: tuple
    relative_degree: int
    coordinates: tuple
    alpha: object
    beta: object

    @property
    def hidden(self):
        """Number of states that the output does not show."""
        return len(self.x) - self.relative_degree

    def law(self, v):
        """u = (v - alpha)/beta, an expression in x: with it y^(r) = v    (2.9), (2.10)."""
        return (v - self.alpha) / self.beta

    def controller(self, gains, parameters=None):
        """A function u(x, target) of numbers: tracks target = (y, y', ..., y^(r)) with the gains K0..K_(r-1).

        v = y_ref^(r) - K0 e - K1 e' - ...,  e = y - y_ref    (2.11) for tracking. target None: go to y = 0.
        parameters: {symbol: number} of what else is in the equations.
        Raises InputError if the number of gains is not r, or a symbol has no number. Stability is not asked for
        here: `hurwitz(gains)` says.
        """
        import sympy as sp

        r, gains = self.relative_degree, _numbers("gains", gains)
        if len(gains) != r:
            raise InputError(f"{len(gains)} gains for relative degree {r}: give K0 to K{r - 1}")
        outputs = [sp.sympify(e).subs(parameters or {}) for e in (*self.coordinates, self.alpha, self.beta)]
        unknown = set().union(*(e.free_symbols for e in outputs)) - set(self.x)
        if unknown:
            raise InputError(f"no number for {sorted(map(str, unknown))}: give parameters={{symbol: number}}")
        evaluate = sp.lambdify(self.x, outputs, "math")

        def u(x, target=None):
            *z, alpha, beta = evaluate(*x)
            target = np.zeros(r + 1) if target is None else target
            v = target[r] - sum(k * (now - wanted) for k, now, wanted in zip(gains, z, target[:r], strict=True))
            return (v - alpha) / beta

        return u


def lie_derivative(h, f, x):
    """L_f h = sum_i dh/dx_i f_i: how h changes along the field f. h: expression; f, x: n expressions, n symbols."""
    import sympy as sp

    if len(f) != len(x):
        raise InputError(f"{len(f)} rates for {len(x)} states: give one each")
    return sum((sp.diff(h, xi) * sp.sympify(fi) for xi, fi in zip(x, f, strict=True)), sp.Integer(0))


def feedback_linearise(f, g, h, x):
    """Differentiate y = h(x) until the input shows: relative degree, coordinates and the law    (2.8)-(2.10).

    Args: f, g: n expressions each, of x' = f(x) + g(x) u; h: expression, the output; x: n symbols.
    Returns: FeedbackLinearisation. Raises InputError on wrong sizes, or if the input never shows in y.
    """
    import sympy as sp

    coordinates, current = [], sp.sympify(h)
    for degree in range(1, len(x) + 1):
        coordinates.append(current)
        beta = sp.simplify(lie_derivative(current, g, x))
        current = sp.simplify(lie_derivative(current, f, x))
        if beta != 0:
            return FeedbackLinearisation(tuple(x), degree, tuple(coordinates), current, beta)
    raise InputError(f"the input does not show in any derivative of {h}: it cannot be controlled from this output")


def gains_for_poles(poles):
    """Gains K0..K_(n-1) that put the poles of (2.12) at `poles` (n numbers, complex ones in pairs): array (n,).

    Raises InputError if a pole is not in the left half plane, or a complex one comes without its partner.
    """
    try:
        poles = np.atleast_1d(np.asarray(poles, dtype=complex))
    except (TypeError, ValueError):
        raise InputError(f"poles = {poles!r:.60}: give numbers with negative real part") from None
    if poles.ndim != 1 or not len(poles) or not np.isfinite(poles).all() or (poles.real >= 0).any():
        raise InputError(f"poles = {poles.tolist()}: give numbers with negative real part; the error grows otherwise")
    coefficients = np.poly(poles)
    if np.abs(np.imag(coefficients)).max() > 1e-9 * np.abs(coefficients).max():
        raise InputError(f"poles = {poles.tolist()}: a complex pole needs its partner, or the gains are complex")
    return np.real(coefficients)[:0:-1].copy()


def routh_table(gains):
    """Routh's table of s^n + K_(n-1) s^(n-1) + ... + K0: array (n+1, columns), gains K0 first    (2.12).

    A zero in the first column ends it (the rows below are NaN): the polynomial is not Hurwitz then.
    """
    coefficients = np.concatenate([[1.0], _numbers("gains", gains)[::-1]])
    n, columns = len(coefficients) - 1, (len(coefficients) + 1) // 2
    table = np.zeros((n + 1, columns))
    table[0, : len(coefficients[0::2])] = coefficients[0::2]
    table[1, : len(coefficients[1::2])] = coefficients[1::2]
    for row in range(2, n + 1):
        above, pivot = table[row - 2], table[row - 1, 0]
        if pivot == 0:
            table[row:] = np.nan
            break
        with np.errstate(over="ignore", invalid="ignore"):  # a pivot next to zero: infinite, and not Hurwitz
            table[row, :-1] = above[1:] - above[0] * table[row - 1, 1:] / pivot
    return table


def hurwitz(gains):
    """Whether s^n + K_(n-1) s^(n-1) + ... + K0 has all its roots in the left half plane, by Routh's table.

    For n <= 2 positive gains are enough, as the thesis says; from n = 3 on they are not (s^3 + s^2 + s + 8).
    Args: gains: K0..K_(n-1). Raises InputError if there is none or one is not finite.
    """
    return bool((routh_table(gains)[:, 0] > 0).all())


def pendulum_with_motor_lag():
    """The example of the course: a pendulum whose motor needs a moment, n = 3: (f, g, h, x, parameters).

    angle' = speed, speed' = -a sin(angle) - b speed + torque, torque' = (u - torque)/T; output: the angle.
    parameters: {a: 9.81, b: 0.2, T: 0.1}, symbols to numbers (1/s^2, 1/s, s; per unit of inertia).
    """
    import sympy as sp

    angle, speed, torque, a, b, T = sp.symbols("angle speed torque a b T", real=True)
    f = (speed, -a * sp.sin(angle) - b * speed + torque, -torque / T)
    return f, (0, 0, 1 / T), angle, (angle, speed, torque), {a: 9.81, b: 0.2, T: 0.1}


def _numbers(name, values):
    array = np.atleast_1d(numbers(name, values))
    if array.ndim != 1 or not len(array) or not np.isfinite(array).all():
        raise InputError(f"{name} = {values!r}: give finite numbers, K0 first")
    return array
