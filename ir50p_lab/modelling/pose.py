"""Position and orientation: rotation matrices, the twelve angle sequences, homogeneous transforms.

A rotation matrix ``R_A_B`` holds the axes of frame B, as columns, in coordinates of frame A; a homogeneous
transform ``T_A_B`` takes coordinates of a point in B to coordinates in A (thesis 1.1). Angles are in rad.
Every function is vectorised: leading dimensions ``...`` are kept.

SciPy does the rotations. It takes half a second to import, so it is imported on first use.
"""

from collections import namedtuple

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, numbers, vectors3

EULERIAN = ("XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ")
"""Sequences that come back to their first axis (thesis 1.1.2 b)."""

CARDANIAN = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
"""Sequences that use all three axes (thesis 1.1.2 b)."""

SEQUENCES = EULERIAN + CARDANIAN
"""The twelve angle sequences. Capital letters: each turn is about an axis that has already been moved."""

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


def rotation_from_angles(sequence, angles):
    """Rotation matrix of three turns about moving axes, (1.7): R = R_1(a_1) R_2(a_2) R_3(a_3).

    sequence: one of `SEQUENCES`; "XYZ" is the R_x R_y R_z of (1.7).
    angles: (...,3) rad, in the order of the sequence.
    Returns R (...,3,3). Raises InputError for an unknown sequence, a wrong shape, NaN or infinity.
    """
    from scipy.spatial.transform import Rotation

    choice("sequence", sequence, SEQUENCES)
    angles = vectors3("angles", angles)
    R = Rotation.from_euler(sequence, angles.reshape(-1, 3)).as_matrix()
    return R.reshape(*angles.shape[:-1], 3, 3)


def angles_from_rotation(sequence, R):
    """Angles of a rotation matrix in one of the twelve sequences: the inverse of `rotation_from_angles`.

    sequence: one of `SEQUENCES`; R: (...,3,3).
    Returns angles (...,3) rad: first and third in [-pi, pi]; the middle one in [0, pi] for an Eulerian and in
    [-pi/2, pi/2] for a Cardanian sequence. Within 1e-7 rad of a singularity (see `singular_angles`) only the sum
    or the difference of first and third angle is defined; the third is then 0, and the three angles still
    give R.
    Raises InputError for an unknown sequence or if R is not a rotation.
    """
    from scipy.spatial.transform import Rotation

    choice("sequence", sequence, SEQUENCES)
    R = check_rotation(R)
    rotation = Rotation.from_matrix(R.reshape(-1, 3, 3))
    # The gimbal-lock warning of SciPy is replaced by the documented choice above and by `gimbal_lock`.
    return rotation.as_euler(sequence, suppress_warnings=True).reshape(R.shape[:-1])


def singular_angles(sequence):
    """Return the two middle angles (rad) at which a sequence loses a degree of freedom.

    (0, pi) for an Eulerian sequence, (-pi/2, pi/2) for a Cardanian one: there the third axis lies on the first.
    Raises InputError for an unknown sequence.
    """
    choice("sequence", sequence, SEQUENCES)
    return (0.0, np.pi) if sequence in EULERIAN else (-np.pi / 2, np.pi / 2)


def rate_matrix(sequence, angles):
    """Matrix E of omega = E(angles) d(angles)/dt: the three axes of rotation in the first frame, as columns.

    E = [e_1, R_1 e_2, R_1 R_2 e_3], where e_i is the unit vector of the i-th letter of the sequence.
    angles: (...,3) rad. Returns E (...,3,3), without unit.
    Raises InputError for an unknown sequence, a wrong shape, NaN or infinity.
    """
    choice("sequence", sequence, SEQUENCES)
    angles = vectors3("angles", angles)
    first, second, third = map("XYZ".index, sequence)
    R_1 = _elementary(sequence[0], angles[..., 0])
    R_12 = R_1 @ _elementary(sequence[1], angles[..., 1])
    e_1 = np.broadcast_to(np.eye(3)[first], angles.shape)
    return np.stack([e_1, R_1[..., :, second], R_12[..., :, third]], axis=-1)


class GimbalLock(namedtuple("GimbalLock", "sine gain lost_axis")):
    """How close three angles are to the singularity of their sequence, and what is lost there.

    sine: (...) sine of the angle between first and third axis, |det E|: 1 at best, 0 at the singularity.
    gain: (...) largest angle rate (norm, rad/s) that a rotation of 1 rad/s can ask for: 1 / smallest
        singular value of the rate matrix E; inf at the singularity.
    lost_axis: (...,3) unit vector in the first frame: the turn that asks for it, which no angle rate can
        make at the singularity. Its sign is of no meaning.
    """


def gimbal_lock(sequence, angles):
    """Closeness to the singularity of a sequence, from the singular values of `rate_matrix`.

    angles: (...,3) rad. Returns a `GimbalLock`.
    Raises InputError for an unknown sequence, a wrong shape, NaN or infinity.
    """
    E = rate_matrix(sequence, angles)
    left, values, _ = np.linalg.svd(E)
    smallest = values[..., -1]
    # Below this, a singular value is rounding: the svd of a singular 3x3 matrix gives about 1e-16.
    gain = np.where(smallest < 1e-15, np.inf, 1 / np.maximum(smallest, 1e-15))
    return GimbalLock(sine=np.abs(np.linalg.det(E)), gain=gain, lost_axis=left[..., :, -1])


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
