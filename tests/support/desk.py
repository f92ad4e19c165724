"""What random scenes have and no notebook draws: boxes, bent boards, windows, table tops, blur, a webcam's sensor."""

from dataclasses import dataclass

import cv2
import numpy as np

from ir50p_lab.vision.rendering.colours import light_of, to_bytes
from ir50p_lab.vision.rendering.scene import Lamp, Lens, RoundThing, Sensor, Sun, Tabletop
from ir50p_lab.vision.rendering.shadow import smooth
from ir50p_lab.vision.rendering.surface import noise
from tests.support.drawn_board import Board, print_range


@dataclass(frozen=True, kw_only=True)
class Box(RoundThing):
    """A box (book, carton, card): middle T_world_box (4, 4), size (3,) m, colour."""

    T_world_box: np.ndarray
    size: tuple = (0.06, 0.04, 0.03)
    colour: str | tuple = (120, 65, 40)

    def shape(self, T_cam_world):
        return BoxShape(T_cam_world @ self.T_world_box, self.size)

    def paint(self, shape, X):
        return light_of(self.colour), shape.faces(X)

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
class BentBoard(Board):
    """bend: 1/m, curvature about the board's y axis through its middle: the print bulges towards the viewer for bend > 0;
    arc length along x is kept, as paper does."""

    bend: float = 0.0

    def shape(self, T_cam_world):
        if self.bend == 0:
            return super().shape(T_cam_world)
        return BentSheetShape(T_cam_world @ self.T_world_board, *print_range(self), self.bend)


class BentSheetShape:
    """A printed sheet, bent about its y axis: T_cam_sheet (4, 4), x and y ranges of the print, curvature `bend`.

    A point of the print (u, v) lies at x = middle + sin(bend u') / bend, y = v, z = (1 - cos(bend u')) / bend with
    u' = u - middle: z points away from the viewer, so the middle bulges towards him for bend > 0.
    """

    def __init__(self, T_cam_sheet, x, y, bend):
        self.R, self.t = T_cam_sheet[:3, :3], T_cam_sheet[:3, 3]
        self.x, self.y, self.bend, self.middle = x, y, float(bend), (x[0] + x[1]) / 2

    def place(self, u, v):
        """Sheet coordinates (n, 3) of the points u, v (n,) of the print."""
        angle = self.bend * (u - self.middle)
        return np.stack([self.middle + np.sin(angle) / self.bend, v, (1 - np.cos(angle)) / self.bend], axis=-1)

    def bounds(self):
        """Points (n, 3) along its rim, in camera coordinates."""
        u, v = np.meshgrid(np.linspace(*self.x, 9), np.array(self.y))
        return self.place(u.ravel(), v.ravel()) @ self.R.T + self.t

    def depth(self, rays):
        """Depth Z of the hit, inf where there is none."""
        origin, k = -self.R.T @ self.t, self.bend / 2
        ox, oz = origin[0] - self.middle, origin[2]
        dx, dy, dz = (rays.x * self.R[0, i] + rays.y * self.R[1, i] + self.R[2, i] for i in range(3))
        # z = bend/2 (x'^2 + z^2) on the cylinder; the root that becomes the plane's for bend -> 0, without cancelling
        A, B, C = k * (dx * dx + dz * dz), 2 * k * (ox * dx + oz * dz) - dz, k * (ox * ox + oz * oz) - oz
        with np.errstate(invalid="ignore", divide="ignore"):
            t = -2 * C / (B + np.sign(B) * np.sqrt(B * B - 4 * A * C))
            u, v = self.unroll(ox + t * dx, oz + t * dz), origin[1] + t * dy
            hit = (t > 0) & (u >= self.x[0]) & (u <= self.x[1]) & (v >= self.y[0]) & (v <= self.y[1])
        return np.where(hit, t, np.inf)

    def unroll(self, x, z):
        """Print coordinate u of sheet coordinates x (from the middle) and z."""
        return self.middle + np.arctan2(self.bend * x, 1 - self.bend * z) / self.bend

    def print_coordinates(self, X):
        """Coordinates u, v of the print at the points X (3, n), and whether its front is seen (n,)."""
        local = self.R.T @ (X - self.t[:, None])
        x, z = local[0] - self.middle, local[2]
        front = np.sum(self.R @ np.stack([-self.bend * x, 0 * x, 1 - self.bend * z]) * X, axis=0) > 0
        return self.unroll(x, z), local[1], front

    def normal(self, X):
        """Normals (3, n) on the side of the camera."""
        local = self.R.T @ (X - self.t[:, None])
        n = self.R @ np.stack([-self.bend * (local[0] - self.middle), 0 * local[0], 1 - self.bend * local[2]])
        return -n * np.sign(np.sum(n * X, axis=0))


@dataclass(frozen=True, kw_only=True)
class WindowSun(Sun):
    """edge: None, or (angle, offset m, width m): light only on one side of a line on the table, as beside a window."""

    edge: tuple | None = None

    def direction(self, X):
        towards, strength, softness = super().direction(X)
        if self.edge is not None:
            angle, offset, width = self.edge
            along = (np.cos(angle) * X[0] + np.sin(angle) * X[1] - offset) / width
            strength = strength * smooth(along + 0.5)
        return towards, strength, softness


@dataclass(frozen=True, kw_only=True)
class ShakenLens(Lens):
    """Blur besides: `defocus` diameter of the disc and `motion` (dx, dy), pixels."""

    defocus: float = 0.0
    motion: tuple = (0.0, 0.0)

    def through(self, light):
        if self.defocus > 0:
            light = cv2.filter2D(light, -1, disc(self.defocus), borderType=cv2.BORDER_REPLICATE)
        if np.hypot(*self.motion) > 0:
            light = cv2.filter2D(light, -1, streak(*self.motion), borderType=cv2.BORDER_REPLICATE)
        return super().through(light)


SPAN = 16  # sub-steps per pixel of the kernels


def disc(diameter):
    """Kernel of a disc of this diameter, pixels, sum 1: a point out of focus."""
    n = int(np.ceil(diameter / 2 + 0.5))
    sub = (np.arange((2 * n + 1) * SPAN) + 0.5) / SPAN - n - 0.5
    radius = max(diameter / 2, 1 / SPAN)  # at least the four places around the middle
    inside = (sub[:, None] ** 2 + sub[None, :] ** 2 <= radius**2).astype(float)
    kernel = inside.reshape(2 * n + 1, SPAN, 2 * n + 1, SPAN).sum(axis=(1, 3))
    return (kernel / kernel.sum()).astype(np.float32)


def streak(dx, dy):
    """Kernel of a straight move by (dx, dy) pixels while the shutter is open, sum 1, centred."""
    n = int(np.ceil(max(abs(dx), abs(dy)) / 2 + 1))
    kernel = np.zeros((2 * n + 1, 2 * n + 1))
    steps = max(2, int(SPAN * np.hypot(dx, dy)))
    along = (np.arange(steps) + 0.5) / steps - 0.5
    x, y = along * dx + n, along * dy + n
    i, j = np.floor(y).astype(int), np.floor(x).astype(int)
    fy, fx = y - i, x - j
    for di, wy in ((0, 1 - fy), (1, fy)):
        for dj, wx in ((0, 1 - fx), (1, fx)):
            np.add.at(kernel, (i + di, j + dj), wy * wx)
    return (kernel / kernel.sum()).astype(np.float32)


def plain(seed, u, v):
    return 0.25 * noise("soft", seed, 10 * u, 10 * v)


def cloth(seed, u, v):
    return 0.5 * noise("rough", seed, 40 * u, 40 * v) + 0.5 * noise("soft", seed, 12 * u, 12 * v)


def speckle(seed, u, v):
    return noise("rough", seed, 30 * u, 30 * v)


def tiles(seed, u, v):
    return 0.3 * noise("rough", seed, 20 * u, 20 * v)


TEXTURES = {"plain": plain, "wood": None, "cloth": cloth, "speckle": speckle, "tiles": tiles}


@dataclass(frozen=True, kw_only=True)
class DeskTable(Tabletop):
    """A table of another texture than wood: a function of TEXTURES; tiles are four grains wide, with joints between them."""

    texture: object = None

    def grained(self, u, v, seed):
        if self.texture is None:
            return super().grained(u, v, seed)
        shade = 1 + np.float32(0.9 * self.contrast) * self.texture(seed, u, v)
        if self.texture is not tiles:
            return shade, 0
        joint = (np.mod(u / 4, 1) < 0.03) | (np.mod(v / 4, 1) < 0.03)
        return np.where(joint, (1 - 0.6 * self.contrast) * shade, shade), joint


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
        image = to_bytes(light)
        return sharpen(image, self.sharpen) if self.sharpen > 0 else image


class LinearSensor(Sensor):
    """Bytes are proportional to light."""

    def developed(self, light):
        return np.rint(np.clip(light * np.asarray(self.balance, dtype=np.float32), 0, 1) * 255).astype(np.uint8)


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
