"""References that stand still: one pose, or one after the other."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vectors3
from ir50p_lab.signals.reference import Reference, pose, time_vector


@dataclass(frozen=True)
class Steps(Reference):
    """A piecewise constant reference; `hold` and `steps` make it.

    times: m increasing numbers, s; values: m poses, rad. values[i] begins at times[i] and holds until the next.
    """

    times: tuple
    values: tuple
    duration: float

    def _rows(self, t):
        rows = np.zeros((len(t), 3, 3))
        piece = np.array(self.times).searchsorted(t, side="right") - 1
        rows[:, 0] = np.array(self.values).take(piece, axis=0, mode="clip")
        return rows


def hold(q):
    """Stay at the pose `q` for ever: qd = qdd = 0.

    Args: q: (3,) rad. Returns: Reference with duration 0. Raises InputError on a wrong shape or a number that is not
    finite.

    >>> from ir50p_lab.signals import hold
    >>> q, qd, qdd = hold([1.57, 1.57, -1.05])(3.0)
    >>> q
    array([ 1.57,  1.57, -1.05])
    """
    return Steps(times=(0.0,), values=(pose("q", q),), duration=0.0)


def steps(times, values):
    """Jump from pose to pose: values[i] holds from times[i] (included) until times[i + 1].

    At a jump q changes at once, and qd = qdd = 0 there as everywhere: the impulse that would be the derivative of a
    step is left out, because no controller can use it. Steps are good for step responses, not for moving an arm gently.

    Args:
        times: (m,) s, increasing, the first 0 (or earlier).
        values: (m, 3) rad.

    Returns: Reference; its duration is the time of the last jump.
    Raises: InputError on wrong shapes, numbers that are not finite, times that do not increase, or a first time
    after 0 (the pose before it would be unknown).

    >>> from ir50p_lab.signals import steps
    >>> steps([0, 1], [[0, 0, 0], [0.2, 0, 0]])(1.5)[0]
    array([0.2, 0. , 0. ])
    """
    times, values = time_vector("times", times), vectors3("values", values)
    if values.ndim != 2 or len(times) != len(values) or len(times) == 0:
        raise InputError(f"times {times.shape} and values {values.shape} do not fit: give (m,) and (m, 3)")
    if (np.diff(times) <= 0).any() or times[0] > 0:
        raise InputError(
            f"times = {times.tolist()} s: let them increase from 0 (or earlier), where the first pose begins"
        )
    times, values = tuple(times.tolist()), tuple(map(tuple, values.tolist()))
    return Steps(times=times, values=values, duration=max(0.0, times[-1]))
