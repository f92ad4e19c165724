"""What is really there: the truth beside each rendered picture."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.pinhole import Pinhole, distort_xy
from ir50p_lab.vision.rendering.colours import is_red

_RIM = 256
_RINGS = 24


@dataclass(frozen=True, kw_only=True)
class BallTruth:
    """One ball of the picture.

    x, y: projected centre of the sphere, pixels. radius: of the circle with the area of its image, pixels.
    outline_x, outline_y: centre of area of its image; a sphere's image is an ellipse whose middle is not where the
    sphere's centre is seen. visible: part 0..1 of its image that is in
    the picture and not hidden; 0, with NaN for the rest, for a ball beside or behind the camera. position
    (3,) m and ball_radius m in world coordinates; colour: name or (r, g, b).
    """

    x: float
    y: float
    radius: float
    outline_x: float
    outline_y: float
    visible: float
    position: tuple
    ball_radius: float
    colour: str | tuple

    @property
    def is_red(self):
        """Whether its paint is what the detector of red balls has to find."""
        return is_red(self.colour)


@dataclass(frozen=True, kw_only=True, eq=False)
class BoardTruth:
    """One board of the picture.

    corners (n, 2) pixels, NaN beside or behind the camera; inside (n,): in the picture and not hidden;
    object_points (n, 3) m, as of a flat board; T_cam_board (4, 4).
    """

    corners: np.ndarray
    inside: np.ndarray
    object_points: np.ndarray
    T_cam_board: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class SceneTruth:
    """Of one rendered picture: balls and boards in the order of the scene, camera, scene, seed. Always `simulated`."""

    balls: tuple
    boards: tuple
    pinhole: Pinhole
    T_cam_world: np.ndarray
    scene: object
    seed: int
    simulated: bool = True

    @property
    def red_balls(self):
        """The red balls, largest visible area first."""
        found = [ball for ball in self.balls if ball.is_red]
        return tuple(sorted(found, key=lambda ball: -ball.visible * ball.radius**2))


def ball_truth(pinhole, T_cam_world, ball, seen):
    """BallTruth of a SceneBall; `seen(px, py)` tells which pixels (n,) really show it."""
    centre = T_cam_world[:3, :3] @ np.asarray(ball.position, dtype=float) + T_cam_world[:3, 3]
    known = {"position": tuple(map(float, ball.position)), "ball_radius": float(ball.radius), "colour": ball.colour}
    reach = np.hypot(*centre[:2]) + ball.radius
    if centre[2] - ball.radius <= 1e-3 or reach / (centre[2] - ball.radius) >= pinhole.widest:
        lost = dict.fromkeys(("x", "y", "radius", "outline_x", "outline_y"), float("nan"))
        return BallTruth(**lost, visible=0.0, **known)
    x, y = pinhole.project(np.eye(4), centre)
    rim = sphere_rim(pinhole, centre, ball.radius)
    area, ox, oy = _area_and_centre(rim)
    # points of equal area: rings towards the middle of area
    s = np.sqrt((np.arange(_RINGS) + 0.5) / _RINGS)[:, None, None]
    inside = (np.array([ox, oy]) + s * (rim - (ox, oy))).reshape(-1, 2)
    weight = np.abs(_cross(rim - (ox, oy), np.roll(rim, -1, axis=0) - (ox, oy)))
    weight = np.broadcast_to(0.5 * (weight + np.roll(weight, 1)), (_RINGS, _RIM)).ravel()
    visible = float(np.sum(weight * seen(inside[:, 0], inside[:, 1])) / np.sum(weight))
    return BallTruth(
        x=float(x),
        y=float(y),
        radius=float(np.sqrt(area / np.pi)),
        outline_x=ox,
        outline_y=oy,
        visible=visible,
        **known,
    )


def sphere_rim(pinhole, centre, radius, n=_RIM):
    """Outline (n, 2) pixels of a sphere: the circle where rays from the camera touch it, projected."""
    D = np.linalg.norm(centre)
    axis = centre / D
    side = np.cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.6 else (0.0, 1.0, 0.0))
    side /= np.linalg.norm(side)
    up = np.cross(axis, side)
    a = np.arange(n)[:, None] * (2 * np.pi / n)
    rim = centre - radius**2 / D * axis + radius * np.sqrt(1 - (radius / D) ** 2) * (np.cos(a) * side + np.sin(a) * up)
    return pinhole.project(np.eye(4), rim)


def board_truth(pinhole, T_cam_world, board, shape, seen):
    """BoardTruth of a Board; shape: its SheetShape; `seen(px, py)` tells which pixels (n,) really show it."""
    flat = Checkerboard(board.pattern, board.square).points
    X = shape.place(flat[:, 0], flat[:, 1]) @ shape.R.T + shape.t
    front = (X[:, 2] > 1e-6) & (np.hypot(X[:, 0], X[:, 1]) < pinhole.widest * X[:, 2])
    corners = np.full((len(X), 2), np.nan)
    x, y = X[front, 0] / X[front, 2], X[front, 1] / X[front, 2]
    corners[front] = pinhole.to_pixels(np.stack(distort_xy(pinhole.distortion, x, y), axis=-1))
    w, h = pinhole.size
    inside = front & np.all((corners >= -0.5) & (corners <= (w - 0.5, h - 0.5)), axis=1)
    inside[inside] = seen(corners[inside, 0], corners[inside, 1])
    T_cam_board = T_cam_world @ board.T_world_board
    return BoardTruth(corners=corners, inside=inside, object_points=flat, T_cam_board=T_cam_board)


def _cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _area_and_centre(rim):
    """Area and centre of area of a polygon (n, 2)."""
    middle = rim.mean(axis=0)
    a = rim - middle
    b = np.roll(a, -1, axis=0)
    c = _cross(a, b)
    area = c.sum() / 2
    x, y = middle + ((a + b) * c[:, None]).sum(axis=0) / (6 * area)
    return abs(area), float(x), float(y)
