"""Where in the picture the board was seen, and where to hold it next so that the camera becomes surer."""

from dataclasses import dataclass, field
from itertools import product

import numpy as np

from ir50p_lab.errors import CalibrationError
from ir50p_lab.vision.board_pose import rvec_tvec
from ir50p_lab.vision.calibration.fit import CornerSets, Model, project, reduce, solve

_CELLS = (6, 8)  # rows, columns of the coverage map
_TILT = np.deg2rad(35)
_NEARLY = 0.9  # of the largest gain: poses that bring as much count as equally good


@dataclass(frozen=True, eq=False)
class Coverage:
    """Corners per cell of the picture.

    counts: (6, 8) corners in each cell, rows from the top; share: part of the cells with any; reach: distance of the
    outermost corner from the optical axis over that of the picture's own corner: beyond it the lens model is a guess.
    """

    counts: np.ndarray
    share: float
    reach: float


@dataclass(frozen=True, eq=False)
class NextView:
    """The picture that would help most.

    outline: (4, 2) px, corners of the board as it should appear; text: what to do; before, after: uncertainty of a
    pixel's direction from the noise of the corners, mean over the picture, px, now and with that picture; new: empty
    cells of the coverage map that it would fill; tried: (place, tilt, after, new) of each pose that fits into the
    picture, the one that makes surest first.
    """

    outline: np.ndarray
    text: str
    before: float
    after: float
    new: int
    tried: tuple = field(repr=False)

    def __str__(self):
        return self.text


def coverage(calibration):
    """Coverage of a Calibration."""
    w, h = calibration.size
    xy = np.concatenate([view.corners for view in calibration.views])
    counts, centre = _counts(xy, calibration.size), calibration.K[:2, 2]
    ends = np.array([[0, 0], [w - 1, 0], [0, h - 1], [w - 1, h - 1]])
    reach = np.linalg.norm(xy - centre, axis=1).max() / np.linalg.norm(ends - centre, axis=1).max()
    return Coverage(counts, float(np.mean(counts > 0)), float(min(reach, 1.0)))


def _counts(xy, size):
    """How many of the pixels (n, 2) lie in each cell of the coverage map, (6, 8)."""
    rows, columns = _CELLS
    x, y = np.clip((xy + 0.5) * (columns, rows) / size, 0, (columns - 1, rows - 1)).astype(int).T
    return np.bincount(columns * y + x, minlength=rows * columns).reshape(_CELLS)


def direction_stderr(calibration, xy):
    """How uncertain the ray of each pixel (n, 2) is, (n,) px: standard error of where its fixed ray falls."""
    J = _ray_jacobian(calibration, np.asarray(xy, dtype=float))
    return np.sqrt(np.einsum("nij,jk,nik->n", J, calibration.covariance, J))


def _ray_jacobian(calibration, xy):
    """d pixel / d (fx, fy, cx, cy, k1, k2, p1, p2, k3) for the fixed rays of pixels (n, 2): (n, 2, 9)."""
    import cv2

    rays = cv2.undistortPointsIter(
        xy[:, None], calibration.K, calibration.distortion, None, None, (cv2.TERM_CRITERIA_COUNT, 20, 0)
    )[:, 0]
    points = np.column_stack([rays, np.ones(len(rays))])
    _, J = cv2.projectPoints(points, np.zeros(3), np.zeros(3), calibration.K, calibration.distortion)
    return J[:, 6:15].reshape(-1, 2, 9)


def next_view(calibration):
    """The board's pose, among 9 places in the picture and 5 tilts, after which the camera would be surest: NextView.

    Corners are taken to be as noisy as those so far. The measure is the standard error of a pixel's direction, mean
    over the picture. It trusts the lens model, for which one corner of the picture is as good as another; so of the
    poses that bring nearly the most the one counts that fills most empty cells of the coverage map: corners where none
    were test the model, too. Raises CalibrationError if the board fits into the picture nowhere.
    """
    B = Model(calibration.model).columns
    camera = np.array([*calibration.values.values(), 0, 0, 0])
    seen = CornerSets([v.points for v in calibration.views], [v.corners for v in calibration.views], calibration.size)
    poses = np.array([np.concatenate(rvec_tvec(v.T_cam_board)) for v in calibration.views])
    S = reduce(B, *project(seen, camera, poses))[0].sum(axis=0)
    w, h = calibration.size
    grid = np.stack(np.meshgrid((np.arange(8) + 0.5) * w / 8, (np.arange(6) + 0.5) * h / 6), axis=-1).reshape(-1, 2)
    J = _ray_jacobian(calibration, grid) @ B[:9]

    def error(information):
        V = calibration.sigma**2 * solve(information, np.broadcast_to(np.eye(len(S)), information.shape))
        return np.sqrt(np.einsum("nij,...jk,nik->...n", J, V, J).mean(axis=-1))

    points = calibration.board.points
    places, tilts, poses = zip(*_candidates(calibration, points), strict=True)
    trial = CornerSets([points] * len(poses), [points[:, :2]] * len(poses), calibration.size)
    views = project(trial, camera, np.array(poses))
    seen_at = points[:, :2] - views[0].reshape(len(poses), -1, 2)
    empty, tried = calibration.coverage.counts == 0, []
    before, after = float(error(S)), error(S + reduce(B, *views)[0]).tolist()
    for place, tilt, surer, xy in zip(places, tilts, after, seen_at, strict=True):
        if (xy > 2).all() and (xy < np.array([w, h]) - 3).all():
            new = int((empty & (_counts(xy, calibration.size) > 0)).sum())
            tried.append(((place, tilt, surer, new), xy))
    if not tried:
        raise CalibrationError("no pose of the board was found that would fit into the picture")
    tried.sort(key=lambda one: one[0][2])
    enough = max(before - _NEARLY * (before - tried[0][0][2]), tried[0][0][2])
    good = [one for one in tried if one[0][2] <= enough]
    (place, tilt, after, new), xy = max(good, key=lambda one: one[0][3])  # of equals the first, the surest
    columns, rows = calibration.board.pattern
    outline = xy[[0, columns - 1, columns * rows - 1, columns * (rows - 1)]]
    text = (
        f"take one with the board {place}, {tilt}: the direction of a pixel would then be known to {after:.2f} px in "
        f"place of {before:.2f} px"
    )
    if new:
        text += f", and {new} empty cell{'s' * (new > 1)} of the map filled"
    return NextView(outline, text, before, after, new, tuple(words for words, _ in tried))


def _candidates(calibration, points):
    """(words for the place, words for the tilt, pose (6,)) of boards that fill about a third of the picture."""
    import cv2

    w, h = calibration.size
    size = np.ptp(points[:, :2], axis=0)
    Z = float(max(calibration.K[0, 0] * size[0] / (0.42 * w), calibration.K[1, 1] * size[1] / (0.42 * h)))
    tilts = {
        "facing the camera": (0, 0),
        "its right side tilted away": (0, -1),
        "its left side tilted away": (0, 1),
        "its upper side tilted away": (-1, 0),
        "its lower side tilted away": (1, 0),
    }
    rows, columns = {"top": 0.27, "middle": 0.5, "bottom": 0.73}, {"left": 0.27, "centre": 0.5, "right": 0.73}
    for row, column, (words, axis) in product(rows, columns, tilts.items()):
        place = "in the middle" if (row, column) == ("middle", "centre") else f"at the {row} {column}"
        turn = np.array([*axis, 0.0]) * _TILT
        aim = Z * np.linalg.solve(calibration.K, [columns[column] * w, rows[row] * h, 1.0])
        middle = cv2.Rodrigues(turn)[0] @ ((points.min(axis=0) + points.max(axis=0)) / 2)
        yield place, words, np.concatenate([turn, aim - middle])
