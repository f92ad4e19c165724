"""What a picture will show, without drawing it: how much of each ball is seen, which corners of each board are."""

import colorsys
from dataclasses import asdict, dataclass

import numpy as np

from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.pinhole import distort_xy
from ir50p_lab.vision.rendering.rays import rays_through
from ir50p_lab.vision.rendering.render import RayTracer
from ir50p_lab.vision.rendering.scene import SceneBall
from ir50p_lab.vision.rendering.truth import BallTruth, SceneTruth, ball_truth, sphere_rim
from tests.support.drawn_board import Board

RINGS = 24


@dataclass(frozen=True, kw_only=True)
class SeenBall(BallTruth):
    """visible: part 0..1 of its image that is in the picture and not hidden; 0 beside or behind the camera."""

    visible: float

    @property
    def is_red(self):
        """Whether its paint, name or (r, g, b) 0..255, is what the detector of red balls has to find."""
        if isinstance(self.colour, str):
            return self.colour == "red"
        hue, saturation, value = colorsys.rgb_to_hsv(*(c / 255 for c in self.colour))
        return (hue * 360 <= 9 or hue * 360 >= 349) and saturation >= 0.7 and value >= 0.4


@dataclass(frozen=True, kw_only=True, eq=False)
class BoardTruth:
    """corners (n, 2) pixels, NaN beside or behind the camera; inside (n,): in the picture and not hidden.

    object_points (n, 3) m, as of a flat board; T_cam_board (4, 4).
    """

    corners: np.ndarray
    inside: np.ndarray
    object_points: np.ndarray
    T_cam_board: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class SeenTruth(SceneTruth):
    """Balls are SeenBalls, and boards are there, too."""

    boards: tuple = ()

    @property
    def red_balls(self):
        """The red balls, largest visible area first."""
        found = [ball for ball in self.balls if ball.is_red]
        return tuple(sorted(found, key=lambda ball: -ball.visible * ball.radius**2))


def scene_truth(scene):
    """SeenTruth of a Scene."""
    tracer, pinhole = RayTracer(scene), scene.pinhole
    w, h = pinhole.size

    def seen(number, xy):
        """Which pixels (n, 2) show the thing of this number."""
        inside = np.all((xy >= -0.5) & (xy <= (w - 0.5, h - 0.5)), axis=1)
        inside[inside] = tracer.first_hits(rays_through(pinhole, *xy[inside].T))[1] == number + 2
        return inside

    balls, boards = [], []
    for i, thing in enumerate(tracer.things):
        if isinstance(thing, SceneBall):
            ball, visible = ball_truth(pinhole, tracer.T, thing), 0.0
            if np.isfinite(ball.radius):
                places, weight = spread_over(pinhole, tracer.T, thing, ball)
                visible = float(np.sum(weight * seen(i, places)) / np.sum(weight))
            balls.append(SeenBall(**asdict(ball), visible=visible))
        elif isinstance(thing, Board):
            flat = Checkerboard(thing.pattern, thing.square).points
            shape = tracer.shapes[i]
            X = shape.place(flat[:, 0], flat[:, 1]) if hasattr(shape, "place") else flat
            X = X @ shape.R.T + shape.t
            front = (X[:, 2] > 1e-6) & (np.hypot(X[:, 0], X[:, 1]) < pinhole.widest * X[:, 2])
            corners = np.full((len(X), 2), np.nan)
            x, y = (X[front, :2] / X[front, 2:]).T
            corners[front] = pinhole.to_pixels(np.stack(distort_xy(pinhole.distortion, x, y), axis=-1))
            inside = front.copy()
            inside[front] = seen(i, corners[front])
            boards.append(
                BoardTruth(
                    corners=corners, inside=inside, object_points=flat, T_cam_board=tracer.T @ thing.T_world_board
                )
            )
    return SeenTruth(balls=tuple(balls), boards=tuple(boards), pinhole=pinhole, scene=scene)


def spread_over(pinhole, T_cam_world, thing, ball):
    """Places (n, 2) all over the image of a ball: rings towards the middle of its area; and their weights (n,)."""
    centre = T_cam_world[:3, :3] @ np.asarray(thing.position, dtype=float) + T_cam_world[:3, 3]
    rim = sphere_rim(pinhole, centre, thing.radius) - np.array([ball.outline_x, ball.outline_y])
    s = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)[:, None, None]
    following = np.roll(rim, -1, axis=0)
    weight = np.abs(rim[:, 0] * following[:, 1] - rim[:, 1] * following[:, 0])
    weight = np.broadcast_to(0.5 * (weight + np.roll(weight, 1)), (RINGS, len(rim))).ravel()
    middle = np.array([ball.outline_x, ball.outline_y])
    return middle + (s * rim).reshape(-1, 2), weight
