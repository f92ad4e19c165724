"""Position and orientation: rotation matrices, homogeneous transforms.

A rotation matrix ``R_A_B`` holds the axes of frame B, as columns, in coordinates of frame A; a homogeneous
transform ``T_A_B`` takes coordinates of a point in B to coordinates in A (thesis 1.1). Angles are in rad.
Every function is vectorised: leading dimensions ``...`` are kept.

SciPy does the rotations. It takes half a second to import, so it is imported on first use.
"""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers, vectors3

_ROUNDING = 1e-6  # largest entry of R^T R - I, and of det R - 1, that still counts as rounding


def rot_x(angle):
    """Rotation about x by `angle` (...) rad, (1.4): (...,3,3). Raises InputError for NaN or infinity."""
    return _elementary("X", angle)


def rot_y(angle):
    """Rotation about y by `angle` (...) rad, (1.5) corrected: (...,3,3). Raises InputError for NaN or infinity.

    The thesis prints the transposed matrix, which turns the other way: +sin belongs in row 1, column 3,
    so that a quarter turn takes z to x.
    """
    return _elementary("Y", angle)


def rot_z(angle):
    """Rotation about z by `angle` (...) rad, (1.6): (...,3,3). Raises InputError for NaN or infinity.

    >>> import numpy as np
    >>> from ir50p_lab.modelling import rot_z
    >>> rot_z(np.pi / 2).round(3)
    array([[ 0., -1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0.,  1.]])
    """
    return _elementary("Z", angle)


def homogeneous(R=None, t=None):
    """Homogeneous transform T = [[R, t], [0, 1]], (1.8).

    R: (...,3,3) rotation, default identity; t: (...,3) m, origin of the new frame, default zero. Leading
    dimensions are broadcast. Returns T (...,4,4). Raises InputError if R is not a rotation or t is not (...,3).
    """
    R = np.eye(3) if R is None else check_rotation(R)
    t = np.zeros(3) if t is None else vectors3("t", t, unit="m")
    T = np.zeros((*np.broadcast_shapes(R.shape[:-2], t.shape[:-1]), 4, 4))
    T[..., :3, :3] = R
    T[..., :3, 3] = t
    T[..., 3, 3] = 1
    return T


def check_rotation(R):
    """Return R as an array of floats if it is a rotation: R^T R = I and det R = +1, within 1e-6.

    R: (...,3,3). Raises InputError that says by how much R fails.
    """
    R = numbers("R", R, unit="1")
    if R.shape[-2:] != (3, 3) or not np.isfinite(R).all():
        raise InputError(f"R has shape {R.shape}; give (..., 3, 3), all finite")
    defect = np.abs(np.swapaxes(R, -1, -2) @ R - np.eye(3)).max(axis=(-1, -2))
    determinant = np.linalg.det(R)
    wrong = (defect > _ROUNDING) | (np.abs(determinant - 1) > _ROUNDING)
    if wrong.any():
        raise InputError(
            f"R is not a rotation: the largest entry of R^T R - I is {defect[wrong][0]:.3g} and det R is "
            f"{determinant[wrong][0]:.6g} (wanted 0 and 1). Its columns must be orthogonal unit vectors, right-handed: "
            "check the signs and the order of the entries; det R = -1 is a reflection"
        )
    return R


def _elementary(letter, angle):
    from scipy.spatial.transform import Rotation

    angle = numbers("angle", angle, unit="rad")
    if not np.isfinite(angle).all():
        raise InputError(f"angle = {angle} holds NaN or infinity; check where it comes from")
    return Rotation.from_euler(letter, angle.reshape(-1, 1)).as_matrix().reshape(*angle.shape, 3, 3)
