"""What is on the bench, as data: a Scene of frozen dataclasses that `render_scene` turns into a picture.

Lengths in m in world coordinates: the base frame of the arm, table at z = 0 (as the simulated arm has it).
Colours are (red, green, blue) 0..255 as on the screen: what the surface would show in full white light.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, vectors3
from ir50p_lab.vision.checks import rigid
from ir50p_lab.vision.pinhole import Pinhole, as_pinhole

COLOURS = {  # paints, not light: measured from nothing, chosen to look like toy balls and tape
    "red": (200, 30, 40),
    "orange": (235, 110, 25),
    "yellow": (230, 200, 40),
    "green": (40, 140, 60),
    "blue": (35, 70, 170),
    "purple": (110, 45, 130),
    "pink": (235, 120, 150),
    "brown": (120, 65, 40),
    "skin": (215, 160, 130),
    "white": (235, 235, 230),
    "grey": (128, 128, 128),
    "black": (30, 30, 32),
}


@dataclass(frozen=True, kw_only=True)
class SceneBall:
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


@dataclass(frozen=True, kw_only=True)
class Board:
    """A checkerboard or ChArUco board, T_world_board (4, 4), bent if asked.

    Board coordinates: the origin is the first inner corner, x along the `pattern[0]` corners of a row, y along the
    rows, z away from the viewer of the print, as OpenCV's corner finders see it (a view from the front looks along +z).

    pattern: inner corners (columns, rows), both >= 2. square: m. border: white rim around the squares, m.
    bend: 1/m, curvature about the board's y axis through its middle: the print bulges towards the viewer for bend > 0;
    arc length along x is kept, as paper does. kind: 'checkerboard' or 'charuco' (marker: side of a marker, m;
    dictionary: cv2.aruco name).
    """

    T_world_board: np.ndarray = field(default_factory=lambda: np.diag([1.0, -1.0, -1.0, 1.0]))
    pattern: tuple = (9, 6)
    square: float = 0.025
    border: float = 0.025
    bend: float = 0.0
    kind: str = "checkerboard"
    marker: float = 0.018
    dictionary: str = "DICT_5X5_100"
    white: tuple = (238, 238, 236)
    black: tuple = (28, 28, 30)


@dataclass(frozen=True, kw_only=True)
class Patch:
    """Something flat on the table (tape, paper, a stain): outline, middle (2,) m, size (2,) m, angle rad, colour.

    outline: 'rectangle', 'ellipse' or 'blob' (an ellipse with a wavy rim drawn from `seed`).
    """

    position: tuple = (0.40, 0.10)
    size: tuple = (0.10, 0.02)
    angle: float = 0.0
    colour: str | tuple = "red"
    outline: str = "rectangle"
    seed: int = 0


@dataclass(frozen=True, kw_only=True)
class Stick:
    """A round stick with round ends from `start` to `end` (3,) m: link of an arm, finger, pen."""

    start: tuple
    end: tuple
    radius: float = 0.01
    colour: str | tuple = "grey"
    gloss: float = 0.0
    shininess: float = 30.0


@dataclass(frozen=True, kw_only=True)
class Box:
    """A box (book, carton, card): middle T_world_box (4, 4), size (3,) m, colour."""

    T_world_box: np.ndarray
    size: tuple = (0.06, 0.04, 0.03)
    colour: str | tuple = "brown"


@dataclass(frozen=True, kw_only=True)
class Tabletop:
    """The table: texture 'plain', 'wood', 'cloth', 'speckle' or 'tiles', its colour, contrast 0..1, grain size m.

    x, y: (from, to) m of its edges; beyond them the camera sees the room (colour `room`), blurred.
    """

    texture: str = "wood"
    colour: str | tuple = (176, 148, 112)
    contrast: float = 0.18
    grain: float = 0.03
    angle: float = 0.0
    x: tuple = (-0.6, 1.1)
    y: tuple = (-0.8, 0.8)
    room: str | tuple = (120, 118, 115)


@dataclass(frozen=True, kw_only=True)
class Sky:
    """Light from everywhere (ceiling, walls): colour (3,) relative, strength at the table 0..1."""

    colour: tuple = (1.0, 1.0, 1.0)
    strength: float = 0.45


@dataclass(frozen=True, kw_only=True)
class Sun:
    """Parallel light: `towards` (3,) points from the scene to the light. softness: rad, half the width of the source.

    edge: None, or (angle, offset m, width m): light only on one side of a line on the table, as beside a window frame.
    """

    towards: tuple = (0.3, 0.4, 1.0)
    colour: tuple = (1.0, 1.0, 1.0)
    strength: float = 0.6
    softness: float = 0.02
    edge: tuple | None = None


@dataclass(frozen=True, kw_only=True)
class Lamp:
    """A lamp at `position` (3,) m; `strength` is at 1 m distance, and falls with its square. size: radius m."""

    position: tuple = (0.6, 0.5, 0.9)
    colour: tuple = (1.0, 0.85, 0.65)
    strength: float = 0.6
    size: float = 0.05


@dataclass(frozen=True, kw_only=True)
class Lens:
    """Blur: `defocus` diameter of the disc and `motion` (dx, dy), pixels; `sigma` of a Gauss; vignetting 0..1."""

    defocus: float = 0.0
    motion: tuple = (0.0, 0.0)
    sigma: float = 0.5
    vignetting: float = 0.15


@dataclass(frozen=True, kw_only=True)
class Sensor:
    """From light to bytes: exposure, white balance (3,), noise, mosaic, sharpening, gamma, JPEG.

    read_noise and shot_noise are standard deviations at black and (on top) at white, parts of full scale. mosaic: one
    colour per pixel, as sensors have it, filled in by interpolation. sharpen: strength of an unsharp mask. saturation:
    of colours, 1 as they are. jpeg: quality 1..100, or None. gamma: False keeps bytes proportional to light.
    """

    exposure: float = 1.0
    balance: tuple = (1.0, 1.0, 1.0)
    read_noise: float = 0.003
    shot_noise: float = 0.012
    mosaic: bool = False
    sharpen: float = 0.0
    saturation: float = 1.0
    jpeg: int | None = 92
    gamma: bool = True


NO_LENS = Lens(sigma=0.0, vignetting=0.0)
NO_SENSOR = Sensor(read_noise=0.0, shot_noise=0.0, jpeg=None)


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """Everything `render_scene` needs, but for the seed of the noise.

    pinhole: the camera. T_cam_world (4, 4): where it is. objects: SceneBall, Board, Stick, Box in any number; patches:
    on the table, later ones over earlier ones; lights: Sky, Sun, Lamp. arm: tuple of Stick (`arm_sticks`), kept apart
    so that it can be posed. texture_seed: of the table's grain and of the room.
    """

    pinhole: Pinhole
    T_cam_world: np.ndarray
    objects: tuple = ()
    patches: tuple = ()
    arm: tuple = ()
    table: Tabletop | None = Tabletop()
    lights: tuple = (Sky(), Sun())
    lens: Lens = Lens()
    sensor: Sensor = Sensor()
    texture_seed: int = 0

    def __post_init__(self):
        object.__setattr__(self, "pinhole", as_pinhole(self.pinhole))
        object.__setattr__(self, "T_cam_world", rigid("T_cam_world", self.T_cam_world))
        for field_name, kinds in _PARTS.items():
            for part in getattr(self, field_name):
                if not isinstance(part, kinds):
                    names = ", ".join(kind.__name__ for kind in kinds)
                    raise InputError(f"{part!r:.60} is none of the {field_name} of a Scene: give {names}")

    @property
    def balls(self):
        """The balls among the objects, in their order."""
        return tuple(thing for thing in self.objects if isinstance(thing, SceneBall))

    @property
    def boards(self):
        """The boards among the objects, in their order."""
        return tuple(thing for thing in self.objects if isinstance(thing, Board))

    def clean(self):
        """The same scene through a perfect lens and sensor: sharp, no noise, no JPEG, bytes proportional to light."""
        return replace(self, lens=NO_LENS, sensor=replace(NO_SENSOR, exposure=self.sensor.exposure, gamma=False))


_PARTS = {"objects": (SceneBall, Board, Stick, Box), "patches": (Patch,), "arm": (Stick,), "lights": (Sky, Sun, Lamp)}
