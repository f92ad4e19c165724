"""What a controller is: numbers in two arrays, and one compiled function that all loops share."""

import math
import warnings

import numpy as np

from ir50p_lab.controllers import law
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, vector3, vectors3
from ir50p_lab.signals.reference import per_joint

GAINS = ("kp", "ki", "kd")


def three(place, what):
    """Return a property that reads the three numbers, one per joint, at `place` of a controller's parameters."""

    def read(self):
        return self.parameters[place : place + 3].copy()

    return property(read, doc=what)


class Controller:
    """A controller whose law is compiled once and runs in the notebook, the simulation, the sweep and the bench.

    The law is `law_step`. Its numbers are in `parameters` (kp, ki and kd first), its memory is in `state`. `rows` and
    `tables` are pairs (name, place) that say what the parameters hold: three numbers, or (3, 20). `unit` is that of the
    command ('N m' or 'PWM'). Python's `step` and the compiled loops call the same function on the same arrays, so their
    numbers are the same to the last bit.
    """

    rows = ("kp", law.KP), ("ki", law.KI), ("kd", law.KD)
    tables = ()
    takes_up = None  # place in the state of what keeps u as it was when gains change; None: nothing does
    kp = three(law.KP, "Proportional gains (3,).")
    ki = three(law.KI, "Integral gains (3,).")
    kd = three(law.KD, "Derivative gains (3,).")
    limit = three(law.LIMIT, "Limits of the command (3,), in its unit; infinite where there is none.")

    def __init__(self, unit, limit, period, filter_hz, position_filter_hz=None):
        self.unit = unit
        self.parameters, self.state = np.zeros(law.N_PARAMETERS), np.zeros(law.N_STATES)
        p = self.parameters
        p[law.LIMIT : law.LIMIT + 3] = limits(limit)
        p[law.PERIOD] = number("period", period, "> 0", unit="s")
        p[law.FILTER_RATE] = 2 * np.pi * number("filter_hz", filter_hz, "> 0 or inf", unit="Hz")
        if position_filter_hz not in (None, np.inf):
            p[law.POSITION_RATE] = 2 * np.pi * number("position_filter_hz", position_filter_hz, "> 0", unit="Hz")

    def reset(self):
        """Forget the past: the integrals, the filters and the last sample."""
        self.state[:] = 0.0

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains in the middle of a run; a `PID` does so without a jump, its integral takes up the difference.

        Args: kp, ki, kd: (3,) or one number; a gain that is left out stays as it is.
        Raises InputError for gains that are negative or not finite (then none is changed).
        """
        p, s, given = self.parameters, self.state, {"kp": kp, "ki": ki, "kd": kd}
        wanted = {place: gains(name, given[name]) for name, place in self.rows if given[name] is not None}
        before = self.kp, self.kd
        for place, value in wanted.items():
            p[place : place + 3] = value
        if s[law.STARTED] and self.takes_up is not None:
            slope = s[law.SLOPE : law.SLOPE + 3]
            ahead = s[law.ERROR : law.ERROR + 3] + p[law.DELAY] * slope
            s[self.takes_up : self.takes_up + 3] += (before[0] - self.kp) * ahead + (before[1] - self.kd) * slope

    def header(self):
        """Return what the head of a recording says, dict of str: the gains of the joints, the filters, any model."""
        p, lines = self.parameters, {"controller": type(self).__name__}
        for name, place in self.rows:
            lines[name] = " ".join(f"{x:g}" for x in p[place : place + 3])
        for name, place in (("filter_hz", law.FILTER_RATE), ("position_filter_hz", law.POSITION_RATE)):
            lines[name] = f"{p[place] / (2 * np.pi) or np.inf:g}"
        for name, place in self.tables:
            for i, row in enumerate(p[place : place + 60].reshape(3, 20)):
                lines[f"{name}_{i + 1}"] = " ".join(f"{x:.6g}" for x in row)
        return lines

    def step(self, t, measured, reference):
        """Return the command for one sample.

        Args: t: s; measured: q (3,) rad; reference: (q, qd, qdd), three vectors (3,) or an array (3, 3).
        Returns: u (3,), in `unit`, within its limits. Raises InputError if a number is not finite; warns if t runs
            backwards.
        """
        u = np.empty(3)
        if self.state[law.STARTED] and t < self.state[law.TIME]:
            before = self.state[law.TIME]
            said = f"t = {t:.6g} s after {before:.6g} s: time runs backwards, and this step does not count"
            warnings.warn(f"{said}; call reset() before another run", stacklevel=2)
        law.law_step(self.parameters, self.state, float(t), _plain(measured), _plain_rows(reference), u)
        if not math.isfinite(u[0] + u[1] + u[2] + t):
            vectors3("measured q", measured)
            vectors3("reference", reference, unit="rad, rad/s, rad/s^2")
            raise InputError(f"the command is {u.tolist()} at t = {t} s; the controller's state is spoilt: reset it")
        return u


def is_compiled(controller):
    """Return True if compiled loops may run it: a controller of the package whose `step` nobody has replaced."""
    return isinstance(controller, Controller) and getattr(controller.step, "__func__", None) is Controller.step


def gains_of(controller):
    """Return {'kp': (3,), 'ki': (3,), 'kd': (3,)} of a controller that keeps its gains under these names, else {}."""
    if not all(hasattr(controller, name) for name in GAINS):
        return {}
    return {name: np.broadcast_to(np.asarray(getattr(controller, name), dtype=float), 3).copy() for name in GAINS}


def set_gains(controller, **gains):
    """Change kp, ki, kd of a running controller: by its own `set_gains` if it has one, else in its attributes."""
    if hasattr(controller, "set_gains"):
        return controller.set_gains(**gains)
    for name, value in gains.items():
        setattr(controller, name, np.array(value, dtype=float))


def gains(name, value):
    """Return three gains, finite and not negative, as an array (3,); a scalar counts for all joints.

    Raises InputError.
    """
    return np.array(per_joint(name, value, ">= 0", unit="command per rad"))


def limits(value):
    """Return the limits of a command as an array (3,), all > 0, from one number or three; None or infinity: no limit.

    Raises InputError for other shapes and values.
    """
    return np.array(per_joint("limit", np.inf if value is None else value, "> 0 or inf"))


def unit_of(limit_pwm, limit):
    """Return (unit, limit) of a command: the unit is 'PWM' if limit_pwm is given, else 'N m'.

    Raises InputError if both limits are given.
    """
    if limit_pwm is not None and limit is not None:
        raise InputError("give limit_pwm (PWM counts) or limit (N m), not both: the command has one unit")
    return ("N m", limit) if limit_pwm is None else ("PWM", limit_pwm)


def _plain(q):
    if type(q) is np.ndarray and q.shape == (3,) and q.dtype == np.float64:
        return q
    return np.ascontiguousarray(vector3("measured q", q))


def _plain_rows(reference):
    rows = np.asarray(reference, dtype=float)
    if rows.shape != (3, 3):
        raise InputError(f"reference has shape {rows.shape}; give (q, qd, qdd), three vectors of shape (3,)")
    return np.ascontiguousarray(rows)


def check_controller(controller):
    """Raise InputError if the controller has no step()."""
    if not callable(getattr(controller, "step", None)):
        raise InputError(
            f"controller = {controller!r:.60}: give a controller with step(t, measured, reference), such as PID(...)"
        )


def check_reference(reference, *, sampled=False):
    """Raise InputError if the reference is not a function; with `sampled`, a `sample(times)` is enough."""
    if not (callable(reference) or (sampled and hasattr(reference, "sample"))):
        raise InputError(
            f"reference = {reference!r:.60}: give a function of time, target(t) -> (q, qd, qdd), such as hold([...])"
        )
