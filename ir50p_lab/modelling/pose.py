"""Position and orientation: rotation matrices.

A rotation matrix ``R_A_B`` holds the axes of frame B, as columns, in coordinates of frame A; a homogeneous
transform ``T_A_B`` takes coordinates of a point in B to coordinates in A (thesis 1.1). Angles are in rad.
Every function is vectorised: leading dimensions ``...`` are kept.

SciPy does the rotations. It takes half a second to import, so it is imported on first use.
"""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers


def rot_x(angle):
    """Return the rotation about x by `angle` (...) rad, shape (..., 3, 3)    (1.4).

    Raises InputError for NaN or infinity.
    """
    return _elementary("X", angle)


def rot_y(angle):
    """Return the rotation about y by `angle` (...) rad, shape (..., 3, 3)    (1.5) corrected.

    The thesis prints the transposed matrix, which turns the other way: +sin belongs in row 1, column 3,
    so that a quarter turn takes z to x. Raises InputError for NaN or infinity.
    """
    return _elementary("Y", angle)


def rot_z(angle):
    """Return the rotation about z by `angle` (...) rad, shape (..., 3, 3)    (1.6).

    Raises InputError for NaN or infinity.

    >>> import numpy as np
    >>> from ir50p_lab.modelling import rot_z
    >>> rot_z(np.pi / 2).round(3)
    array([[ 0., -1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0.,  1.]])
    """
    return _elementary("Z", angle)


def _elementary(letter, angle):
    from scipy.spatial.transform import Rotation

    angle = numbers("angle", angle, unit="rad")
    if not np.isfinite(angle).all():
        raise InputError(f"angle = {angle} holds NaN or infinity; check where it comes from")
    return Rotation.from_euler(letter, angle.reshape(-1, 1)).as_matrix().reshape(*angle.shape, 3, 3)
