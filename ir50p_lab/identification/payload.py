"""Absolute scale from a known payload: PWM counts say nothing about kilograms until something of known weight hangs on.

A theta in PWM counts is theta in N m divided by the unknown motor gain K of each joint. A payload of known mass changes
the parameters by known amounts in N m; what it changes them by in counts gives K.
"""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.parameters import NAMES, metres
from ir50p_lab.inputs import number

_CHANGED = ("theta2", "theta3", "theta4", "theta5", "theta6")
_SURE = 3.0  # standard errors by which the payload must show


@dataclass(frozen=True, kw_only=True, eq=False)
class Scale:
    """Motor gains K (3,) N m per count with stderr (3,), inf where the payload does not show; theta (3, 20) in SI units
    (0 in rows without K), of the arm without payload, with theta_stderr; warnings: tuple of str.
    """

    K: np.ndarray
    stderr: np.ndarray
    theta: np.ndarray
    theta_stderr: np.ndarray
    warnings: tuple


def payload_change(mass, *, l2, at):
    """What a point mass on the forearm adds to theta, (20,) in SI units.

    mass: kg; l2: upper arm, m; at: m from the elbow (the arm's l3 at the flange). Raises InputError.
    """
    mass, l2, at = number("mass", mass, "> 0", unit="kg"), metres("l2", l2), metres("at", at)
    change = dict(zip(_CHANGED, (mass * l2**2, mass * l2, mass * at, mass * at**2, mass * at * l2), strict=True))
    return np.array([change.get(name, 0.0) for name in NAMES])


def scale_from_payload(without, loaded, *, mass, l2, at):
    """Motor gains in N m per count, and theta in SI units, from two fits: without and with a known payload.

    For each joint 1/K = argmin |change of theta - change in N m/K|, weighted with the covariance of both estimates.

    Args: without, loaded: Estimate (rows="joint", unit PWM), with standard errors that hold (`fit_with_instruments`);
    mass: kg; l2: m; at: m from the elbow. Take a payload of a tenth of the forearm's mass or more.
    Returns: Scale. Raises InputError; IdentificationError if the payload shows in no joint.
    """
    change = payload_change(mass, l2=l2, at=at)
    for name, estimate in (("without", without), ("loaded", loaded)):
        if getattr(estimate, "rows", None) != "joint":
            raise InputError(f"{name} is a {type(estimate).__name__}: give an Estimate, of fit with rows='joint'")
    K, stderr, notes = np.full(3, np.nan), np.full(3, np.inf), []
    for j in range(3):
        here = np.flatnonzero(change * np.isfinite(without.stderr[j]) * np.isfinite(loaded.stderr[j]))
        if not len(here):
            continue
        moved = (loaded.theta - without.theta)[j, here]
        total = (without.covariance + loaded.covariance)[j][np.ix_(here, here)]
        weights = np.linalg.pinv(total, rcond=1e-10, hermitian=True)  # tied columns vary together
        a = change[here]
        sigma = 1 / np.sqrt(a @ weights @ a)
        per_count = sigma**2 * (a @ weights @ moved)
        if per_count < _SURE * sigma:
            notes.append(f"joint {j + 1}: payload shows by {per_count / sigma:.1f} standard errors: take a heavier one")
            continue
        K[j], stderr[j] = 1 / per_count, sigma / per_count**2
        left = moved - a * per_count
        if left @ weights @ left > 9 * np.linalg.matrix_rank(weights, hermitian=True):
            asked = f"proportions than of {mass:g} kg at {at:g} m"
            notes.append(f"joint {j + 1}: theta changes in other {asked}: check mass, place and both fits")
    if np.isnan(K).all():
        raise IdentificationError(f"a payload of {mass:g} kg does not show in any joint: {'; '.join(notes)}")
    known, unsure = np.nan_to_num(K)[:, None], np.where(np.isfinite(stderr), stderr, 0)[:, None]
    spread = np.hypot(known * without.stderr, unsure * without.theta)
    return Scale(K=K, stderr=stderr, theta=known * without.theta, theta_stderr=spread, warnings=tuple(notes))
