"""Least squares for camera and board poses together, with the covariance of what it finds, by two routes.

`cv2.calibrateCamera` does the first half; it starts the iteration here. It knows no bent board and its standard errors
take every corner for independent, which corners of one picture are not.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ir50p_lab.errors import CalibrationError

NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
LENS = NAMES[4:]
# Of what the camera's numbers do to the corners, a board's pose can hide all but this share: then no view shows them.
# Squared pixels, thus rounding is 1e-15; four views that are nearly one leave 1e-10.
_SHOWN = 1e-12
_UNDETERMINED = "the views leave the camera undetermined: tilt the board in different directions"
_ROUNDING = 1e-10  # pixels: less than this no fit can mend, and corners without noise leave less


@dataclass(frozen=True)
class Model:
    """What is estimated: coefficients of the lens, aspect (None: fx and fy free, or fx/fy), bent board or flat."""

    lens: tuple = LENS
    aspect: float | None = None
    bent: bool = False

    def with_lens(self, names):
        """The same with these coefficients of the lens."""
        return replace(self, lens=tuple(names))

    @property
    def columns(self):
        """B (12, free): the nine numbers of the camera and three of the board's shape from the free parameters."""
        free = [True, not self.aspect, True, True, *(name in self.lens for name in LENS), *[self.bent] * 3]
        B = np.eye(12)[:, free]
        if self.aspect:
            B[1, 0] = 1 / self.aspect
        return B


class Guess(NamedTuple):
    """Where a fit begins: camera and poses as in `CameraFit`."""

    camera: np.ndarray
    poses: np.ndarray


@dataclass(frozen=True, eq=False)
class CameraFit:
    """A camera that fits corners.

    ============== ================================================================================== ============
    camera         fx, fy, cx, cy, k1, k2, p1, p2, k3, and b of the board's shape (see `CornerSets`)     (12,) px, m
    poses          rvec, tvec of the board in each view                                               (v, 6) rad, m
    residuals      seen minus model, one array per view                                               (n, 2) px
    by_corners     covariance of `camera` if every corner errs on its own                             (12, 12)
    by_views       covariance from leaving out one view after the other (jackknife); 0: under 4 views (12, 12)
    model          Model
    ============== ================================================================================== ============
    """

    camera: np.ndarray
    poses: np.ndarray
    residuals: tuple
    by_corners: np.ndarray
    by_views: np.ndarray
    model: Model

    @property
    def points(self):
        """Number of corners."""
        return sum(len(e) for e in self.residuals)

    @property
    def parameters(self):
        """Number of parameters, six of every pose included."""
        return self.model.columns.shape[1] + self.poses.size

    @cached_property
    def cost(self):
        """Sum of the squared residuals, px^2."""
        return float(sum((e**2).sum() for e in self.residuals))

    @property
    def sigma(self):
        """Standard deviation of a corner in x or y, px: cost over degrees of freedom."""
        return float(np.sqrt(self.cost / (2 * self.points - self.parameters)))

    @property
    def rms(self):
        """Root mean square distance between corners and model, px, as OpenCV reports it."""
        return float(np.sqrt(self.cost / self.points))

    @property
    def view_rms(self):
        """The same for each view, (v,)."""
        return np.array([np.sqrt((e**2).sum(axis=1).mean()) for e in self.residuals])

    @property
    def stderr(self):
        """Standard errors (12,): the larger of the two routes; 0 for what was not estimated."""
        return np.sqrt(np.maximum(np.diag(self.by_corners), np.diag(self.by_views)))


class CornerSets:
    """What was seen: points (n, 3) m on the board and pixels (n, 2), one array of each per view; the picture's size.

    For all views alike, those with fewer corners than the fullest filled up by repeating them: all_points (v, n, 3) m,
    seen (v, n, 2) px, there (v, n, 1, 1): 1 for what was seen, 0 for what was filled up; shapes: three ways (v, n, 3)
    in which the board can bend (along x, as a saddle, along y), each 1 at half the board's size from its middle. Its
    height is z = shapes @ b, with b in metres, positive into the board.
    """

    def __init__(self, points, pixels, size):
        self.points = [np.ascontiguousarray(p, dtype=float) for p in points]
        self.pixels = [np.ascontiguousarray(p, dtype=float) for p in pixels]
        self.size = size
        counts = np.array([len(p) for p in self.points])
        most = counts.max()
        self.there = (np.arange(most) < counts[:, None])[..., None, None].astype(float)
        self.all_points = full = np.array([np.resize(p, (most, 3)) for p in self.points])
        self.seen = np.array([np.resize(xy, (most, 2)) for xy in self.pixels])
        low, high = full.min(axis=(0, 1)), full.max(axis=(0, 1))
        x, y = np.moveaxis((2 * full - low - high) / (high - low)[:2].max(), 2, 0)[:2]
        self.shapes = np.stack([x * x, x * y, y * y], axis=2)

    def __len__(self):
        return len(self.points)

    def only(self, views):
        """The same with these views."""
        return CornerSets([self.points[i] for i in views], [self.pixels[i] for i in views], self.size)


def start(corners):
    """First Guess by OpenCV, with two radial terms.

    Raises CalibrationError if the views do not determine a camera at all.
    """
    import cv2

    flags = cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST
    try:
        _, K, d, rvecs, tvecs = cv2.calibrateCamera(
            [p.astype(np.float32) for p in corners.points],
            [p.astype(np.float32) for p in corners.pixels],
            corners.size,
            None,
            None,
            flags=flags,
            criteria=(cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 20, 1e-6),  # `fit` goes on from there
        )
    except cv2.error:
        remedy = "tilt the board in different directions by 20 to 45 degrees, and fill the picture"
        raise CalibrationError(f"OpenCV finds no camera for these {len(corners)} views: {remedy}") from None
    poses = np.hstack([np.array(rvecs).reshape(-1, 3), np.array(tvecs).reshape(-1, 3)])
    camera = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *d.ravel()[:5], 0, 0, 0])
    if not np.isfinite(camera).all() or not np.isfinite(poses).all():
        raise CalibrationError(_UNDETERMINED)
    return Guess(camera, poses)


def project(corners, camera, poses):
    """Residuals of all views (v, 2n), and Jacobians of the model by the camera (v, 2n, 12) and the step of a pose.

    The step of a pose, (v, 2n, 6), is a turn of the board about its origin and a shift, both along the axes of the
    camera. x and y of a corner alternate; views with fewer corners than the fullest are filled up with zeros.
    """
    import cv2
    from scipy.spatial.transform import Rotation

    K = np.array([[camera[0], 0, camera[2]], [0, camera[1], camera[3]], [0, 0, 1]])
    R = Rotation.from_rotvec(poses[:, :3]).as_matrix()
    bent = corners.all_points + (corners.shapes @ camera[9:])[..., None] * (0.0, 0.0, 1.0)
    turned = bent @ R.transpose(0, 2, 1)
    at = (turned + poses[:, None, 3:]).reshape(-1, 3)
    xy, J = cv2.projectPoints(at, np.zeros(3), np.zeros(3), K, camera[4:9])
    views, count = turned.shape[:2]
    J = J.reshape(views, count, 2, -1) * corners.there
    by_shift = J[..., 3:6]
    by_height = by_shift @ R[:, None, :, 2:]  # a point that rises moves as the board does along its z
    parts = (
        (corners.seen - xy.reshape(corners.seen.shape))[..., None] * corners.there,
        np.concatenate([J[..., 6:15], by_height * corners.shapes[:, :, None]], axis=3),
        np.concatenate([np.cross(turned[:, :, None], by_shift), by_shift], axis=3),
    )
    error, by_camera, by_pose = (part.reshape(views, 2 * count, -1) for part in parts)
    return error[..., 0], by_camera, by_pose


def moved_by(poses, step):
    """Poses (v, 6) after a step (v, 6), as `project` means it."""
    from scipy.spatial.transform import Rotation

    turned = Rotation.from_rotvec(step[:, :3]) * Rotation.from_rotvec(poses[:, :3])
    return np.hstack([turned.as_rotvec(), poses[:, 3:] + step[:, 3:]])


def fit(corners, model, guess, steps=50):
    """The camera and poses with the least sum of squares (Levenberg-Marquardt), and their covariance.

    Poses are eliminated view by view (Schur complement), so that a step costs one small system however many views.

    Args: corners: CornerSets; model: Model; guess: what has camera (12,) and poses (v, 6). Returns: CameraFit.
    Raises CalibrationError if it does not converge, or the views leave a parameter undetermined.
    """
    B = model.columns
    camera, poses = _within(model, guess.camera), guess.poses
    with np.errstate(all="ignore"):
        views = project(corners, camera, poses)
        cost, damping = _cost(camera, views), 1e-6
        nothing = views[0].size * _ROUNDING**2
        for _ in range(steps):
            S, g, own, following = reduce(B, *views)
            while True:
                step = solve(S.sum(axis=0), g.sum(axis=0)[:, None], damping)[:, 0]
                part = 1 / max(damping, 1.0)  # the poses overshoot, too
                new_camera, new_poses = camera + part * (B @ step), moved_by(poses, part * (own - following @ step))
                new_views = project(corners, new_camera, new_poses)
                new_cost = _cost(new_camera, new_views)
                if new_cost <= cost * (1 + 1e-12) + nothing or damping > 1e6:
                    break
                damping = max(10 * damping, 1e-6)
            gain = cost - new_cost
            if damping > 1e6:
                raise CalibrationError(
                    "the fit does not converge: a view has corners in a wrong order, is no board, or of another camera"
                )
            camera, poses, views, cost, damping = new_camera, new_poses, new_views, min(cost, new_cost), damping / 10
            if abs(gain) <= 1e-8 * cost + nothing:
                break
    return _with_covariance(corners, model, camera, poses, views)


def _within(model, camera):
    """A camera (12,) with zeros where the model has nothing to estimate, and its aspect."""
    inside = np.where(model.columns.any(axis=1), camera, 0.0)
    if model.aspect:
        f = np.sqrt(camera[0] * camera[1] * model.aspect)
        inside[:2] = f, f / model.aspect
    return inside


def _cost(camera, views):
    cost = (views[0] ** 2).sum()
    return cost if np.isfinite(cost) and camera[0] > 0 and camera[1] > 0 else np.inf


def reduce(B, error, by_camera, by_pose):
    """Of each view: S = U'U and g = U'e with the pose eliminated, its own step, and how the step follows the camera."""
    both = np.concatenate([by_camera @ B, error[..., None]], axis=2)
    turned = by_pose.transpose(0, 2, 1)
    pose = np.linalg.solve(turned @ by_pose, turned @ both)
    left = both[..., :-1].transpose(0, 2, 1) @ (both - by_pose @ pose)
    return left[..., :-1], left[..., -1], pose[..., -1], pose[..., :-1]


def solve(S, g, damping=0.0):
    """Solve S x = g, (..., n, n) and (..., n, k), with the scales of the parameters taken out.

    Raises CalibrationError if S is singular.
    """
    scale = np.sqrt(np.maximum(np.diagonal(S, axis1=-2, axis2=-1), 1e-300))[..., None]
    A = S / (scale * np.swapaxes(scale, -1, -2))
    try:
        x = np.linalg.solve(A + damping * np.eye(A.shape[-1]), g / scale)
    except np.linalg.LinAlgError:
        x = np.full_like(g, np.inf)
    if not np.isfinite(x).all():
        raise CalibrationError(_UNDETERMINED)
    return x / scale


def _with_covariance(corners, model, camera, poses, views):
    B, count = model.columns, len(poses)
    S, g, _, _ = reduce(B, *views)
    total = S.sum(axis=0)
    scale = np.linalg.norm((views[1] @ B).reshape(-1, B.shape[1]), axis=0)
    if not np.linalg.eigvalsh(total / np.outer(scale, scale))[0] > _SHOWN:
        raise CalibrationError(_UNDETERMINED)
    residuals = tuple(e[: 2 * len(p)].reshape(-1, 2) for e, p in zip(views[0], corners.points, strict=True))
    fit = CameraFit(camera, poses, residuals, np.zeros((12, 12)), np.zeros((12, 12)), model)
    if 2 * fit.points <= fit.parameters:
        given = f"{fit.points} corners in {count} views give {2 * fit.points} numbers for {fit.parameters} parameters"
        raise CalibrationError(f"{given}: more views, or a board with more corners")
    by_corners = fit.sigma**2 * solve(total, np.eye(len(total)))
    by_views = np.zeros((12, 12))
    if count > 3:  # what leaving out a view does, to first order
        moves = solve(total - S, g[..., None])[..., 0]
        moves -= moves.mean(axis=0)
        by_views = B @ ((count - 1) / count * moves.T @ moves) @ B.T
    return replace(fit, by_corners=B @ by_corners @ B.T, by_views=by_views)


def pulls(corners, fitted):
    """What each view alone says of (log f, cx / f, cy / f): information S (v, 3, 3) and pull g (v, 3), px^2.

    To first order, with the pose of the view free and all else held: a step d of the camera changes the sum of squares
    of a view by d S d - 2 g d.
    """
    both, f = np.zeros((12, 3)), fitted.camera[:2]
    both[:2, 0], both[2, 1], both[3, 2] = f, *f
    S, g, _, _ = reduce(both, *project(corners, fitted.camera, fitted.poses))
    return S, g
