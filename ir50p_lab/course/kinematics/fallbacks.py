"""What stands in for a function of 03 until the student's is right: no check keeps that one."""

import numpy as np

from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def pace(q, direction, l, fastest):
    """Greatest tip speed (m/s) along direction, no joint above fastest (rad/s).

    At a singular pose: that of the joint speeds of least length, which is safe and not always the greatest; 0 where
    the direction is shut.
    """
    T = frames(q, l)
    Jv = jacobian(T, 3, T[3][:3, 3])[:3]
    qd = np.linalg.lstsq(Jv, direction, rcond=1e-9)[0]
    if not np.allclose(Jv @ qd, direction, atol=1e-6):
        return 0.0
    return fastest / np.max(np.abs(qd))
