"""Controllers with gains kp, ki, kd, a limit and filters: what they share, and the check of gains and limits."""

import numpy as np

from ir50p_lab.controllers.base import GAINS, Controller
from ir50p_lab.controllers.pid_law import FILTER_RATE, KD, KI, KP, LIMIT, PERIOD, POSITION_RATE
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, numbers, vectors3


class GainController(Controller):
    """A controller whose `parameters` begin with kp, ki, kd and the limit of the command, three numbers each.

    Then come the period and the two filters.
    """

    def _write_limit_and_filters(self, limit, period, filter_hz, position_filter_hz):
        """limit: of the command, None: none; the others as the controllers' arguments."""
        p = self.parameters
        p[LIMIT : LIMIT + 3] = limits(limit)
        p[PERIOD] = number("period", period, "> 0", unit="s")
        p[FILTER_RATE] = 2 * np.pi * number("filter_hz", filter_hz, "> 0 or inf", unit="Hz")
        if position_filter_hz is not None:
            rate = 2 * np.pi * number("position_filter_hz", position_filter_hz, "> 0 or inf", unit="Hz")
            p[POSITION_RATE] = 0.0 if np.isinf(rate) else rate  # 0 and inf: no filter

    def _write_gains(self, kp, ki, kd):
        for name, place, value in (("kp", KP, kp), ("ki", KI, ki), ("kd", KD, kd)):
            self.parameters[place : place + 3] = gains(name, value)

    def header(self):
        """Lines for the head of a recording: the gains, joints 1 to 3, and the filters."""
        lines = {name: " ".join(f"{x:g}" for x in getattr(self, name)) for name in GAINS}
        for name, place in (("filter_hz", FILTER_RATE), ("position_filter_hz", POSITION_RATE)):
            lines[name] = f"{self.parameters[place] / (2 * np.pi) or np.inf:g}"
        return {**super().header(), **lines}

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


def limits(value):
    """Limits of a command, > 0, one number or one per joint; infinite, or None: no limit. Raises InputError."""
    if value is None:
        return np.array(np.inf)
    array = np.array(np.nan) if isinstance(value, (str, bool)) else numbers("limit", value)
    if array.shape not in ((), (3,)) or not (array > 0).all():
        raise InputError(f"limit = {value!r:.60}: must be positive: give one number, or one per joint")
    return array
