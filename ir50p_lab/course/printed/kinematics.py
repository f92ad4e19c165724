"""What the thesis prints in 1.3 (Jacobian) and 1.4 (inverse kinematics), equation by equation: mistakes included.

Only for A1 and its tests. For calculations use `ir50p_lab.modelling`.
The remark after 'wrong:' says what is wrong; an equation without one is right as printed.
"""

import numpy as np
from sympy import Matrix, cos, sin

from ir50p_lab.course.printed.pose import l2, l3, q1, q2, q3

c1, s1, c2, s2, c23, s23 = cos(q1), sin(q1), cos(q2), sin(q2), cos(q2 + q3), sin(q2 + q3)
z_hat = Matrix([0, 0, 1])  # (1.32)


def columns_1_46_to_1_48():
    """(1.46)-(1.48), the derivatives of the tip: right, though they do not follow from the printed (1.45)."""
    by_q1 = Matrix([-s1 * (l3 * c23 + l2 * c2), c1 * (l3 * c23 + l2 * c2), 0])
    by_q2 = Matrix([-c1 * (l3 * s23 + l2 * s2), -s1 * (l3 * s23 + l2 * s2), l3 * c23 + l2 * c2])
    by_q3 = Matrix([-l3 * s23 * c1, -l3 * s23 * s1, l3 * c23])
    return [by_q1, by_q2, by_q3]


def J_v_1_49():
    """(1.49). Wrong, or lost in the scan: s1 is missing in entry (2, 3) and row 3 has two entries (0 for the third)."""
    J = Matrix.hstack(*columns_1_46_to_1_48())
    J[1, 2] = -l3 * s23
    J[2, :] = Matrix([[0, l3 * c23, 0]])
    return J


def J_omega_1_37(frames):
    """(1.34), (1.37), (1.50) taken literally: column i is the z axis of frame i, for i = 1 ... n.

    Wrong with the frames of Table 1.1: joint i turns about the z axis of frame i-1.
    frames: (n+1, 4, 4), T^0_0 ... T^0_n.
    """
    return frames[1:, :3, 2].T


def Rot_x_1_51():
    """The turn by pi/2 about x inside (1.51). Wrong: its third row has cos(pi/2) where sin(pi/2) belongs."""
    return Matrix([[1, 0, 0], [0, 0, -1], [0, 0, 0]])


def R_0_2_1_51():
    """The product inside (1.51). Wrong: the last entry is 1 for 0. Its third column is used and is printed right."""
    return Matrix([[c1, 0, s1], [s1, 0, -c1], [0, 1, 1]])


def R_0_3_1_52():
    """The matrix inside (1.52). Wrong: entry (2, 3) is c1 for -c1, so that it does not give the printed Z_3."""
    return Matrix([[c1, 0, s1], [s1, 0, c1], [0, 1, 0]])


def Z_2_and_Z_3():
    """The results of (1.51) and (1.52): axes of joints 2 and 3, right."""
    return Matrix([s1, -c1, 0])


def sin_q3_1_61(cos_q3):
    """(1.61). Wrong: plus for minus, no square, one sign only."""
    return np.sqrt(1 + cos_q3)


def inverse_kinematics_1_60_to_1_73(l, p):
    """(1.60)-(1.73) taken literally: the one pose they give for a target.

    Wrong: arctan where the quadrant counts (1.60), (1.70), (1.73), and acos alone (1.69), which is elbow down.

    l: (3,) m; p: (..., 3) m. Returns: (..., 3) rad. The thesis never says what z1 is: the height above the shoulder.
    """
    x, y, z = np.moveaxis(np.asarray(p, dtype=float), -1, 0)
    z1 = z - l[0]
    delta = np.hypot(x, y)
    cos_alpha = (l[1] ** 2 + l[2] ** 2 - delta**2 - z1**2) / (2 * l[1] * l[2])
    angle_3 = np.arccos(np.clip(-cos_alpha, -1, 1))
    B = np.arctan(l[2] * np.sin(angle_3) / (l[1] + l[2] * np.cos(angle_3)))
    return np.stack([np.arctan(y / x), np.arctan(z1 / delta) - B, angle_3], axis=-1)
