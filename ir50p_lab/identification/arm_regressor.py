"""The regressor: torque = Phi theta is linear in the 20 parameters    (2.50), (2.51) corrected."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, vectors3
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.modelling.dynamics import STANDARD_GRAVITY
from ir50p_lab.modelling.kernel import warn_of_degrees


@jit()
def _fill(gravity, q, qd, qdd, direction, out):
    """Write the rows for states (n, 3) into out (n, 3, 20), given as zeros; entries that are always 0 are skipped."""
    for k in range(q.shape[0]):
        a, b, c = qd[k, 0], qd[k, 1], qd[k, 2]
        A, B, C = qdd[k, 0], qdd[k, 1], qdd[k, 2]
        sin2, c2 = cf.sincos(q[k, 1])
        sin3, c3 = cf.sincos(q[k, 2])
        c23, sin23 = c2 * c3 - sin2 * sin3, sin2 * c3 + c2 * sin3
        one, two, three = out[k, 0], out[k, 1], out[k, 2]
        # inertia of upper arm (theta2) and forearm (theta5, theta6) about the waist: it changes with the pose
        one[0] = A
        one[1] = c2 * c2 * A - 2 * sin2 * c2 * a * b
        two[1] = B + sin2 * c2 * a * a
        one[4] = c23 * c23 * A - 2 * sin23 * c23 * a * (b + c)
        two[4] = three[4] = B + C + sin23 * c23 * a * a
        mixed = sin23 * c2 + c23 * sin2
        one[5] = 2 * c2 * c23 * A - 2 * mixed * a * b - 2 * sin23 * c2 * a * c
        two[5] = 2 * c3 * B + c3 * C + mixed * a * a - sin3 * c * c - 2 * sin3 * b * c
        three[5] = c3 * B + sin23 * c2 * a * a + sin3 * b * b
        # gravity
        two[2] = gravity * c2
        two[3] = three[3] = gravity * c23
        # the thesis's constant products of inertia
        one[6] = B
        one[7] = B + C
        two[6] = two[7] = three[7] = A
        # inertia about the joints' own axes, rotors
        two[8] = B
        two[9] = three[9] = B + C
        three[19] = C
        # friction and offset
        one[10], two[12], three[14] = a, b, c
        one[11], two[13], three[15] = direction[k, 0], direction[k, 1], direction[k, 2]
        one[16] = two[17] = three[18] = 1.0


def regressor(q, qd, qdd, *, g=STANDARD_GRAVITY, sign=None):
    """Return Phi(q, qd, qdd): the torque is tau = Phi theta, with theta as in `Arm.theta`    (2.50), (2.51) corrected.

    The same holds in PWM counts with `Arm.theta_pwm`. For a theta with a row per joint (3, 20), tau_i = Phi_i theta_i:
    `np.einsum("nij,ij->ni", Phi, theta)`.

    Args:
        q, qd, qdd: (3,) or (n, 3), rad, rad/s, rad/s^2.
        g: gravity, m/s^2, >= 0.
        sign: how the sign of qd enters the Coulomb columns. None: sgn(qd), 0 at rest. A speed v > 0, rad/s: tanh(qd/v),
            a soft sign that does not jump.

    Returns: (3, 20) or (n, 3, 20). Raises InputError on wrong shapes, numbers that are not finite, a bad g or sign.

    >>> from ir50p_lab.identification import regressor
    >>> regressor([[0, 0, 0]], [[0, 0, 0]], [[0, 0, 0]]).shape
    (1, 3, 20)
    """
    q, qd, qdd = (vectors3(name, value, unit="SI") for name, value in (("q", q), ("qd", qd), ("qdd", qdd)))
    if q.ndim > 2 or qd.shape != q.shape or qdd.shape != q.shape:
        raise InputError(f"q {q.shape}, qd {qd.shape}, qdd {qdd.shape}: give all (3,), or all (n, 3) with the same n")
    warn_of_degrees(None, q)
    g = number("g", g, ">= 0", unit="m/s^2", hint="the base z axis points up")
    direction = np.tanh(qd / number("sign", sign, "> 0", unit="rad/s")) if sign is not None else np.sign(qd)
    rows = [np.ascontiguousarray(x).reshape(-1, 3) for x in (q, qd, qdd, direction)]
    out = np.zeros((len(rows[0]), 3, 20))
    _fill(g, *rows, out)
    return out[0] if q.ndim == 1 else out
