"""What a controller is: numbers in two arrays and one compiled function that all loops share."""

import math

import numpy as np

from ir50p_lab.controllers.dispatch import control_step
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vector3, vectors3

GAINS = ("kp", "ki", "kd")


class Controller:
    """A controller whose law is compiled once and runs in the notebook, the simulation, the sweep and the bench.

    Subclasses set `kind` (its number in `dispatch`), `parameters` (float array), `state` (float array) and `unit` of
    the command ('N m' or 'PWM'). Python's `step` and the compiled loops call the same function on the same arrays:
    the numbers are the same to the last bit.
    """

    kind: int
    unit = "N m"

    def reset(self):
        """Forget the past: integrals, filters and the last sample."""
        self.state[:] = 0.0

    def header(self):
        """Lines for the head of a recording: dict of str; subclasses add their gains."""
        return {"controller": type(self).__name__}

    def step(self, t, measured, reference):
        """The command for one sample.

        Args: t: s; measured: q (3,) rad; reference: (q, qd, qdd), three vectors (3,) or an array (3, 3).
        Returns: u (3,), in `unit`, after limits. Raises InputError if a number is not finite.
        """
        u = np.empty(3)
        control_step(self.kind, self.parameters, self.state, float(t), _plain(measured), _plain_rows(reference), u)
        if not math.isfinite(u[0] + u[1] + u[2]):
            vectors3("measured q", measured)
            vectors3("reference", reference, unit="rad, rad/s, rad/s^2")
            raise InputError(f"the command is {u.tolist()} at t = {t} s; the controller's state is spoilt: reset it")
        return u


def gains_of(controller):
    """{'kp': (3,), 'ki': (3,), 'kd': (3,)} of any controller that keeps its gains under these names, else {}."""
    if not all(hasattr(controller, name) for name in GAINS):
        return {}
    return {name: np.broadcast_to(np.asarray(getattr(controller, name), dtype=float), 3).copy() for name in GAINS}


def set_gains(controller, **gains):
    """Change kp, ki, kd of a running controller: by its own `set_gains`, else where it keeps them."""
    if hasattr(controller, "set_gains"):
        return controller.set_gains(**gains)
    for name, value in gains.items():
        setattr(controller, name, np.array(value, dtype=float))


def _plain(q):
    if type(q) is np.ndarray and q.shape == (3,) and q.dtype == np.float64:
        return q
    return np.ascontiguousarray(vector3("measured q", q))


def _plain_rows(reference):
    rows = np.asarray(reference, dtype=float)
    if rows.shape != (3, 3):
        raise InputError(f"reference has shape {rows.shape}; give (q, qd, qdd), three vectors of shape (3,)")
    return np.ascontiguousarray(rows)
