"""pixel_to_plane: a pixel is a line of sight; where it meets a height is a place."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of


def pixel_to_plane(K, T_base_cam, pixel, height):
    """Return the place (3,) m that an undistorted pixel (2,) shows, `height` m above the table    (4.5.3 corrected)."""
    direction = T_base_cam[:3, :3] @ np.linalg.solve(K, np.array([pixel[0], pixel[1], 1.0]))
    lens = T_base_cam[:3, 3]
    return lens + (height - lens[2]) / direction[2] * direction


def _cameras():
    rng = np.random.default_rng(172)
    cases = []
    for k in range(12):
        K = np.array([[700.0 + 30 * k, 3.0 * k, 320], [0, 690 - 20 * k, 240 + 5 * k], [0, 0, 1]])
        lens = np.array([*rng.uniform(-0.8, 0.9, 2), rng.uniform(0.5, 0.9)])
        z = np.array([*rng.uniform(-0.2, 0.4, 2), 0]) - lens
        z = z / np.linalg.norm(z)
        x = np.cross(z, [0, 0, 1.0]) / np.hypot(*z[:2])
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), lens
        cases.append((K, T, rng.uniform((150, 150), (500, 350)), (0.0, 0.03, 0.09, 0.25)[k % 4]))
    return cases


_SAYS = sentences("pixel_to_plane", __file__)


def _symptom(case, returned, expected):
    """Whether it lies on the line of sight, at the height, or on neither."""
    if np.shape(returned) != (3,):
        return ""
    line, seen = (place - case[1][:3, 3] for place in (expected, returned))
    if np.allclose(np.cross(line, seen) / np.linalg.norm(line), 0, atol=1e-6):
        return _SAYS["line"]
    return _SAYS["height"] if abs(returned[2] - case[3]) < 1e-6 else ""


TASK = task_of(pixel_to_plane, cases=_cameras, symptom=_symptom, entry_names=("x", "y", "z"), unit="m")
