"""What the thesis prints in 2.2.4, as functions: mistakes included.

Only for A1 and its tests. For calculations use `ir50p_lab.identification`.
Parts that the source has lost (the beginnings of U1 and U2, the columns 6 to 9) are taken as they must be.
"""

import numpy as np

from ir50p_lab.identification import regressor
from ir50p_lab.modelling import gravity, inverse_dynamics


def regressor_2_51(q, qd, qdd):
    """(2.51). Wrong: phi_2 has + for - and q1' for q1'^2; phi_5 has q1' for q1'' in row 1 and for q1'^2 below.

    Args: q, qd, qdd: (n, 3). Returns: (n, 3, 20).
    """
    Phi = regressor(q, qd, qdd)
    q2, q23 = q[:, 1], q[:, 1] + q[:, 2]
    a, b, c = qd.T
    A, B, C = qdd.T
    s2c2, s23c23 = np.sin(q2) * np.cos(q2), np.sin(q23) * np.cos(q23)
    Phi[:, 0, 1] = np.cos(q2) ** 2 * A + 2 * s2c2 * a * b
    Phi[:, 1, 1] = B + s2c2 * a
    Phi[:, 0, 4] = np.cos(q23) ** 2 * a - 2 * s23c23 * a * (b + c)
    Phi[:, 1, 4] = Phi[:, 2, 4] = B + C + s23c23 * a
    return Phi


def torque_2_48(arm, q, qd, qdd):
    """(2.48) as torque, in N m, term by term where it differs from the equations of motion.

    Wrong: U1 lacks l2 in the term of q1' q3'; U2 has q1' q3' for q2' q3', no term of q3'^2 and lc2 for l2 in the
    gravity; U3 has q1' for q1'^2, s2 q2' for s3 q2'^2, and the velocity of joint 2 in its viscous friction.
    Args: arm: Arm; q, qd, qdd: (n, 3). Returns: (n, 3).
    """
    (_, m2, m3), (_, l2, _), (_, lc2, lc3) = arm.m, arm.l, arm.lc
    c2, s2, s3 = np.cos(q[:, 1]), np.sin(q[:, 1]), np.sin(q[:, 2])
    c23, s23 = np.cos(q[:, 1] + q[:, 2]), np.sin(q[:, 1] + q[:, 2])
    a, b, c = qd.T
    k = m3 * lc3 * l2
    tau = np.array(inverse_dynamics(arm, q, qd, qdd))
    tau[:, 0] += 2 * k * s23 * c2 * a * c - 2 * m3 * lc3 * s23 * c2 * a * c
    tau[:, 1] += -2 * k * s3 * a * c + 2 * k * s3 * b * c + k * s3 * c**2
    tau[:, 1] += arm.g * (m2 * lc2 * c2 + m3 * (lc3 * c23 + lc2 * c2)) - gravity(arm, q)[:, 1]
    swing = (m3 * lc3**2 + arm.Iyy[2] - arm.Ixx[2]) * c23 * s23 + k * c2 * s23
    tau[:, 2] += swing * (a - a**2) + k * (s2 * b - s3 * b**2) + arm.friction.fv[2] * (b - c)
    return tau
