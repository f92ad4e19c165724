"""Shadows on the table: how much of each light the things on the table leave to a point."""

import numpy as np

from ir50p_lab.vision.rendering.light import direction, smooth
from ir50p_lab.vision.rendering.scene import Lamp, SceneBall, Sky, SolidThing, Stick


def table_light(scene, X, Y):
    """Light (n, 3) on the table at X, Y (n,) m: every light, less what the things keep from it."""
    light = np.zeros((len(X), 3), dtype=np.float32)
    P = np.stack([X, Y, np.zeros_like(X)])
    balls = [thing for thing in scene.objects if isinstance(thing, SceneBall)]
    sticks = [thing for thing in (*scene.objects, *scene.arm) if isinstance(thing, Stick)]
    solids = [thing for thing in scene.objects if isinstance(thing, SolidThing)]
    for source in scene.lights:
        colour = np.asarray(source.colour, dtype=np.float32)
        if isinstance(source, Sky):
            open_sky = np.ones(len(X), dtype=np.float32)
            for ball in balls:
                _under_ball(open_sky, ball, X, Y)
            for stick in sticks:
                _under_stick(open_sky, stick, X, Y)
            for solid in solids:
                solid.dim_sky(open_sky, X, Y)
            light += (source.strength * open_sky)[:, None] * colour
            continue
        towards, strength, softness = direction(source, P)
        part = np.broadcast_to(strength * towards[2], X.shape).astype(np.float32)
        for ball in balls:
            _ball_shadow(part, ball, source, softness, X, Y)
        for stick in sticks:
            _stick_shadow(part, stick, source, softness, X, Y)
        for solid in solids:
            solid.shade(part, source, softness, X, Y)
        light += part[:, None] * colour
    return light


def _under_ball(open_sky, ball, X, Y):
    """The part of the sky that a ball hides from a point of the table: h r^2 / D^3, D the distance to its centre."""
    x, y, h = ball.position
    near = np.flatnonzero((np.abs(X - x) < 6 * ball.radius) & (np.abs(Y - y) < 6 * ball.radius))
    D2 = (X[near] - x) ** 2 + (Y[near] - y) ** 2 + h * h
    open_sky[near] *= 1 - np.minimum(max(h, 0) * ball.radius**2 / D2**1.5, 1)


def _under_stick(open_sky, stick, X, Y):
    """The part of the sky that a long cylinder hides: h r / D^2, D the distance to its axis."""
    a, b = np.asarray(stick.start, dtype=float), np.asarray(stick.end, dtype=float)
    if min(a[2], b[2]) > 8 * stick.radius:
        return
    far = 6 * stick.radius
    low, high = np.minimum(a, b) - far, np.maximum(a, b) + far
    near = np.flatnonzero((X > low[0]) & (X < high[0]) & (Y > low[1]) & (Y < high[1]))
    P = np.stack([X[near], Y[near], np.zeros(len(near), dtype=X.dtype)])
    axis = b - a
    w = np.clip(axis @ (P - a[:, None]) / max(axis @ axis, 1e-12), 0, 1)
    nearest = a[:, None] + axis[:, None] * w
    D2 = np.maximum(np.sum((nearest - P) ** 2, axis=0), stick.radius**2)
    open_sky[near] *= 1 - np.clip(nearest[2] * stick.radius / D2, 0, 1)


def _ball_shadow(part, ball, source, softness, X, Y):
    near = _near_shadow([ball.position], ball.radius, source, softness, X, Y)
    L, _, _ = direction(source, np.stack([X[near], Y[near], np.zeros(len(near), dtype=X.dtype)]))
    x, y, h = ball.position
    v = np.stack([x - X[near], y - Y[near], np.full(len(near), h, dtype=X.dtype)])
    along = np.sum(v * L, axis=0)
    distance = np.sqrt(np.maximum(np.sum(v * v, axis=0) - along * along, 0))
    half = np.maximum(softness * along, 1e-4)
    part[near] *= np.where(along > 0, smooth(0.5 + (distance - ball.radius) / (2 * half)), 1)


def _stick_shadow(part, stick, source, softness, X, Y):
    a, b = np.asarray(stick.start, dtype=float), np.asarray(stick.end, dtype=float)
    near = _near_shadow([a, b], stick.radius, source, softness, X, Y)
    P = np.stack([X[near], Y[near], np.zeros(len(near), dtype=X.dtype)])
    L, _, _ = direction(source, P)
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
    part[near] *= np.where(along > 0, smooth(0.5 + (distance - stick.radius) / (2 * half)), 1)


def _near_shadow(points, radius, source, softness, X, Y):
    """Index of the table points that the shadow of spheres at `points` may reach."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for p in np.asarray(points, dtype=float):
        L = np.asarray(source.position) - p if isinstance(source, Lamp) else np.asarray(source.towards, dtype=float)
        if L[2] <= radius:  # a lamp as low as the thing: its shadow has no end
            return np.arange(len(X))
        foot = p[:2] - L[:2] / L[2] * max(p[2], 0)
        stretch = 1 + np.hypot(L[0], L[1]) / L[2]
        if isinstance(source, Lamp):
            stretch *= 1.5 * (1 + max(p[2], 0) / L[2])
        half = (radius + softness * (abs(p[2]) + radius) * stretch * 2) * stretch
        low, high = np.minimum(low, foot - half), np.maximum(high, foot + half)
    return np.flatnonzero((X >= low[0]) & (X <= high[0]) & (Y >= low[1]) & (Y <= high[1]))
