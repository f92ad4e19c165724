"""Shadows on the table: how much of the light a ball or a stick leaves to a point, soft as the source is wide."""

import numpy as np


def smooth(x):
    """0 for x <= 0, 1 for x >= 1, with a smooth step between."""
    x = np.clip(x, 0, 1)
    return x * x * (3 - 2 * x)


def dim_sky(open_sky, a, b, radius, X, Y):
    """Take off `open_sky` (n,), in place, what a stick with round ends a, b (3,) m hides of the sky from X, Y (n,).

    Of a cylinder h r / D^2, D the distance to its axis at height h; of a ball, a stick of no length, h r^2 / D^3.
    """
    if min(a[2], b[2]) > 8 * radius:
        return
    low, high = np.minimum(a, b) - 6 * radius, np.maximum(a, b) + 6 * radius
    near = np.flatnonzero((X > low[0]) & (X < high[0]) & (Y > low[1]) & (Y < high[1]))
    P = np.stack([X[near], Y[near], np.zeros(len(near), dtype=X.dtype)])
    axis = b - a
    w = np.clip(axis @ (P - a[:, None]) / max(axis @ axis, 1e-12), 0, 1)
    nearest = a[:, None] + axis[:, None] * w
    D = np.sqrt(np.maximum(np.sum((nearest - P) ** 2, axis=0), radius**2))
    hidden = nearest[2] * radius / D**2 if axis.any() else nearest[2] * radius**2 / D**3
    open_sky[near] *= 1 - np.clip(hidden, 0, 1)


def shadow(part, a, b, radius, source, softness, X, Y):
    """Take off `part` (n,) of a Sun or Lamp, in place, what a stick with round ends a, b (3,) m keeps from X, Y (n,).

    A ball is a stick of no length.
    """
    near = _near_shadow((a, b), radius, source, softness, X, Y)
    P = np.stack([X[near], Y[near], np.zeros(len(near), dtype=X.dtype)])
    L, _, _ = source.direction(P)
    L = np.broadcast_to(L, P.shape)
    # closest approach of the line P + s L and the segment a + w (b - a)
    axis, v = (b - a)[:, None], P - a[:, None]
    aa, al = float((b - a) @ (b - a)), np.sum(axis * L, axis=0)
    av, lv = np.sum(axis * v, axis=0), np.sum(L * v, axis=0)
    w = np.clip((av - al * lv) / np.maximum(aa - al * al, 1e-12), 0, 1)
    nearest = a[:, None] + axis * w - P
    along = np.sum(nearest * L, axis=0)
    distance = np.sqrt(np.maximum(np.sum(nearest * nearest, axis=0) - along * along, 0))
    half = np.maximum(softness * np.abs(along), 1e-4)
    part[near] *= np.where(along > 0, smooth(0.5 + (distance - radius) / (2 * half)), 1)


def _near_shadow(points, radius, source, softness, X, Y):
    """Index of the table points that the shadow of spheres at `points` may reach."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for p in np.asarray(points, dtype=float):
        L = source.seen_from(p)
        if L[2] <= radius:  # a lamp as low as the thing: its shadow has no end
            return np.arange(len(X))
        foot = p[:2] - L[:2] / L[2] * max(p[2], 0)
        stretch = 1.5 * (1 + np.hypot(L[0], L[1]) / L[2]) * (1 + max(p[2], 0) / L[2])
        half = (radius + softness * (abs(p[2]) + radius) * stretch * 2) * stretch
        low, high = np.minimum(low, foot - half), np.maximum(high, foot + half)
    return np.flatnonzero((X >= low[0]) & (X <= high[0]) & (Y >= low[1]) & (Y <= high[1]))
