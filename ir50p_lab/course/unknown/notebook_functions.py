"""Functions of 19 that stay in its notebook, the course's, and helpers that the notebook has."""

import numpy as np

from ir50p_lab.course.at_the_bench.functions.low_pass import low_pass
from ir50p_lab.course.camera.functions.homography import homography
from ir50p_lab.course.fitting.functions.least_squares import least_squares
from ir50p_lab.course.fitting.functions.regressor import regressor
from ir50p_lab.course.motion.functions.quintic import quintic

_HZ = 2.0  # of the filter before a fit
_PULL = 1e-3 / 100  # of a column's size, for each root of a row


def both_ways(x, low_pass=low_pass):
    """A signal (n,) low-passed at 2 Hz forwards and backwards, so that it is late by nothing."""
    return low_pass(low_pass(x, _HZ, 100)[::-1], _HZ, 100)[::-1]


def with_a_pull(A, y):
    """A (n, k) and y (n,) with k rows more, which pull each number weakly to zero: what no row tells stays small."""
    pull = np.diag(np.linalg.norm(A, axis=0)) * _PULL * np.sqrt(len(y))
    return np.vstack([A, pull]), np.concatenate([y, np.zeros(len(pull))])


def acted(u, delay):
    """The counts (n, 3) that act in each period, of those (n, 3) that were sent in it; delay: s."""
    late = round(delay / 0.01)
    return np.vstack([np.zeros((late, 3)), u])[: len(u)]


def fit_joint(Y, y, use):
    """The numbers (k,) of one joint, from columns (n, k) and counts (n,), filtered alike, at the rows to use (n,)."""
    A = np.apply_along_axis(both_ways, 0, Y)[use]
    theta, _ = least_squares(*with_a_pull(A, both_ways(y)[use]))
    return theta


def most_counts(theta, a, b, seconds):
    """The largest push, counts, that a theta (3, 20) asks for on the quintic from a to b."""
    most = 0
    for t in np.linspace(0, seconds, 15):
        q, qd, qdd = quintic(a, b, seconds, t)
        counts = np.sum(regressor(q, qd, qdd, np.tanh(qd / 0.05)) * theta, axis=1)
        most = max(most, np.max(np.abs(counts)))
    return most


def when_it_acts(off, off_rate, delay):
    """How far the joints will be off, and how fast they drift, when a command of now acts: at a steady drift."""
    return off + delay * off_rate, off_rate


def camera_at(K, corners, points):
    """T_base_cam (4, 4) from the pixels (4, 2) of four places (4, 3) m of the table."""
    to_pixels = np.linalg.solve(homography(corners, points[:, :2]), np.eye(3))
    G = np.linalg.solve(K, to_pixels)
    G = G / np.linalg.norm(G[:, 0]) * np.sign(G[2, 2])
    R = np.column_stack([G[:, 0], G[:, 1], np.cross(G[:, 0], G[:, 1])])
    U, _, Vt = np.linalg.svd(R)
    T = np.eye(4)
    T[:3, :3] = (U @ Vt).T
    T[:3, 3] = -T[:3, :3] @ G[:, 2]
    return T
