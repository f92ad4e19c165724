"""What random scenes have and no notebook draws: boxes, windows, table tops, a webcam's mosaic, sharpening, colours."""

from dataclasses import dataclass

import cv2
import numpy as np

from ir50p_lab.vision.rendering.colours import to_bytes
from ir50p_lab.vision.rendering.light import smooth
from ir50p_lab.vision.rendering.scene import Lamp, Sensor, SolidThing, Sun
from ir50p_lab.vision.rendering.surface import noise


@dataclass(frozen=True, kw_only=True)
class Box(SolidThing):
    """A box (book, carton, card): middle T_world_box (4, 4), size (3,) m, colour."""

    T_world_box: np.ndarray
    size: tuple = (0.06, 0.04, 0.03)
    colour: str | tuple = "brown"

    def shape(self, T_cam_world):
        return BoxShape(T_cam_world @ self.T_world_box, self.size)

    def dim_sky(self, open_sky, X, Y):
        _beside_wall(open_sky, self._corners(), X, Y)

    def shade(self, part, source, softness, X, Y):
        _hull_shadow(part, self._corners(), source, softness, X, Y)

    def _corners(self):
        return BoxShape(np.asarray(self.T_world_box, dtype=float), self.size).bounds()


class BoxShape:
    """A box: T_cam_box (4, 4), size (3,)."""

    def __init__(self, T_cam_box, size):
        self.R, self.t, self.half = T_cam_box[:3, :3], T_cam_box[:3, 3], np.asarray(size, dtype=float) / 2

    def bounds(self):
        """Its corners (8, 3)."""
        signs = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1)
        return (self.R @ (signs * self.half[:, None])).T + self.t

    def depth(self, rays):
        """Depth Z of the first hit, inf where there is none."""
        origin = -self.R.T @ self.t
        enter = np.full(rays.x.shape, -np.inf, dtype=rays.x.dtype)
        leave = np.full(rays.x.shape, np.inf, dtype=rays.x.dtype)
        with np.errstate(divide="ignore", invalid="ignore"):
            for i in range(3):
                d = rays.x * self.R[0, i] + rays.y * self.R[1, i] + self.R[2, i]
                t1, t2 = (-self.half[i] - origin[i]) / d, (self.half[i] - origin[i]) / d
                enter = np.maximum(enter, np.minimum(t1, t2))
                leave = np.minimum(leave, np.maximum(t1, t2))
            return np.where((enter < leave) & (enter > 0), enter, np.inf).astype(rays.x.dtype)

    def normal(self, X):
        """Normals (3, n) at the points X (3, n)."""
        local = self.R.T @ (X - self.t[:, None]) / self.half[:, None]
        face = np.argmax(np.abs(local), axis=0)
        sign = np.sign(np.take_along_axis(local, face[None], axis=0)[0])
        return self.R[:, face] * sign

    def faces(self, X):
        """Number 0..5 of the face at X (3, n), so that edges between faces are seen."""
        local = self.R.T @ (X - self.t[:, None]) / self.half[:, None]
        face = np.argmax(np.abs(local), axis=0)
        return 2 * face + (np.take_along_axis(local, face[None], axis=0)[0] > 0)


def _beside_wall(open_sky, corners, X, Y):
    """The part of the sky that a wall of height H hides at distance d: (1 - d / sqrt(d^2 + H^2)) / 2."""
    height, bottom = corners[:, 2].max(), corners[:, 2].min()
    if height < 1e-3 or bottom > 0.5 * height:
        return
    near, distance = _outside(corners[:, :2], 4 * height, X, Y)
    d = np.maximum(distance, 0)
    open_sky[near] *= 1 - 0.5 * (1 - d / np.hypot(d, height))


def _hull_shadow(part, corners, source, softness, X, Y):
    """Shadow of the corners (n, 3) m of something without hollows: the hull of their shadows, rim by its height."""
    if corners[:, 2].max() < 1e-3:
        return
    above = np.maximum(corners, (-np.inf, -np.inf, 0.0))
    if isinstance(source, Lamp):
        towards = np.asarray(source.position, dtype=float) - above
    else:
        towards = np.broadcast_to(np.asarray(source.towards, dtype=float), above.shape)
    if (towards[:, 2] <= 1e-3).any():  # a lamp lower than the thing: a shadow without end, left out
        return
    foot = above[:, :2] - towards[:, :2] * (above[:, 2] / towards[:, 2])[:, None]
    half = max(softness * above[:, 2].mean(), 2e-4)
    near, distance = _outside(foot, half, X, Y)
    part[near] *= smooth(0.5 + distance / (2 * half))


def _outside(points, margin, X, Y):
    """Index of the X, Y (n,) near the hull of points (m, 2), and their distance outside it (negative inside)."""
    hull = cv2.convexHull(points.astype(np.float32))[:, 0].astype(float)
    low, high = hull.min(axis=0) - margin, hull.max(axis=0) + margin
    near = np.flatnonzero((X > low[0]) & (X < high[0]) & (Y > low[1]) & (Y < high[1]))
    x, y = X[near], Y[near]
    distance = np.full(len(near), -np.inf)
    edges = np.roll(hull, -1, axis=0) - hull
    turn = np.sign(np.sum(hull[:, 0] * np.roll(hull[:, 1], -1) - hull[:, 1] * np.roll(hull[:, 0], -1)))
    for start, edge in zip(hull, edges, strict=True):
        length = np.hypot(*edge)
        if length > 1e-9:
            outward = turn * np.array([edge[1], -edge[0]]) / length
            distance = np.maximum(distance, (x - start[0]) * outward[0] + (y - start[1]) * outward[1])
    return near, distance


@dataclass(frozen=True, kw_only=True)
class WindowSun(Sun):
    """edge: None, or (angle, offset m, width m): light only on one side of a line on the table, as beside a window."""

    edge: tuple | None = None

    def strength_at(self, X):
        if self.edge is None:
            return self.strength
        angle, offset, width = self.edge
        along = (np.cos(angle) * X[0] + np.sin(angle) * X[1] - offset) / width
        return self.strength * smooth(along + 0.5)


def cloth(table, u, v, seed):
    return 0.5 * noise("rough", seed, 40 * u, 40 * v) + 0.5 * noise("soft", seed, 12 * u, 12 * v), None


def speckle(table, u, v, seed):
    return noise("rough", seed, 30 * u, 30 * v), None


def tiles(table, u, v, seed):
    """Four grains wide, with joints between them."""
    joint = (np.mod(u / 4, 1) < 0.03) | (np.mod(v / 4, 1) < 0.03)
    return 0.3 * noise("rough", seed, 20 * u, 20 * v), np.where(joint, 1 - 0.6 * table.contrast, 1)


TEXTURES = {"plain": "plain", "wood": "wood", "cloth": cloth, "speckle": speckle, "tiles": tiles}


@dataclass(frozen=True, kw_only=True)
class WebcamSensor(Sensor):
    """mosaic: one colour per pixel, filled in by interpolation; sharpen: strength of an unsharp mask; saturation: of
    colours, 1 as they are."""

    mosaic: bool = False
    sharpen: float = 0.0
    saturation: float = 1.0

    def developed(self, light):
        if self.mosaic:
            light = mosaic(light)
        light = light * np.asarray(self.balance, dtype=np.float32)
        if self.saturation != 1:
            grey = light @ np.array([0.2126, 0.7152, 0.0722], dtype=np.float32)
            light = grey[..., None] + np.float32(self.saturation) * (light - grey[..., None])
        image = to_bytes(light, self.gamma)
        return sharpen(image, self.sharpen) if self.sharpen > 0 else image


def mosaic(light):
    """Light (h, w, 3) of which each pixel keeps one colour (red green / green blue), the others filled in from around.

    Bilinear, by one filter per colour: green from 4 neighbours, red and blue from 2 or 4; no shift.
    """
    cross = np.array([[0, 1, 0], [1, 4, 1], [0, 1, 0]], dtype=np.float32) / 4
    square = np.array([[1, 2, 1], [2, 4, 2], [1, 2, 1]], dtype=np.float32) / 4
    filled = np.empty_like(light)
    for channel, sites in enumerate((((0, 0),), ((0, 1), (1, 0)), ((1, 1),))):
        kept = np.zeros(light.shape[:2], dtype=np.float32)
        for i, j in sites:
            kept[i::2, j::2] = light[i::2, j::2, channel]
        kernel = cross if channel == 1 else square
        filled[..., channel] = cv2.filter2D(kept, -1, kernel, borderType=cv2.BORDER_REFLECT_101)
    return filled


def sharpen(image, strength):
    """The picture with an unsharp mask, as webcams do: plus `strength` times what a blur of 1.2 pixels takes away."""
    soft = cv2.GaussianBlur(image, (0, 0), 1.2)
    return cv2.addWeighted(image, 1 + strength, soft, -strength, 0)
