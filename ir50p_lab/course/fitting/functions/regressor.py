"""regressor: what each of the 20 numbers of a joint adds to its push along a motion."""

import numpy as np

from ir50p_lab.course.checking.task import task_of, text_of


def body_columns(q, qd, qdd):
    """Return what accelerations and speeds ask for, (3, 20), with zeros in the other columns (2.51 corrected)."""
    c2, s2, c3, s3 = np.cos(q[1]), np.sin(q[1]), np.cos(q[2]), np.sin(q[2])
    c23, s23, (a, b, c), (A, B, C) = np.cos(q[1] + q[2]), np.sin(q[1] + q[2]), qd, qdd
    both, swing, Y = s23 * c2 + c23 * s2, B + C + s23 * c23 * a**2, np.zeros((3, 20))
    Y[0, [0, 1, 6, 7]] = A, c2**2 * A - 2 * s2 * c2 * a * b, B, B + C
    Y[0, 4] = c23**2 * A - 2 * s23 * c23 * a * (b + c)
    Y[0, 5] = 2 * c2 * c23 * A - 2 * both * a * b - 2 * s23 * c2 * a * c
    Y[1, [1, 4, 6, 7, 8, 9]] = B + s2 * c2 * a**2, swing, A, A, B, B + C
    Y[1, 5] = 2 * c3 * B + c3 * C + both * a**2 - s3 * c**2 - 2 * s3 * b * c
    Y[2, [4, 5, 7, 9, 19]] = swing, c3 * B + s23 * c2 * a**2 + s3 * b**2, A, B + C, C
    return Y


def regressor(q, qd, qdd, direction):
    """Return the table Y (3, 20): Y times the 20 numbers of each joint, added up, are the pushes (2.50, 2.51)."""
    Y = body_columns(q, qd, qdd)
    level, forearm = np.cos(q[1]), np.cos(q[1] + q[2])
    Y[1, 2] = 9.81 * level
    Y[1, 3] = 9.81 * forearm
    Y[2, 3] = 9.81 * forearm
    for joint in range(3):
        Y[joint, 10 + 2 * joint] = qd[joint]
        Y[joint, 11 + 2 * joint] = direction[joint]
        Y[joint, 16 + joint] = 1
    return Y


def _states():
    rng = np.random.default_rng(122)
    cases = [tuple(rng.uniform(-1.5, 1.5, (4, 3))) for _ in range(7)]
    still = np.zeros(3)
    leaning = rng.uniform(-1, 1, 3)
    return [*cases, (leaning, still, still, still), (leaning, still, still, np.array([1.0, -0.3, 0.6]))]


TASK = task_of(regressor, helpers=(body_columns,), cases=_states, given=text_of(body_columns) + "\n\n\n")
