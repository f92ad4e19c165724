"""Differential kinematics: the geometric Jacobian (1.32)-(1.55)."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.modelling.chain import lengths
from ir50p_lab.modelling.kernel import NOT_FINITE, evaluate, kernel, warn_of_degrees


@kernel("(n),(m),(n)->(m,n)")
def _jacobian(l, six, q, J):
    c1, s1 = np.cos(q[0]), np.sin(q[0])
    rho3, z3 = l[2] * np.cos(q[1] + q[2]), l[2] * np.sin(q[1] + q[2])  # tip from the elbow: outwards, up
    rho, z = l[1] * np.cos(q[1]) + rho3, l[1] * np.sin(q[1]) + z3  # tip from the shoulder
    J[0, 0], J[0, 1], J[0, 2] = -s1 * rho, -c1 * z, -c1 * z3
    J[1, 0], J[1, 1], J[1, 2] = c1 * rho, -s1 * z, -s1 * z3
    J[2, 0], J[2, 1], J[2, 2] = 0.0, rho, rho3
    J[3, 0], J[3, 1], J[3, 2] = 0.0, s1, s1
    J[4, 0], J[4, 1], J[4, 2] = 0.0, -c1, -c1
    J[5, 0], J[5, 1], J[5, 2] = 1.0, 0.0, 0.0
    if not np.isfinite(c1 + rho + z):
        raise InputError(NOT_FINITE)


_SIX = np.empty(6)  # gives a column of J its length: the signature of a ufunc may hold no numbers


def jacobian(arm, q):
    """Return the geometric Jacobian of the tip in the base frame: [v; omega] = J qd    (1.43), (1.46)-(1.54 corrected)

    Column i is [z_{i-1} x (p - o_{i-1}); z_{i-1}]: joint i turns about z of the frame before it, so the indices in
    (1.34) and (1.37) have to be shifted by one.

    Args: arm: Arm; q: (3,) or (n, 3) rad.
    Returns: (6, 3) or (n, 6, 3); rows 0-2 in m/rad (Jv), rows 3-5 without unit (Jw).

    >>> from ir50p_lab.modelling import IR50P, jacobian
    >>> jacobian(IR50P, [0, 0, 0])[:3].round(3) + 0.0
    array([[0.   , 0.   , 0.   ],
           [0.572, 0.   , 0.   ],
           [0.   , 0.572, 0.372]])
    """
    J = evaluate(_jacobian, (lengths(arm), _SIX), q=q)
    warn_of_degrees(arm, q)
    return J
