"""The fit of a camera to the corners of a board by OpenCV, and how far each of its numbers may be off."""

from dataclasses import dataclass

import cv2
import numpy as np
from scipy.linalg import block_diag

from ir50p_lab.errors import CalibrationError
from ir50p_lab.vision.board_pose import transform, transform_points
from ir50p_lab.vision.calibration.calibration_result import LENS, NAMES

_STOP = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 50, 1e-9)
_BENT = 0.75  # variance of residuals with every corner free over that with a flat board: if less, the board is bent
_GAUGE = 7  # gauge freedoms of a free board: position 3, rotation 3, scale 1
_ANOTHER = 0.75  # median residual of a view with another lens over that with the one asked for: if less, it is another
_WIDE = np.deg2rad(40)  # if no corner lies farther off the axis, a fisheye hardly differs from the lens of the model
_HALF = 5  # views: with fewer in a half, the halves are not compared
_ALIKE = 0.5  # cosine between the heights of two halves: if it is less, they show different boards
_UNKNOWN = 1e-11  # if an eigenvalue of the scaled normal matrix is smaller, it is rounding: something is undetermined
_FISHEYE = (
    "a fisheye: its outermost corners lie {:.0f} degrees off the axis, and are {:.2g} px off this model, {:.2g} px off "
    "a fisheye's. K and distortion do not hold: a lens of less than 100 degrees, or undistort with cv2.fisheye first"
)
_FEW = "the lens needs more than {}, with which corners are {:.2g} px off, with all {:.2g} px: give lens={}"


@dataclass(frozen=True, eq=False)
class CameraFit:
    """A camera fitted to corners.

    camera: (9,) fx, fy, cx, cy px, k1, k2, p1, p2, k3; points: (n, 3) m of each view; poses: (rvec, tvec) of each;
    residuals: (n, 2) px of each, found minus model; bent: whether the points were estimated with the camera.
    """

    camera: np.ndarray
    points: list
    poses: list
    residuals: list
    bent: bool = False

    @property
    def K(self):
        """Intrinsic matrix (3, 3) px."""
        fx, fy, cx, cy = self.camera[:4]
        return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])

    @property
    def squares(self):
        """The sum of squared residuals, px^2."""
        return sum((e**2).sum() for e in self.residuals)

    @property
    def freedom(self):
        """Degrees of freedom of the residuals: measured numbers minus those estimated (nine of the camera)."""
        shape = 3 * len(self.points[0]) - _GAUGE if self.bent else 0
        return max(1, sum(e.size for e in self.residuals) - 6 * len(self.poses) - len(self.camera) - shape)

    @property
    def view_rms(self):
        """Root mean square length of the residuals of each view, px."""
        return np.sqrt([(e**2).sum(axis=1).mean() for e in self.residuals])


def fit(points, pixels, size, lens, start=None):
    """Return the CameraFit of points [(n, 3)] m that are seen at pixels [(n, 2)], by `cv2.calibrateCamera`.

    lens: names of coefficients to estimate; start: K, needed if the points are not flat.
    Raises CalibrationError if OpenCV finds none.
    """
    flags = _flags(lens) | (0 if start is None else cv2.CALIB_USE_INTRINSIC_GUESS)
    try:
        found = cv2.calibrateCamera(*_float32(points, pixels), size, start, None, flags=flags, criteria=_STOP)
    except cv2.error:
        raise _too_much_alike(points) from None
    return _camera_fit(found, cv2.projectPoints, points, pixels)


def _camera_fit(found, project, points, pixels):
    """CameraFit of what OpenCV found: (rms, K, distortion, rvecs, tvecs); project: its function for that lens."""
    _, K, d, *poses = found
    poses = list(zip(*poses, strict=True))
    models = [project(p[None], *pose, K, d)[0].reshape(-1, 2) for p, pose in zip(points, poses, strict=True)]
    residuals = [xy - model for xy, model in zip(pixels, models, strict=True)]
    return CameraFit(np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *d.ravel()[:5]]), points, poses, residuals)


def fit_lens(points, pixels, size, lens):
    """Return the CameraFit, as `fit` does, and a doubt: a sentence if the lens is outside the model, else "".

    A fisheye is fitted as well, and from its K the camera once more (from its own start OpenCV may end far from the
    best fit of a wide lens), also with all coefficients. If not even these leave residuals as small, the lens is a
    fisheye.
    """
    fitted = fit(points, pixels, size, lens)
    try:
        angle, fisheye = _fit_fisheye(points, pixels, size)
        again, full = (fit(points, pixels, size, names, fisheye.K) for names in (lens, LENS))
    except (cv2.error, CalibrationError):  # it is not a fisheye
        return fitted, ""
    fitted = min(fitted, again, key=lambda one: one.squares)
    ours, best, theirs = (np.median(one.view_rms) for one in (fitted, full, fisheye))
    much_less = _ANOTHER * ours - 0.001  # px: of corners without noise only rounding is left
    if theirs < min(much_less, best) and angle > _WIDE:
        return fitted, _FISHEYE.format(np.rad2deg(angle), ours, theirs)
    return fitted, _FEW.format(lens, ours, best, LENS) if best < much_less else ""


def _fit_fisheye(points, pixels, size):
    """(angle of the outermost corner, rad, CameraFit) of a fisheye: `cv2.fisheye.calibrate`. Raises cv2.error.

    A point at an angle theta off the axis is seen at f (theta + k1 theta^3 + k2 theta^5) from the centre (Kannala and
    Brandt 2006); more coefficients are often not found. f begins as if the corner farthest from the middle of the
    picture lay 75 degrees off the axis.
    """
    views, middle = [[np.float64(one)[None] for one in many] for many in (points, pixels)], np.array(size) / 2
    f = np.linalg.norm(np.concatenate(pixels) - middle, axis=1).max() / 1.3
    start = np.array([[f, 0, middle[0]], [0, f, middle[1]], [0, 0, 1]])
    flags = cv2.fisheye.CALIB_USE_INTRINSIC_GUESS | cv2.fisheye.CALIB_RECOMPUTE_EXTRINSIC
    flags |= cv2.fisheye.CALIB_FIX_SKEW | cv2.fisheye.CALIB_FIX_K3 | cv2.fisheye.CALIB_FIX_K4
    found = cv2.fisheye.calibrate(*views, size, start, np.zeros(4), flags=flags, criteria=_STOP)
    fitted = _camera_fit(found, cv2.fisheye.projectPoints, points, pixels)
    views = zip(points, fitted.poses, strict=True)
    X, Y, Z = np.concatenate([transform_points(transform(*pose), board) for board, pose in views]).T
    return np.arctan2(np.hypot(X, Y), Z).max(), fitted


def fit_bent(flat, pixels, size, lens, columns):
    """Return a CameraFit with every corner of the board free if that makes the residuals much smaller; else `flat`.

    `cv2.calibrateCameraRO` (Strobl and Hirzinger 2011) frees the corners; the board keeps the size of its first row of
    `columns` corners.
    """
    many = _float32(flat.points, pixels)
    try:
        _, K, *_, free = cv2.calibrateCameraRO(*many, size, columns - 1, None, None, flags=_flags(lens), criteria=_STOP)
    except cv2.error:  # too few views for so many unknowns
        return flat
    shape = np.float64(free).reshape(-1, 3)
    bent = CameraFit(**vars(fit([shape] * len(pixels), pixels, size, lens, K)) | {"bent": True})
    return bent if bent.squares / bent.freedom < _BENT * flat.squares / flat.freedom else flat


def halves_agree(pixels, flat, size, lens, columns):
    """Return whether every second view shows the board bent as the others do; True if they are too few to tell.

    What no lens explains can look like a bend; then each half of the views finds another one.
    """
    shapes = []
    for part in (slice(0, None, 2), slice(1, None, 2)):
        if len(pixels[part]) < _HALF:
            return True
        shapes.append(fit_bent(fit(flat.points[part], pixels[part], size, lens), pixels[part], size, lens, columns))
    one, other = (heights(each.points[0]) for each in shapes)
    return bool(one @ other > _ALIKE * np.linalg.norm(one) * np.linalg.norm(other))


def heights(points):
    """Return the heights of the points of a board (n, 3) above the plane nearest to them all, m."""
    plane = np.column_stack([points[:, :2], np.ones(len(points))])
    return points[:, 2] - plane @ np.linalg.lstsq(plane, points[:, 2], rcond=None)[0]


def errors(found, lens):
    """Return (covariance (9, 9), sigma px, contradiction) of a CameraFit.

    With J the derivative of all corners by camera, poses and (for a bent board) its points, and sigma^2 the mean
    squared residual, V = sigma^2 (J^T J)^-1 takes the corners as independent. V' = (J^T J)^-1 (sum of g g^T) (J^T J)^-1
    with g = J^T e of a view takes only the views as independent (the sandwich of White 1980). The larger error of each
    number is given. contradiction: error of fx by V' divided by that by V, at least 1.
    Raises CalibrationError if the views do not determine the camera.
    """
    basis = np.eye(9)[:, [name in (*NAMES[:4], *lens) for name in NAMES]]
    used, normal, pulls = basis.shape[1], 0, []
    for points, (turn, shift), e in zip(found.points, found.poses, found.residuals, strict=True):
        J = cv2.projectPoints(points, turn, shift, found.K, found.camera[4:])[1]
        A = J[:, 6:15] @ basis
        if found.bent:  # a corner moves on the board as the whole board moves with it
            A = np.hstack([A, block_diag(*(J[:, 3:6].reshape(-1, 2, 3) @ cv2.Rodrigues(turn)[0]))])
        Q, _ = np.linalg.qr(J[:, :6])
        A = A - Q @ (Q.T @ A)  # what the pose of the view explains as well, tells nothing of the camera
        normal = normal + A.T @ A
        pulls.append(A.T @ e.ravel())
    views, rank = len(pulls), len(normal) - _GAUGE * found.bent
    sigma = np.sqrt(found.squares / found.freedom)
    scale = np.sqrt(np.diag(normal))
    values, vectors = np.linalg.eigh(normal / np.outer(scale, scale))
    if values[-rank] < _UNKNOWN:
        raise _too_much_alike(found.points)
    vectors = vectors[:, -rank:] / scale[:, None]
    inverse = vectors / values[-rank:] @ vectors.T
    by_corners = sigma**2 * inverse[:used, :used]
    by_views = views / (views - 1) * (inverse[:used] @ np.transpose(pulls) @ np.array(pulls) @ inverse[:, :used])
    larger = np.sqrt(np.maximum(np.diag(by_views) / np.diag(by_corners), 1))
    return basis @ (by_corners * np.outer(larger, larger)) @ basis.T, float(sigma), float(larger[0])


def _flags(lens):
    """OpenCV's flags for the coefficients that stay 0."""
    fixed = {"k1": cv2.CALIB_FIX_K1, "k2": cv2.CALIB_FIX_K2, "k3": cv2.CALIB_FIX_K3, "p1": cv2.CALIB_ZERO_TANGENT_DIST}
    return sum(flag for name, flag in fixed.items() if name not in lens)


def _float32(*many):
    return [[np.float32(one) for one in each] for each in many]


def _too_much_alike(points):
    remedy = "tilt the board in different directions by 20 to 45 degrees, and fill the picture"
    return CalibrationError(f"these {len(points)} views determine no camera: {remedy}")
