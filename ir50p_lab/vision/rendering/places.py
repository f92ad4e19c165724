"""Where things stand on the bench that most examples share: webcam, table, board, ball. All of it assumed."""

import numpy as np

from ir50p_lab.inputs import vectors3
from ir50p_lab.vision.board_pose import transform
from ir50p_lab.vision.pinhole import Pinhole
from ir50p_lab.vision.rendering.scene import Scene, SceneBall

# Assumed: an ordinary VGA webcam (thesis intro 5.3: 640x480) with 49 deg across: f = 320 / tan(24.5 deg) = 700 px.
# Nobody's pixels are exactly square, nor is a lens exactly over the middle; the barrel distortion is that of a cheap
# plastic lens (k1 = -0.12 moves the corner of the picture by 20 px).
# One for all scenes: `grid_rays` keeps its rays.
_PINHOLE = Pinhole([[702.0, 0.0, 323.5], [0.0, 699.0, 236.0], [0.0, 0.0, 1.0]], (-0.12, 0.08, 0.0008, -0.0006, 0.0))
# Assumed: on a stand across the table from the arm, whose stretched tip reaches x = 0.57 m and so cannot hit it. Tilted
# by about 45 deg, it sees the whole work area, and a ball of radius 30 mm is 24 px large (thesis 4.5.1: 18 px).
CAMERA_BENCH = (1.0, 0.05, 0.62)
LOOKS_AT_BENCH = (0.40, 0.0, 0.0)


def look_at(position, target):
    """T_cam_world (4, 4) of a camera at `position` (3,) m that looks at `target` (3,) m, picture upright.

    Not straight up or down: then no direction is upright.
    """
    z = np.subtract(target, position)
    z = z / np.linalg.norm(z)
    x = np.cross(z, (0.0, 0.0, 1.0))
    x = x / np.linalg.norm(x)
    R = np.stack([x, np.cross(z, x), z])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -R @ position
    return T


def pose(position, rotation_vector=(0.0, 0.0, 0.0)):
    """T_world_thing (4, 4) at `position` (3,) m, turned by `rotation_vector` (3,) rad (axis times angle)."""
    return transform(vectors3("rotation_vector", rotation_vector), vectors3("position", position, unit="m"))


def bench_camera():
    """(Pinhole, T_cam_world) of the webcam on its stand across the table from the arm: the shared default."""
    return _PINHOLE, look_at(CAMERA_BENCH, LOOKS_AT_BENCH)


def bench_scene(*objects, **changes):
    """The default bench with these objects (default: one red ball); `changes` are fields of Scene."""
    pinhole, T_cam_world = bench_camera()
    scene = {"pinhole": pinhole, "T_cam_world": T_cam_world, "objects": objects or (SceneBall(),)}
    return Scene(**(scene | changes))
