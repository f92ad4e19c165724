"""Controllers with gains kp, ki, kd and a limit: what they share, and the check of gains."""

import numpy as np

from ir50p_lab.controllers.base import Controller
from ir50p_lab.controllers.pid_law import KD, KI, KP, LIMIT
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers, vectors3


class GainController(Controller):
    """A controller whose `parameters` begin with kp, ki, kd and the limit of the command, three numbers each."""

    def _write_gains(self, kp, ki, kd):
        for name, place, value in (("kp", KP, kp), ("ki", KI, ki), ("kd", KD, kd)):
            self.parameters[place : place + 3] = gains(name, value)

    @property
    def kp(self):
        """Proportional gains (3,)."""
        return self.parameters[KP : KP + 3].copy()

    @property
    def ki(self):
        """Integral gains (3,)."""
        return self.parameters[KI : KI + 3].copy()

    @property
    def kd(self):
        """Derivative gains (3,)."""
        return self.parameters[KD : KD + 3].copy()

    @property
    def limit(self):
        """Limits of the command (3,), in its unit; infinite where there is none."""
        return self.parameters[LIMIT : LIMIT + 3].copy()


def gains(name, value):
    """Three gains, finite and not negative, as an array (3,); a scalar counts for all joints."""
    value = numbers(name, value, unit="command per rad")
    value = vectors3(name, np.broadcast_to(value, 3) if value.ndim == 0 else value, unit="command per rad")
    if value.shape != (3,) or (value < 0).any():
        raise InputError(
            f"{name} = {value.tolist()}: give three gains >= 0, one per joint; a negative gain pushes away"
        )
    return value


def positive(name, value, *, infinite=False, joints=False):
    """One positive number (or one per joint) as an array; infinite only where allowed. Raises InputError."""
    array = np.array(np.nan) if isinstance(value, (str, bool)) else numbers(name, value)
    if np.isnan(array).any() or (array <= 0).any() or array.shape not in ((), (3,) if joints else ()):
        raise InputError(
            f"{name} = {value!r:.60}: give {'one positive number, or one per joint' if joints else 'a positive number'}"
        )
    if not (infinite or joints) and not np.isfinite(array).all():
        raise InputError(f"{name} = {value!r}: must be finite")
    return array
