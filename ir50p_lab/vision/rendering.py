"""Rendered pictures of the bench: rays through four places of every pixel, and the truth about each picture.

Lengths are in m in the base frame of the arm, with the table at z = 0. Colours are (red, green, blue) 0..255 as on the
screen. Everything about the room is assumed; noise, blur and compression are those of a cheap webcam.
"""

import functools
from collections import namedtuple
from dataclasses import dataclass

import cv2
import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.vision.board_pose import transform
from ir50p_lab.vision.pinhole import Pinhole

COLOURS = {
    "red": (200, 30, 40),
    "orange": (235, 110, 25),
    "yellow": (230, 200, 40),
    "green": (40, 140, 60),
    "blue": (35, 70, 170),
    "skin": (215, 160, 130),
    "grey": (128, 128, 128),
}
# Colours of the table and of the room behind it; the table's range in x and in y, m
_WOOD, _ROOM, _EDGES = (176, 148, 112), (120, 118, 115), ((-0.6, 1.1), (-0.8, 0.8))
_SKY, _SUN, _SOFT = 0.55, 0.65, 0.05  # light from all sides, light of one lamp (the sun), half its width in rad
_TOWARDS = np.float32([0.36, 0.36, 0.86])  # direction to the sun
_SUB = 2  # rays along each side of a pixel
_GRAIN, _GRID = 0.03, 0.008  # m: length of the grain of the wood; grid on which the light of the sky is computed
# An ordinary VGA webcam (49 deg across, thesis intro 5.3) on a stand across the table from the arm, tilted by 45 deg
_PINHOLE = Pinhole([[702.0, 0.0, 323.5], [0.0, 699.0, 236.0], [0.0, 0.0, 1.0]], (-0.12, 0.08, 0.0008, -0.0006, 0.0))
CAMERA_BENCH, LOOKS_AT_BENCH = (1.0, 0.05, 0.62), (0.40, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class Stick:
    """A round stick with round ends from `start` to `end` (3,) m: a link of an arm, a finger, a pen."""

    start: tuple
    end: tuple
    radius: float = 0.01
    colour: str | tuple = "grey"
    gloss: float = 0.1


@dataclass(frozen=True, kw_only=True)
class SceneBall:
    """A ball: centre (3,) m, radius m, colour name or (r, g, b); gloss: strength of its highlight, 0 (matt) to 1."""

    position: tuple = (0.40, 0.0, 0.03)
    radius: float = 0.030  # thesis 4.5.3
    colour: str | tuple = "red"
    gloss: float = 0.3

    start = end = property(lambda self: self.position)


@dataclass(frozen=True, kw_only=True)
class Patch:
    """Something flat on the table (tape, paper, a stain): middle (2,) m, size (2,) m, angle rad; round or not."""

    position: tuple = (0.40, 0.10)
    size: tuple = (0.10, 0.02)
    angle: float = 0.0
    colour: str | tuple = "red"
    round: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """What is rendered.

    pinhole, T_cam_world (4, 4): the camera; objects: SceneBall or Stick; patches; arm: Sticks; exposure.
    """

    pinhole: Pinhole
    T_cam_world: np.ndarray
    objects: tuple = ()
    patches: tuple = ()
    arm: tuple = ()
    exposure: float = 1.0


class BallTruth(namedtuple("BallTruth", "x y radius outline_x outline_y position colour")):
    """Where a ball is seen; NaN if it is not in front of the camera.

    x, y: projected centre of the sphere, px; radius: of the circle as large as its image, px; outline_x, outline_y:
    middle of that image, px, which lies elsewhere; position: (3,) m; colour.
    """


class SceneTruth(namedtuple("SceneTruth", "balls pinhole")):
    """The truth of one rendered picture: its balls, in the order of the scene, and the camera."""


def look_at(position, target):
    """Return T_cam_world (4, 4) of a camera at `position` (3,) m that looks at `target` (3,) m, not straight down."""
    z = np.subtract(target, position) / np.linalg.norm(np.subtract(target, position))
    x = np.cross(z, (0.0, 0.0, 1.0)) / np.hypot(*z[:2])
    T = np.eye(4)
    T[:3, :3] = x, np.cross(z, x), z
    T[:3, 3] = -T[:3, :3] @ position
    return T


def pose(position, rotation_vector=(0.0, 0.0, 0.0)):
    """Return T_world_thing (4, 4) at `position` (3,) m, turned by `rotation_vector` (3,) rad (axis times angle)."""
    return transform(vectors3("rotation_vector", rotation_vector), vectors3("position", position, unit="m"))


def bench_camera():
    """Return (Pinhole, T_cam_world) of the webcam on its stand across the table from the arm."""
    return _PINHOLE, look_at(CAMERA_BENCH, LOOKS_AT_BENCH)


def bench_scene(*objects, **changes):
    """Return the default bench with these objects (default: one red ball); `changes` are fields of Scene."""
    scene = dict(zip(("pinhole", "T_cam_world"), bench_camera(), strict=True), objects=objects or (SceneBall(),))
    return Scene(**(scene | changes))


def arm_sticks(q, arm, *, opening=0.07):
    """Return the arm at q (3,) rad as Sticks: column, links, joints, two fingers `opening` m apart (sizes assumed)."""
    T = frames(arm, q)
    base, shoulder, elbow, tip = (T[i, :3, 3] for i in range(4))
    along, sideways = T[3, :3, 0], T[2, :3, 2]
    wrist, aside = tip - along * min(0.082, 0.5 * np.linalg.norm(tip - elbow)), sideways * opening / 2
    paint, joint = (212, 208, 200), (70, 72, 76)
    parts = (
        (base, shoulder, 0.06, paint),
        (shoulder - 0.045 * sideways, shoulder + 0.045 * sideways, 0.045, joint),
        (shoulder, elbow, 0.03, paint),
        (elbow - 0.03 * sideways, elbow + 0.03 * sideways, 0.0345, joint),
        (elbow, wrist, 0.022, paint),
        (wrist - aside, wrist + aside, 0.009, joint),
        *((wrist + s * aside, tip + s * aside, 0.007, joint) for s in (-1, 1)),
    )
    return tuple(Stick(start=tuple(a), end=tuple(b), radius=r, colour=colour) for a, b, r, colour in parts)


def light_of(colour):
    """Return the linear light (3,) of a colour name or (r, g, b) 0..255."""
    if isinstance(colour, str) and colour not in COLOURS:
        raise InputError(f"colour {colour!r} is not known: give (r, g, b) or one of {', '.join(COLOURS)}")
    s = np.float32(COLOURS.get(colour, colour) if isinstance(colour, str) else colour) / 255
    return np.float32(np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4))


def render_scene(scene, seed=0):
    """Return the picture (h, w, 3) uint8 of a Scene, and its SceneTruth.

    It is the same for the same scene and `seed` of the noise.
    """
    w, h = scene.pinhole.size
    light = cv2.resize(_light(scene).reshape(h * _SUB, w * _SUB, 3), (w, h), interpolation=cv2.INTER_AREA)
    light = cv2.GaussianBlur(light, (0, 0), 0.5) * np.float32(scene.exposure)
    noise = np.random.default_rng(seed).standard_normal(light.shape, dtype=np.float32)
    light = np.clip(np.minimum(light, 1) + np.sqrt(0.003**2 + 0.012**2 * light) * noise, 0, 1)
    image = np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
    _, data = cv2.imencode(".jpg", np.rint(255 * image[..., ::-1]).astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, 92])
    image = np.ascontiguousarray(cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1])
    balls = tuple(_truth(scene, ball) for ball in scene.objects if isinstance(ball, SceneBall))
    return image, SceneTruth(balls=balls, pinhole=scene.pinhole)


@functools.lru_cache(maxsize=4)
def _rays(pinhole):
    """Unit vectors (3, n) float32 of all rays, row by row (kept for the next picture of the same camera)."""
    w, h = pinhole.size
    y, x = ((np.arange(n * _SUB) + 0.5) / _SUB - 0.5 for n in (h, w))
    xy = pinhole.undistort_points(np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2))
    rays = np.array([*xy.T, np.ones(len(xy))])
    return np.float32(rays / np.linalg.norm(rays, axis=0))


def _light(scene):
    """Light (n, 3) float32 along all rays: of the room, of the table, and of the things in front of them."""
    T = np.float32(scene.T_cam_world)
    rays, (R, t) = _rays(scene.pinhole), (T[:3, :3], T[:3, 3])
    eye, ways = -R.T @ t, R.T @ rays
    light = np.broadcast_to(light_of(_ROOM), (rays.shape[1], 3)).astype(np.float32)
    with np.errstate(divide="ignore"):
        depth = np.where(ways[2] < 0, -eye[2] / ways[2], np.inf)
    ground = np.where(np.isfinite(depth), depth, 0)
    X, Y = (eye[k] + ground * ways[k] for k in (0, 1))
    on = np.isfinite(depth) & (X > _EDGES[0][0]) & (X < _EDGES[0][1]) & (Y > _EDGES[1][0]) & (Y < _EDGES[1][1])
    if on.any():
        light[on] = _table(scene, X[on], Y[on])
    depth = np.where(on, depth, np.float32(np.inf))
    for thing in (*scene.objects, *scene.arm):
        a, b = (R @ np.float32(end) + t for end in (thing.start, thing.end))
        middle, reach = (a + b) / 2, np.linalg.norm(b - a) / 2 + thing.radius
        cone = np.sqrt(max(middle @ middle - reach**2, 0))  # around the thing, from the camera
        near = np.flatnonzero(middle @ rays >= cone)
        d = _hit(rays[:, near], a, b, thing.radius)
        closer = d < depth[near] * 1.0001
        near, d = near[closer], d[closer]
        depth[near] = d
        from_a, axis = d * rays[:, near] - a[:, None], (b - a)[:, None]
        along = np.clip((axis * from_a).sum(axis=0) / max(float((axis**2).sum()), 1e-12), 0, 1)
        normal = R.T @ ((from_a - along * axis) / thing.radius)
        light[near] = _shaded(thing, normal, -ways[:, near])
    return light


def _shaded(thing, normal, view):
    """Light (n, 3) of a surface with these normals (3, n), seen from the directions `view` (3, n).

    Lambert's cosine for the sun, the share of sky above and half of the wood's light below, a highlight (Blinn).
    """
    sun, half = np.maximum(_TOWARDS @ normal, 0), _TOWARDS[:, None] + view
    shine = np.maximum((normal * half / np.linalg.norm(half, axis=0)).sum(axis=0), 0) ** 40 * (sun > 0) * thing.gloss
    up = 0.5 * (1 + normal[2])[:, None]
    falls_on = _SKY * (up + (1 - up) * 0.5 * light_of(_WOOD)) + _SUN * sun[:, None]
    return light_of(thing.colour) * falls_on + _SUN * shine[:, None]


def _hit(rays, a, b, radius):
    """Distance (n,) at which unit vectors (3, n) meet a stick with round ends a, b (3,), inf where they do not."""
    best = np.full(rays.shape[1], np.inf, np.float32)
    with np.errstate(invalid="ignore", divide="ignore"):
        for end in (a, b):
            along = end @ rays
            best = np.fmin(best, along - np.sqrt(along**2 - (end @ end - radius**2)))
        length = np.linalg.norm(b - a)
        if length > 1e-6:
            u = (b - a) / length
            ud, ua = u @ rays, u @ a
            A, B = 1 - ud**2, a @ rays - ud * ua
            d = (B - np.sqrt(B * B - A * (a @ a - ua * ua - radius**2))) / A
            best = np.fmin(best, np.where((d * ud - ua >= 0) & (d * ud - ua <= length), d, np.inf))
    return best


def _table(scene, X, Y):
    """Light (n, 3) from places of the table: wood, what lies on it, and shadows."""
    along, across = X / _GRAIN, Y / _GRAIN
    coarse, fine = (_interpolated(_tile(), k * along, m * across) for k, m in ((1, 12), (1.5, 30)))
    albedo = np.clip(1 + np.float32(0.096) * coarse + np.float32(0.064) * fine, 0.1, 1.9)[:, None] * light_of(_WOOD)
    for patch in scene.patches:
        c, s = np.cos(patch.angle), np.sin(patch.angle)
        x, y = X - patch.position[0], Y - patch.position[1]
        u, v = (c * x + s * y) / (patch.size[0] / 2), (c * y - s * x) / (patch.size[1] / 2)
        albedo[np.hypot(u, v) <= 1 if patch.round else np.maximum(np.abs(u), np.abs(v)) <= 1] = light_of(patch.colour)
    sky = _interpolated(_open_sky(scene), (X - _EDGES[0][0]) / _GRID, (Y - _EDGES[1][0]) / _GRID)
    sun = np.ones_like(X)
    for thing in (*scene.objects, *scene.arm):
        _hide_sun(sun, thing, X, Y)
    return albedo * (np.float32(_SKY) * sky + np.float32(_SUN) * _TOWARDS[2] * sun)[:, None]


def _open_sky(scene):
    """Share of the sky's light (rows, columns) that reaches the table, on a grid from its corner of least x and y.

    A ball at height h and distance D hides h r^2 / D^3 of it, a stick h r / D^2.
    """
    x, y = (np.arange(low, high + 2 * _GRID, _GRID, np.float32) for low, high in _EDGES)
    P = np.stack([*np.meshgrid(x, y), np.zeros((len(y), len(x)), np.float32)], axis=-1)
    sky = np.ones(P.shape[:2], np.float32)
    for thing in (*scene.objects, *scene.arm):
        a, b, r = np.float32(thing.start), np.float32(thing.end), thing.radius
        axis, squared = b - a, float(((b - a) ** 2).sum())
        along = np.clip((P - a) @ axis / max(squared, 1e-12), 0, 1)
        D2 = np.maximum(((a + along[..., None] * axis - P) ** 2).sum(axis=-1), r * r)
        sky *= 1 - np.clip((a[2] + along * axis[2]) * r / D2 * (1 if squared > 0 else r / np.sqrt(D2)), 0, 1)
    return sky


def _hide_sun(sun, thing, X, Y):
    """Reduce the sun's light (n,) in place at places X, Y (n,) m of the table where a thing throws its soft shadow."""
    a, b, r = np.float32(thing.start), np.float32(thing.end), thing.radius
    feet = [end - _TOWARDS * (end[2] / _TOWARDS[2]) for end in (a, b)]  # shadows of both ends
    margin = (r + _SOFT * max(a[2], b[2]) / _TOWARDS[2] + 2e-3) / _TOWARDS[2]
    low, high = np.min(feet, axis=0) - margin, np.max(feet, axis=0) + margin
    near = np.flatnonzero((X > low[0]) & (X < high[0]) & (Y > low[1]) & (Y < high[1]))
    P = np.stack([X[near], Y[near], np.zeros(len(near), np.float32)])
    axis, squared, towards = (b - a)[:, None], float(((b - a) ** 2).sum()), _TOWARDS[:, None]
    slant, v = float((axis * towards).sum()), P - a[:, None]
    along = (axis * v).sum(axis=0) - slant * (towards * v).sum(axis=0)  # closest approach of that line and the stick
    to = np.clip(along / max(squared - slant * slant, 1e-12), 0, 1) * axis - v
    far = (towards * to).sum(axis=0)
    off = np.sqrt(np.maximum((to**2).sum(axis=0) - far**2, 0)) - r
    part = np.clip(0.5 + off / (2 * np.maximum(_SOFT * np.abs(far), 1e-3)), 0, 1)
    sun[near] *= np.where(far > 0, part * part * (3 - 2 * part), 1)


@functools.cache
def _tile():
    """A square of noise (512, 512) that repeats without a seam, mean 0, standard deviation 1."""
    spectrum = np.fft.rfft2(np.random.default_rng(0).standard_normal((512, 512)))
    frequency = np.hypot(np.fft.fftfreq(512)[:, None], np.fft.rfftfreq(512)) * 512
    noise = np.fft.irfft2(spectrum / np.maximum(frequency, 2) ** 1.2 * np.exp(-((frequency / 100) ** 2)))
    return np.float32(noise / noise.std())


def _interpolated(values, u, v):
    """`values` (rows, columns) interpolated at columns u and rows v (n,); beyond its edges the array repeats."""
    n, lines = len(u), -(-len(u) // 4096)  # rows of 4096: OpenCV refuses very long ones
    u, v = (np.resize(np.float32(one), (lines, 4096)) for one in (u, v))
    return cv2.remap(values, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP).ravel()[:n]


def _truth(scene, ball):
    """BallTruth of a SceneBall; NaN if it is not in front of the camera."""
    T, r = np.asarray(scene.T_cam_world), ball.radius
    centre, numbers = T[:3, :3] @ ball.position + T[:3, 3], [np.nan] * 5
    D = np.linalg.norm(centre)
    if centre[2] > r:
        side, up = np.linalg.svd(centre[None])[2][1:]
        a = np.arange(256)[:, None] * (2 * np.pi / 256)  # the circle where rays from the camera touch it
        touched = centre * (1 - (r / D) ** 2) + r * np.sqrt(1 - (r / D) ** 2) * (np.cos(a) * side + np.sin(a) * up)
        rim, xy = (scene.pinhole.project(np.eye(4), points) for points in (touched, centre))
        seen = scene.pinhole.undistort_or_nan(rim)
        if np.allclose(seen, touched[:, :2] / touched[:, 2:]):  # else it lies beyond the fold of the lens
            middle = rim.mean(axis=0)
            m = cv2.moments(np.float32(rim - middle))
            shift = np.array([m["m10"], m["m01"]]) / m["m00"]
            numbers = [*xy, np.sqrt(m["m00"] / np.pi), *(middle + shift)]
    return BallTruth(*map(float, numbers), ball.position, ball.colour)
