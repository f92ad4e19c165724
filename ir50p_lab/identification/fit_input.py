"""What `fit` and `RLS` are given, checked: each refusal names the value, the limit and the remedy."""

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.inputs import first_not_finite, numbers, vectors3, whole


def checked_data(Phi, y, every=1):
    """Phi (n, 3, 20) and y (n, 3) as float arrays, each `every`-th sample. Raises InputError."""
    whole("every", every, 1, 10**9)
    Phi, y = blocks("Phi", Phi), vectors3("y", y, unit="PWM or N m")
    if y.shape != Phi.shape[:2]:
        raise InputError(f"y has shape {y.shape}, Phi {Phi.shape}; give y (n, 3) with a row for each of Phi's")
    return Phi[::every], y[::every]


def blocks(name, value):
    """`value` as a float array (n, 3, 20), all finite. Raises InputError naming `name`."""
    array = numbers(name, value, unit="(n, 3, 20)")
    if array.ndim != 3 or array.shape[1:] != (3, 20) or not len(array):
        raise InputError(f"{name} has shape {array.shape}; give (n, 3, 20), n >= 1, as regressor(q, qd, qdd) returns")
    # a sum is finite unless a number is not (or huge): much faster than looking at each
    if not np.isfinite(array.sum()) and not np.isfinite(array).all():
        raise InputError(f"{name} holds {first_not_finite(array)}: remove or repair that sample")
    return array


def checked_weights(weights, n, every):
    """Weights (n, 3) after decimation, from (3,) or (n, 3). Raises InputError."""
    weights = vectors3("weights", weights, unit="1/unit^2")
    if weights.ndim == 2:
        weights = weights[::every]
    if weights.shape not in ((3,), (n, 3)) or (weights < 0).any():
        raise InputError(
            f"weights have shape {weights.shape} and least value {weights.min():g}; "
            "give (3,) or (n, 3), all >= 0: 1/variance of each measurement"
        )
    return np.broadcast_to(weights, (n, 3))


def checked_use(use, n, every):
    """Which samples count, (n, 3) bool, after decimation. Raises InputError, IdentificationError."""
    use = np.asarray(use)
    if use.dtype != bool or use.ndim != 2 or use.shape[1] != 3 or len(use[::every]) != n:
        raise InputError(f"use has shape {use.shape}, type {use.dtype}: give (n, 3) of True and False, as Motion.use")
    use = use[::every]
    if use.sum(axis=0).min() < 40:
        raise IdentificationError(
            f"only {use.sum(axis=0).tolist()} samples of the joints are to be used; give 40 or more of each: record "
            "longer or faster motion, or leave out fewer near standstill"
        )
    return use


def checked_instruments(instruments, shape, every):
    """Instruments (n, 3, 20) after decimation. Raises InputError."""
    if instruments is None:
        raise InputError(
            "method='iv' needs instruments (n, 3, 20): the regressor of a signal that moves as the arm does but has "
            "other noise: the reference, a simulation, a repeated run"
        )
    Z = blocks("instruments", instruments)[::every]
    if Z.shape != shape:
        raise InputError(f"instruments have {len(Z)} samples, Phi has {shape[0]}: one for each")
    return Z
