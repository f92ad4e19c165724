"""Calibration boards as the renderer draws them: the print, the sheet, the board held before a camera."""

import functools
from dataclasses import dataclass, field, replace

import numpy as np

from ir50p_lab.vision.calibration.board import Charuco
from ir50p_lab.vision.calibration.rendered import board_poses
from ir50p_lab.vision.rendering import Lens, Scene, Sensor, Sky, Sun, Tabletop, bench_camera, render_scene
from ir50p_lab.vision.rendering.colours import light_of
from ir50p_lab.vision.rendering.scene import RoundThing

NO_TABLE = Tabletop(colour="grey", x=(0, 0), y=(0, 0))
_PER_SQUARE = 350  # pixels: of a marker 252 where it has 0.72 of a square, whole ones for each of its 7 cells


@dataclass(frozen=True, kw_only=True)
class Board(RoundThing):
    """A flat checkerboard or ChArUco board without a shadow, T_world_board (4, 4).

    Board coordinates: the origin is the first inner corner, x along the `pattern[0]` corners of a row, y along the
    rows, z away from the viewer of the print, as OpenCV's corner finders see it (a view from the front looks along +z).

    pattern: inner corners (columns, rows), both >= 2. square: m. border: white rim around the squares, m.
    kind: 'checkerboard' or 'charuco' (marker: side of a marker, m; dictionary: cv2.aruco name).
    """

    T_world_board: np.ndarray = field(default_factory=lambda: np.diag([1.0, -1.0, -1.0, 1.0]))
    pattern: tuple = (9, 6)
    square: float = 0.025
    border: float = 0.025
    kind: str = "checkerboard"
    marker: float = 0.018
    dictionary: str = "DICT_5X5_100"
    white: tuple = (238, 238, 236)
    black: tuple = (28, 28, 30)

    def shape(self, T_cam_world):
        return SheetShape(T_cam_world @ self.T_world_board, *print_range(self))

    def paint(self, shape, X):
        u, v, front = shape.print_coordinates(X)
        dark = black(self, u, v) & front
        return np.where(dark[:, None], light_of(self.black), light_of(self.white)), np.where(front, dark, 2)

    def dim_sky(self, open_sky, X, Y):
        pass

    def shade(self, part, source, softness, X, Y):
        pass


class SheetShape:
    """A flat printed sheet: T_cam_sheet (4, 4), x and y ranges of the print; its z points away from the viewer."""

    def __init__(self, T_cam_sheet, x, y):
        self.R, self.t, self.x, self.y = T_cam_sheet[:3, :3], T_cam_sheet[:3, 3], x, y

    def bounds(self):
        """Its corners (4, 3)."""
        u, v = np.meshgrid(self.x, self.y)
        return np.stack([u.ravel(), v.ravel(), np.zeros(4)], axis=1) @ self.R.T + self.t

    def depth(self, rays):
        """Depth Z of the hit, inf where there is none."""
        origin = -self.R.T @ self.t
        dx, dy, dz = (rays.x * self.R[0, i] + rays.y * self.R[1, i] + self.R[2, i] for i in range(3))
        with np.errstate(invalid="ignore", divide="ignore"):
            t = -origin[2] / dz
            u, v = origin[0] + t * dx, origin[1] + t * dy
            hit = (t > 0) & (u >= self.x[0]) & (u <= self.x[1]) & (v >= self.y[0]) & (v <= self.y[1])
        return np.where(hit, t, np.inf)

    def print_coordinates(self, X):
        """Coordinates u, v of the print at the points X (3, n), and whether its front is seen (n,)."""
        local = self.R.T @ (X - self.t[:, None])
        return local[0], local[1], self.R[:, 2] @ X > 0

    def normal(self, X):
        """Normals (3, n) on the side of the camera."""
        return -self.R[:, 2:] * np.sign(self.R[:, 2] @ X)


def print_range(board):
    """x and y range (from, to) m of the sheet, border included."""
    columns, rows = board.pattern
    s, b = board.square, board.border
    return (-s - b, columns * s + b), (-s - b, rows * s + b)


def black(board, u, v):
    """Where (n,) the print is black at u, v (n,) m; u is along the rows."""
    columns, rows = board.pattern
    i, j = np.floor(u / board.square).astype(int) + 1, np.floor(v / board.square).astype(int) + 1
    inside = (i >= 0) & (i <= columns) & (j >= 0) & (j <= rows)
    dark = inside & ((i + j) % 2 == 0)
    if board.kind == "charuco":
        light = np.flatnonzero(inside & ~dark)
        picture = _markers(columns, rows, board.square, board.marker, board.dictionary)
        row, column = (((at[light] / board.square + 1) * _PER_SQUARE).astype(int) for at in (v, u))
        dark[light] = picture[row, column] == 0
    return dark


@functools.lru_cache(maxsize=8)
def _markers(columns, rows, square, marker, dictionary):
    """The whole board as OpenCV draws it, _PER_SQUARE pixels a square."""
    size = (columns + 1) * _PER_SQUARE, (rows + 1) * _PER_SQUARE
    return Charuco((columns, rows), square, marker, dictionary).opencv().generateImage(size)


def board_scene(pinhole, T_cam_board, board=None, lens=None, sensor=None):
    """Scene of a board before the camera, no table: lit from behind the camera. Returns: rendering.Scene."""
    _, T_cam_world = bench_camera()
    T_world_cam = np.linalg.solve(T_cam_world, np.eye(4))
    towards = T_world_cam[:3, :3] @ np.array([-0.3, -0.5, -1.0])  # up left behind the camera
    return Scene(
        pinhole=pinhole,
        T_cam_world=T_cam_world,
        objects=(replace(board or Board(), T_world_board=T_world_cam @ T_cam_board),),
        table=NO_TABLE,
        lights=(Sky(strength=0.4), Sun(towards=tuple(towards), strength=0.5)),
        lens=lens or Lens(),
        sensor=sensor or Sensor(),
    )


def board_pictures(pinhole, count, seed=0, *, board=None, lens=None, sensor=None):
    """`count` rendered pictures (h, w, 3) of a board in different poses, and their SceneTruth: (list, list).

    Args: pinhole: Pinhole of the camera to be found; seed: of poses and noise; board: Board (bent, ChArUco);
    lens, sensor: rendering.Lens and Sensor (blur, noise, JPEG).
    """
    pairs = [
        render_scene(board_scene(pinhole, T, board, lens, sensor), seed=1000 * seed + k)
        for k, T in enumerate(board_poses(pinhole, count, seed, board))
    ]
    return [image for image, _ in pairs], [truth for _, truth in pairs]
