"""Harmonic motion of the joints."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.signals.reference import Reference, per_joint


@dataclass(frozen=True)
class Sinusoid(Reference):
    """A harmonic reference without end; `sinusoid` makes it. All its fields are (3,): rad, rad/s, rad, rad."""

    amplitude: tuple
    omega: tuple
    offset: tuple
    phase: tuple
    duration: float = math.inf

    def _rows(self, t):
        A, w = np.array(self.amplitude), np.array(self.omega)
        angle = w * t[:, None] + np.array(self.phase)
        rows = np.empty((len(t), 3, 3))
        rows[:, 0] = np.array(self.offset) + A * np.sin(angle)
        rows[:, 1] = A * w * np.cos(angle)
        rows[:, 2] = -A * w**2 * np.sin(angle)
        return rows


def sinusoid(amplitude, omega, *, offset=0.0, phase=0.0):
    """Swing for ever: q = offset + amplitude sin(omega t + phase), each joint with its own numbers.

    The joints move already at t = 0 and before (with velocity amplitude omega cos(phase)), so an arm at rest cannot
    follow the first instant. With phase = pi/2 the motion begins at rest, at the end of the swing.

    Args: amplitude: rad; omega: rad/s; offset: rad; phase: rad; each one number for all joints, or (3,).
    Returns: Reference with duration inf. Raises InputError on a wrong shape or a number that is not finite.
    """
    return Sinusoid(
        amplitude=per_joint("amplitude", amplitude, unit="rad"),
        omega=per_joint("omega", omega, unit="rad/s"),
        offset=per_joint("offset", offset, unit="rad"),
        phase=per_joint("phase", phase, unit="rad"),
    )
