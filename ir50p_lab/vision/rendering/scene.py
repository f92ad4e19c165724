"""What is on the bench, as data: a Scene of frozen dataclasses that `render_scene` turns into a picture.

Lengths in m in world coordinates: the base frame of the arm, table at z = 0 (as the simulated arm has it).
Colours are (red, green, blue) 0..255 as on the screen: what the surface would show in full white light.
"""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, vectors3
from ir50p_lab.vision.checks import rigid
from ir50p_lab.vision.pinhole import Pinhole, as_pinhole
from ir50p_lab.vision.rendering.colours import light_of, to_bytes
from ir50p_lab.vision.rendering.shadow import dim_sky, shadow
from ir50p_lab.vision.rendering.shapes import RoundShape
from ir50p_lab.vision.rendering.surface import noise


class RoundThing:
    """A ball or a stick with round ends; it has `ends`, two places (3,) m, and a radius."""

    def shape(self, T_cam_world):
        """Where rays meet it, in camera coordinates: a cylinder with round ends."""
        a, b = np.asarray(self.ends, dtype=float) @ T_cam_world[:3, :3].T + T_cam_world[:3, 3]
        return RoundShape(a, b, self.radius)

    def paint(self, shape, X):
        """Linear colour (3,) or (n, 3) at X (3, n) in camera coordinates, and a code, (n,) where edges run across."""
        return light_of(self.colour), 0

    def dim_sky(self, open_sky, X, Y):
        """Take off `open_sky` (n,), in place, what the places X, Y (n,) m of the table lose of the sky."""
        dim_sky(open_sky, *np.asarray(self.ends, dtype=X.dtype), self.radius, X, Y)

    def shade(self, part, source, softness, X, Y):
        """The same of a Sun or Lamp, whose half width is `softness` rad: a round or long shadow."""
        shadow(part, *np.asarray(self.ends, dtype=X.dtype), self.radius, source, softness, X, Y)


@dataclass(frozen=True, kw_only=True)
class SceneBall(RoundThing):
    """A ball: centre (3,) m, radius m, colour name or (r, g, b).

    gloss: strength of the highlight, 0 matt (felt, foam) to 1 (lacquer); shininess: exponent, large is a small spot.
    """

    position: tuple = (0.40, 0.0, 0.03)
    radius: float = 0.030  # thesis 4.5.3
    colour: str | tuple = "red"
    gloss: float = 0.3
    shininess: float = 40.0

    def __post_init__(self):
        vectors3("position", self.position, unit="m")
        number("radius", self.radius, "> 0", unit="m")

    ends = property(lambda self: (self.position, self.position), doc="Its middle, twice.")


@dataclass(frozen=True, kw_only=True)
class Patch:
    """Something flat on the table (tape, paper, a stain): outline, middle (2,) m, size (2,) m, angle rad, colour.

    outline: 'rectangle' or 'blob' (an ellipse with a wavy rim drawn from `seed`).
    """

    position: tuple = (0.40, 0.10)
    size: tuple = (0.10, 0.02)
    angle: float = 0.0
    colour: str | tuple = "red"
    outline: str = "rectangle"
    seed: int = 0


@dataclass(frozen=True, kw_only=True)
class Stick(RoundThing):
    """A round stick with round ends from `start` to `end` (3,) m: link of an arm, finger, pen."""

    start: tuple
    end: tuple
    radius: float = 0.01
    colour: str | tuple = "grey"
    gloss: float = 0.0
    shininess: float = 30.0

    ends = property(lambda self: (self.start, self.end), doc="Middles of its round ends.")


@dataclass(frozen=True, kw_only=True)
class Tabletop:
    """A wooden table: its colour, contrast 0..1 of the grain, size m of the grain.

    x, y: (from, to) m of its edges; beyond them the camera sees the room (colour `room`), blurred.
    """

    colour: str | tuple = (176, 148, 112)
    contrast: float = 0.18
    grain: float = 0.03
    angle: float = 0.0
    x: tuple = (-0.6, 1.1)
    y: tuple = (-0.8, 0.8)
    room: str | tuple = (120, 118, 115)

    def grained(self, u, v, seed):
        """Brightness (n,) at u, v (n,) in grains along and across it, 1 on average; and a code (n,), as of `paint`."""
        wood = 0.6 * noise("soft", seed, 2 * u, 24 * v) + 0.4 * noise("rough", seed, 3 * u, 60 * v)
        return 1 + np.float32(0.9 * self.contrast) * wood, 0


@dataclass(frozen=True, kw_only=True)
class Sky:
    """Light from everywhere (ceiling, walls): colour (3,) relative, strength at the table 0..1."""

    colour: tuple = (1.0, 1.0, 1.0)
    strength: float = 0.45


@dataclass(frozen=True, kw_only=True)
class Sun:
    """Parallel light: `towards` (3,) points to the light. softness: rad, half the width of its source."""

    towards: tuple = (0.3, 0.4, 1.0)
    colour: tuple = (1.0, 1.0, 1.0)
    strength: float = 0.6
    softness: float = 0.02

    def seen_from(self, p):
        """Direction (3,) to it from the place p (3,) m; its length tells nothing."""
        return np.asarray(self.towards, dtype=float)

    def direction(self, X):
        """Unit directions (3, 1) to it from X (3, n) m, its strength there, and its half width in rad."""
        L = self.seen_from(X)
        return (L / np.linalg.norm(L)).astype(X.dtype)[:, None], self.strength, self.softness


@dataclass(frozen=True, kw_only=True)
class Lamp:
    """A lamp at `position` (3,) m; `strength` is at 1 m distance, and falls with its square. size: radius m."""

    position: tuple = (0.6, 0.5, 0.9)
    colour: tuple = (1.0, 0.85, 0.65)
    strength: float = 0.6
    size: float = 0.05

    def seen_from(self, p):
        """Vector (3,) to it from the place p (3,) m."""
        return np.asarray(self.position) - p

    def direction(self, X):
        """Unit directions (3, n) to it from X (3, n) m, its strength there (n,), and its half width in rad."""
        v = np.asarray(self.position, dtype=X.dtype)[:, None] - X
        r = np.sqrt(np.sum(v * v, axis=0))
        return v / r, self.strength / r**2, self.size / max(self.position[2], 1e-3)


@dataclass(frozen=True, kw_only=True)
class Lens:
    """sigma: of a blur, pixels; vignetting: share of the light that is lost in the corners, 0..1."""

    sigma: float = 0.5
    vignetting: float = 0.15

    def through(self, light):
        """Light (h, w, 3) on the sensor of light (h, w, 3) of a sharp picture."""
        import cv2

        if self.sigma > 0:
            light = cv2.GaussianBlur(light, (0, 0), self.sigma, borderType=cv2.BORDER_REPLICATE)
        h, w = light.shape[:2]
        y, x = np.arange(h)[:, None] - (h - 1) / 2, np.arange(w)[None, :] - (w - 1) / 2
        r2 = (x * x + y * y) / (w * w / 4 + h * h / 4)
        return light * (1 - self.vignetting * r2).astype(np.float32)[..., None]


@dataclass(frozen=True, kw_only=True)
class Sensor:
    """From light to bytes: exposure, white balance (3,), noise, JPEG.

    read_noise and shot_noise are standard deviations at black and (on top) at white, parts of full scale.
    jpeg: quality 1..100, or None.
    """

    exposure: float = 1.0
    balance: tuple = (1.0, 1.0, 1.0)
    read_noise: float = 0.003
    shot_noise: float = 0.012
    jpeg: int | None = 92

    def developed(self, light):
        """Bytes (h, w, 3) of what the sensor measured, light (h, w, 3)."""
        return to_bytes(light * np.asarray(self.balance, dtype=np.float32))


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """Everything `render_scene` needs, but for the seed of the noise.

    pinhole: the camera. T_cam_world (4, 4): where it is. objects: SceneBall or Stick;
    patches: on the table, later ones over earlier ones; lights: Sky, Sun, Lamp. arm: tuple of Stick (`arm_sticks`),
    kept apart so that it can be posed. texture_seed: of the table's grain and of the room.
    """

    pinhole: Pinhole
    T_cam_world: np.ndarray
    objects: tuple = ()
    patches: tuple = ()
    arm: tuple = ()
    table: Tabletop = Tabletop()
    lights: tuple = (Sky(), Sun(towards=(0.4, 0.5, 1.0)), Lamp(position=(0.2, -0.6, 0.8), strength=0.25))
    lens: Lens = Lens()
    sensor: Sensor = Sensor()
    texture_seed: int = 0

    def __post_init__(self):
        object.__setattr__(self, "pinhole", as_pinhole(self.pinhole))
        object.__setattr__(self, "T_cam_world", rigid("T_cam_world", self.T_cam_world))
        for part in self.objects:
            if not isinstance(part, RoundThing):
                raise InputError(f"{part!r:.60} is none of the objects of a Scene: give SceneBall, Stick")
