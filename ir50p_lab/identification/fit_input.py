"""What `fit` is given, checked: each refusal names the value, the limit and the remedy."""

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.inputs import choice, first_not_finite, number, numbers, vectors3

METHODS = ("ls", "weighted", "huber", "ridge", "bounded", "iv")


def checked_data(Phi, y, every):
    """Phi (n, 3, 20) and y (n, 3) as float arrays, each `every`-th sample. Raises InputError."""
    if isinstance(every, bool) or not isinstance(every, (int, np.integer)) or every < 1:
        raise InputError(f"every = {every!r:.60}: a whole number of samples >= 1")
    Phi, y = blocks("Phi", Phi), vectors3("y", y, unit="PWM or N m")
    if y.shape != Phi.shape[:2]:
        raise InputError(f"y has shape {y.shape}, Phi {Phi.shape}; give y (n, 3) with a row for each of Phi's")
    return Phi[:: int(every)], y[:: int(every)]


def blocks(name, value):
    """`value` as a float array (n, 3, 20), all finite. Raises InputError naming `name`."""
    array = numbers(name, value, unit="(n, 3, 20)")
    if array.ndim != 3 or array.shape[1:] != (3, 20) or not len(array):
        raise InputError(f"{name} has shape {array.shape}; give (n, 3, 20), n >= 1, as regressor(q, qd, qdd) returns")
    # a sum is finite unless a number is not (or huge): much faster than looking at each
    if not np.isfinite(array.sum()) and not np.isfinite(array).all():
        raise InputError(f"{name} holds {first_not_finite(array)}: remove or repair that sample")
    return array


def checked_options(method, rows, errors, l2, threshold, strength):
    """Raises InputError for an option out of its range."""
    for name, value, choices in (
        ("method", method, METHODS),
        ("rows", rows, ("joint", "shared")),
        ("errors", errors, ("hac", "classical")),
    ):
        choice(name, value, choices)
    for name, value, unit in (("l2", l2, "m"), ("threshold", threshold, ""), ("strength", strength, "")):
        if value is not None:
            number(name, value, "> 0", unit=unit)
    if l2 is not None and l2 > 10:
        raise InputError(f"l2 = {l2} m is longer than 10 m: is it in millimetres? Give metres")


def checked_weights(weights, n, every):
    """Weights (n, 3) after decimation, from (3,) or (n, 3). Raises InputError."""
    weights = vectors3("weights", weights, unit="1/unit^2")
    if weights.ndim == 2:
        weights = weights[:: int(every)]
    if weights.shape not in ((3,), (n, 3)) or (weights < 0).any():
        raise InputError(
            f"weights have shape {weights.shape} and least value {weights.min():g}; "
            "give (3,) or (n, 3), all >= 0: 1/variance of each measurement"
        )
    return np.broadcast_to(weights, (n, 3))


def checked_use(use, n, every):
    """Which samples count, (n, 3) bool, after decimation. Raises InputError."""
    try:
        use = np.asarray(use)
    except ValueError:
        raise InputError("use has rows of different length: give (n, 3) of True and False, as Motion.use") from None
    if use.dtype != bool or use.ndim != 2 or use.shape[1] != 3 or len(use[:: int(every)]) != n:
        raise InputError(f"use has shape {use.shape}, type {use.dtype}: give (n, 3) of True and False, as Motion.use")
    use = use[:: int(every)]
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
    Z = blocks("instruments", instruments)[:: int(every)]
    if Z.shape != shape:
        raise InputError(f"instruments have {len(Z)} samples, Phi has {shape[0]}: one for each")
    return Z
