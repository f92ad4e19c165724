"""Checks of the arguments of public functions in this folder; private code trusts its callers."""

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.inputs import first_not_finite, numbers


def coordinates(name, value, n, unit="px"):
    """Return `value` as finite floats of shape (..., n). Raises InputError."""
    array = numbers(name, value, unit=unit)
    if array.ndim == 0 or array.shape[-1] != n:
        raise InputError(f"{name} has shape {array.shape}: give shape ({n},) or (..., {n}) ({unit})")
    if not np.isfinite(array).all():
        raise InputError(f"{name} holds {first_not_finite(array)}: every number must be finite ({unit})")
    return array


def point_list(name, value, n, unit="px"):
    """Return `value` as a list of points (m, n), from one point (n,), from (m, n), or from (m, 1, n) as in OpenCV."""
    array = coordinates(name, value, n, unit)
    if array.ndim > 2 and array.shape[1:] != (1, n):
        raise InputError(f"{name} has shape {array.shape}: give (n, {n}) ({unit})")
    return np.ascontiguousarray(array.reshape(-1, n))


def rigid(name, T):
    """Return `T` as a (4, 4) float array. Raises InputError unless it is a rotation and a translation."""
    T = numbers(name, T, unit="m and a rotation")
    good = T.shape == (4, 4) and np.isfinite(T).all() and np.allclose(T[3], [0, 0, 0, 1], rtol=0, atol=1e-9)
    if not good or np.abs(T[:3, :3] @ T[:3, :3].T - np.eye(3)).max() > 1e-6 or np.linalg.det(T[:3, :3]) < 0:
        raise InputError(
            f"{name} is not a rigid transform: give (4, 4) with a rotation, a translation in m and 0 0 0 1 below (for "
            "points in rows, as MATLAB has them, give the transpose)"
        )
    return T


def picture_size(size):
    """Return (width, height) as whole numbers of pixels. Raises InputError."""
    array = numbers("size = (width, height)", size, unit="whole pixels")
    if array.shape != (2,) or not (array >= 1).all() or (array != np.round(array)).any():
        raise InputError(f"size = {size!r}: give (width, height) of the picture as whole pixels, at least 1")
    return int(array[0]), int(array[1])


def check_picture_size(camera, size):
    """Raise CalibrationError if a picture of this size, (width, height), does not fit the Calibration or Pinhole."""
    if tuple(size) != tuple(camera.size):
        sizes = "{}x{}, not {}x{}".format(*camera.size, *size)
        remedy = "set the camera to that size, or calibrate it at the new one"
        raise CalibrationError(f"this calibration is of a camera with pictures of {sizes}: {remedy}")
