"""A recorded step response, checked: columns, the steps of u, units of time, outliers; and in units of its own."""

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.columns import same_samples
from ir50p_lab.identification.doubts import Doubts, check_outliers
from ir50p_lab.identification.response_fit import respond
from ir50p_lab.inputs import number

_FEWEST = 8  # samples from the first change of u on: twice the number of parameters


def recorded(**columns):
    """Columns of a recording as float arrays: one dimension, one length, finite; `t` increasing. Raises InputError."""
    arrays = same_samples(columns)
    for name, array in arrays.items():
        if array.ndim != 1:
            raise InputError(f"{name} has shape {array.shape}; give one value per sample, shape (n,)")
    return arrays.values()


def jumps_of(t, u, u_before):
    """Times (m,) and heights (m,) of the changes of u."""
    before = u[0] if u_before is None else number("u_before", u_before, hint="the input at rest before t[0]")
    heights = np.diff(u, prepend=before)
    return t[heights != 0], heights[heights != 0]


class StepRecord:
    """t, y (n,), times and jumps (m,) of u without outliers: first change of u at 0, end at 1, ranges of y and u 1.

    unit: s; y_unit, gain (y/u): what these ones are; y_first: y at 0; period: of the samples. doubts: about them.
    """

    def __init__(self, t, u, y, u_before, anyway=False):
        t, u, y = recorded(t=t, u=u, y=y)
        times, jumps = jumps_of(t, u, u_before)
        self.doubts = Doubts(anyway)
        self._check(t, u, y, times)
        places = check_outliers(self.doubts, "y", t, y, "left out; look for their cause")
        t, y = np.delete(t, places), np.delete(y, places)
        self.unit, self.y_unit, self.y_first = float(t[-1] - times[0]), float(np.ptp(y)), float(y[0])
        self.gain = self.y_unit / float(np.abs(jumps).max())
        self.t, self.times = (t - times[0]) / self.unit, (times - times[0]) / self.unit
        self.y, self.jumps = (y - y[0]) / self.y_unit, jumps / np.abs(jumps).max()
        self.period = float(np.median(np.diff(self.t)))

    def _check(self, t, u, y, times):
        steps = np.diff(t)
        period = float(np.median(steps))
        counted = np.abs(t - np.rint(t)).max() < 1e-6
        jitter = np.ptp(steps) / period  # of a computer's clock
        if (period >= 1 and counted) or (period >= 5 and 1e-6 < jitter < 1):
            self.doubts.add(f"one sample every {period:.4g} s: is t in milliseconds? Then T and L are too: give t/1000")
        check_outliers(self.doubts, "u", t, u)
        if not len(times):
            raise IdentificationError("u never changes: record samples before the step too, or give u_before=")
        if np.ptp(y) <= 1e-12 * np.abs(y).max():
            raise IdentificationError(f"y stays at {y[0]:.6g}: check sensor and power; is the step above the friction?")
        after = int((t >= times[0]).sum())
        if after < _FEWEST:
            raise IdentificationError(
                f"only {after} samples from the first change of u on; at least {_FEWEST} are needed: record longer"
            )

    def respond(self, a, L):
        """x (n,) of x' = v(t - L) - a x."""
        x = np.empty(len(self.t), dtype=type(a))
        respond(self.t, self.times, self.jumps, a, L, x)
        return x
