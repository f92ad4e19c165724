"""The kinematic chain: Denavit-Hartenberg matrices, all frames, forward kinematics (1.10)-(1.31)."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vector3, vectors3, whole
from ir50p_lab.modelling.kernel import NOT_FINITE, evaluate, kernel, warn_of_degrees

_COS_ALPHA = (0.0, 1.0, 0.0)  # of the twists of Table 1.1, exact where cos(pi/2) in floating point is 6e-17
_SIN_ALPHA = (1.0, 0.0, -1.0)


def dh_matrix(theta, d, a, alpha):
    """Return one Denavit-Hartenberg step A = Rot_z(theta) Trans_z(d) Trans_x(a) Rot_x(alpha)    (1.23)-(1.29)

    theta turns about the old z axis (the thesis's text under (1.21) says x), alpha about the new x axis.

    Args: theta, alpha: rad; d, a: m; scalars, or arrays of one shape (n,).
    Returns: (4, 4) or (n, 4, 4); it takes coordinates of frame i to frame i-1.
    """
    return _step(theta, d, a, np.cos(alpha), np.sin(alpha))


def _step(theta, d, a, cos_alpha, sin_alpha):
    c, s = np.cos(theta), np.sin(theta)
    A = np.zeros((*np.broadcast_shapes(*map(np.shape, (c, d, a, cos_alpha))), 4, 4))
    A[..., 0, 0], A[..., 0, 1], A[..., 0, 2], A[..., 0, 3] = c, -s * cos_alpha, s * sin_alpha, a * c
    A[..., 1, 0], A[..., 1, 1], A[..., 1, 2], A[..., 1, 3] = s, c * cos_alpha, -c * sin_alpha, a * s
    A[..., 2, 1], A[..., 2, 2], A[..., 2, 3] = sin_alpha, cos_alpha, d
    A[..., 3, 3] = 1.0
    return A


def lengths(arm):
    """Return l1, l2, l3 as an array (3,) m. Raises InputError if `arm` is not an Arm."""
    try:
        return arm.lengths
    except AttributeError:
        raise InputError(f"arm = {arm!r:.60}: give an Arm, such as load_arm(), not a {type(arm).__name__}") from None


def dh_table(arm, q):
    """Return Table 1.1 (header corrected) at the pose q: for each joint one row theta, d, a, alpha.

    Args: arm: Arm; q: (3,) rad. Returns: (3, 4), columns in rad, m, m, rad.
    """
    l1, l2, l3 = lengths(arm)
    return np.column_stack([vector3("q", q), (l1, 0.0, 0.0), (0.0, l2, l3), (np.pi / 2, 0.0, -np.pi / 2)])


def frames(arm, q):
    """Return all frames of the arm in base coordinates: T^0_0 = I, T^0_1, T^0_2, T^0_3    (1.11 corrected), (1.15)

    Args: arm: Arm; q: (3,) or (n, 3) rad.
    Returns: (4, 4, 4) or (n, 4, 4, 4); element i takes coordinates of frame i to the base.

    >>> from ir50p_lab.modelling import IR50P, frames
    >>> frames(IR50P, [0, 0, 0])[3].round(3) + 0.0
    array([[1.   , 0.   , 0.   , 0.572],
           [0.   , 1.   , 0.   , 0.   ],
           [0.   , 0.   , 1.   , 0.285],
           [0.   , 0.   , 0.   , 1.   ]])
    """
    l1, l2, l3 = lengths(arm)
    q = vectors3("q", q)
    warn_of_degrees(arm, q)
    T = np.empty((*q.shape[:-1], 4, 4, 4))
    T[..., 0, :, :] = np.eye(4)
    for i, (d, a) in enumerate(((l1, 0.0), (0.0, l2), (0.0, l3))):
        T[..., i + 1, :, :] = T[..., i, :, :] @ _step(q[..., i], d, a, _COS_ALPHA[i], _SIN_ALPHA[i])
    return T


def transform(arm, q, i, j):
    """Return T^i_j, which takes coordinates of frame j to frame i    (1.11)-(1.13) corrected

    i and j are 0 to 3, in any order.
    T^i_j = A_{i+1} ... A_j for i < j (the thesis stops one matrix early), I for i = j, and the inverse of
    T^j_i for i > j (the thesis writes the matrix as the inverse of itself).

    Args: arm: Arm; q: (3,) or (n, 3) rad. Returns: (4, 4) or (n, 4, 4).
    """
    i, j = whole("frame i", i, 0, 3), whole("frame j", j, 0, 3)
    T = frames(arm, q)
    return np.linalg.solve(T[..., i, :, :], T[..., j, :, :])


@kernel("(n),(n)->(n)")
def _tip(l, q, p):
    radial = l[1] * np.cos(q[1]) + l[2] * np.cos(q[1] + q[2])
    p[0], p[1] = radial * np.cos(q[0]), radial * np.sin(q[0])
    p[2] = l[0] + l[1] * np.sin(q[1]) + l[2] * np.sin(q[1] + q[2])
    if not np.isfinite(p[0] + p[1] + p[2]):
        raise InputError(NOT_FINITE)


def forward_kinematics(arm, q):
    """Return the position of the tip in base coordinates, the last column of (1.31 corrected).

    p = [c1 (l2 c2 + l3 c23), s1 (l2 c2 + l3 c23), l1 + l2 s2 + l3 s23]

    Args: arm: Arm; q: (3,) or (n, 3) rad.
    Returns: (3,) or (n, 3) m. The orientation is `frames(arm, q)[..., 3, :3, :3]`.

    >>> from ir50p_lab.modelling import IR50P, forward_kinematics
    >>> forward_kinematics(IR50P, [0, 0.8, -1.2]).round(3)
    array([0.482, 0.   , 0.284])
    """
    p = evaluate(_tip, (lengths(arm),), q=q)
    warn_of_degrees(arm, q)
    return p
