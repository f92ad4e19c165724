"""The pinhole camera with lens distortion: from points in space to pixels, and from pixels back to rays."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers
from ir50p_lab.vision.arguments import check_picture_size, coordinates, picture_size, rigid
from ir50p_lab.vision.image import check_image

_STEPS = 200  # most iterations that take out distortion: they converge slowly near the radius where it folds back


@dataclass(frozen=True, eq=False)
class Pinhole:
    """A camera: intrinsic matrix, distortion coefficients, size of the picture    (3.8), in column form

    A point X_cam = (X, Y, Z) m in camera coordinates (x right, y down, z forward) has the normalised coordinates
    x = X/Z, y = Y/Z. The lens moves them to

        x_d = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),    r^2 = x^2 + y^2
        y_d = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y

    (the thesis names both kinds of distortion in 3.2.2.1 but gives no formula), and the pixel is K (x_d, y_d, 1).
    The centre of the top left pixel is (0, 0).

    Args:
        K: (3, 3), [[fx, skew, cx], [0, fy, cy], [0, 0, 1]], pixels, in column form; MATLAB prints its transpose.
        distortion: k1, k2, p1, p2, k3 in the order of OpenCV; 0, 2, 4 or 5 numbers, the rest is zero.
        size: (width, height) of the picture, pixels.

    Raises InputError for a K that is not an intrinsic matrix, a wrong number of coefficients, or a size below 1.

    >>> from ir50p_lab.vision import Pinhole
    >>> Pinhole.simple(700).rays([319.5, 239.5])
    array([0., 0., 1.])
    """

    K: np.ndarray
    distortion: np.ndarray = ()
    size: tuple = (640, 480)

    def __post_init__(self):
        object.__setattr__(self, "K", _frozen(_check_K(self.K)))
        object.__setattr__(self, "distortion", _frozen(_check_distortion(self.distortion)))
        object.__setattr__(self, "size", picture_size(self.size))

    @classmethod
    def simple(cls, f, size=(640, 480), distortion=()):
        """Make a Pinhole with square pixels and its axis through the middle of the picture; f: focal length, pixels."""
        width, height = picture_size(size)
        K = [[f, 0, (width - 1) / 2], [0, f, (height - 1) / 2], [0, 0, 1]]
        return cls(K, distortion, (width, height))

    fx = property(lambda self: float(self.K[0, 0]), doc="Focal length over the width of a pixel.")
    fy = property(lambda self: float(self.K[1, 1]), doc="Focal length over the height of a pixel.")
    cx = property(lambda self: float(self.K[0, 2]), doc="Column of the optical axis, pixels.")
    cy = property(lambda self: float(self.K[1, 2]), doc="Row of the optical axis, pixels.")

    def project(self, T_cam_world, X):
        """Return the pixels (n, 2) of the points X (n, 3) m in world coordinates; one point (3,) gives (2,).

        T_cam_world: (4, 4), takes world to camera coordinates.
        Raises InputError for a wrong shape, NaN, or a point that is not in front of the camera.
        """
        T = rigid("T_cam_world", T_cam_world)
        X = coordinates("X", X, 3, "m")
        X_cam = X @ T[:3, :3].T + T[:3, 3]
        depth = X_cam[..., 2]
        if (depth <= 0).any():
            raise InputError(
                f"a point lies {-np.min(depth):.3g} m behind the camera: it has no picture. Check that T_cam_world "
                "takes world to camera coordinates (its inverse is the camera's place in the world)"
            )
        return self.to_pixels(self.distort(X_cam[..., :2] / depth[..., None]))

    def distort(self, xy):
        """Return the distorted normalised coordinates (..., 2) of undistorted ones (..., 2)."""
        xy = coordinates("xy", xy, 2, "normalised coordinates")
        k1, k2, p1, p2, k3 = self.distortion
        x, y = xy[..., 0], xy[..., 1]
        r2 = x * x + y * y
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
        yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
        return np.stack([xd, yd], axis=-1)

    def to_pixels(self, xy):
        """Return the pixels K (x, y, 1) of normalised coordinates (..., 2), without distortion."""
        xy = coordinates("xy", xy, 2, "normalised coordinates")
        return xy @ self.K[:2, :2].T + self.K[:2, 2]

    def to_normalised(self, xy):
        """Return the normalised coordinates (..., 2) of pixels (..., 2); distortion is not removed."""
        return (coordinates("xy", xy, 2) - self.K[:2, 2]) @ np.linalg.inv(self.K[:2, :2]).T

    def undistort_points(self, xy):
        """Return the normalised coordinates (..., 2), with distortion removed, of pixels (..., 2).

        Raises InputError if no point within the picture angle is distorted to that pixel.
        """
        found = self.undistort_or_nan(xy)
        lost = np.isnan(found).any(axis=-1)
        if lost.any():
            first = np.asarray(xy, dtype=float)[lost][0]
            raise InputError(
                f"the lens with distortion {self.distortion.tolist()} sends no ray to pixel {first.tolist()}: the "
                f"pixel is too far outside the picture of {self.size[0]}x{self.size[1]}, or the coefficients are wrong"
            )
        return found

    def undistort_or_nan(self, xy):
        """Return the same as `undistort_points`, by OpenCV's iteration; NaN where the lens sends no ray to a pixel."""
        import cv2

        distorted, k = self.to_normalised(xy), self.distortion
        if not k.any() or not distorted.size:
            return distorted
        stop = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, _STEPS, 1e-13)
        with np.errstate(all="ignore"):
            found = cv2.undistortPointsIter(distorted.reshape(-1, 1, 2), np.eye(3), k, None, None, stop)
            found = found.reshape(distorted.shape)
            # where the distorted radius falls again (folds back), a solution of the polynomial is no ray of the lens
            r2 = (found**2).sum(axis=-1)
            rising = 1 + r2 * (3 * k[0] + r2 * (5 * k[1] + r2 * 7 * k[4])) > 0
            off = np.abs(self.distort(np.nan_to_num(found)) - distorted).sum(axis=-1)
        return np.where((rising & (off < 1e-9))[..., None], found, np.nan)

    def rays(self, xy):
        """Return the unit directions (..., 3), in camera coordinates, along which the pixels (..., 2) look."""
        xy = self.undistort_points(xy)
        d = np.concatenate([xy, np.ones_like(xy[..., :1])], axis=-1)
        return d / np.linalg.norm(d, axis=-1, keepdims=True)

    def straighten(self, image):
        """Return the picture (h, w, 3) without distortion: what the same K sees through a lens that does not bend.

        Raises ImageError for what is not a picture, CalibrationError for one of another size.
        """
        import cv2

        check_picture_size(self, check_image(image).shape[1::-1])
        return cv2.undistort(image, self.K, self.distortion)

    def scaled(self, size):
        """Return the same lens with a picture of another size (width, height); the field of view in x is kept.

        Pixel edges scale, not centres: c' = (c + 1/2) s - 1/2. The height follows from the new size: the same number of
        rows is cropped or added at top and bottom.
        """
        width, height = picture_size(size)
        s = width / self.size[0]
        K = np.array(self.K)
        K[:2, :2] *= s
        K[0, 2] = (self.cx + 0.5) * s - 0.5
        K[1, 2] = (self.cy + 0.5 - self.size[1] / 2) * s + height / 2 - 0.5
        return Pinhole(K, self.distortion, (width, height))


def _frozen(array):
    array.setflags(write=False)
    return array


def _check_K(K):
    K = numbers("K", K, unit="px").copy()
    good = K.shape == (3, 3) and np.isfinite(K).all() and not np.tril(K, -1).any() and (np.diag(K) > 0).all()
    if not good or K[2, 2] != 1:
        raise InputError(
            f"K = {K.tolist()} is not an intrinsic matrix: give the finite 3x3 matrix [[fx, skew, cx], [0, fy, cy], "
            "[0, 0, 1]], fx, fy > 0 (MATLAB prints it transposed: K.T)"
        )
    return K


def _check_distortion(distortion):
    k = numbers("distortion", () if distortion is None else distortion, unit="k1, k2, p1, p2, k3").ravel()
    if len(k) not in (0, 2, 4, 5) or not np.isfinite(k).all():
        raise InputError(f"distortion = {k.tolist()}: give k1, k2, p1, p2, k3 (or the first 0, 2 or 4 of them)")
    return np.concatenate([k, np.zeros(5 - len(k))])


def as_pinhole(camera):
    """Return `camera` as a Pinhole: a Pinhole itself, or that of a Calibration. Raises InputError for anything else."""
    pinhole = camera if isinstance(camera, Pinhole) else getattr(camera, "pinhole", None)
    if not isinstance(pinhole, Pinhole):
        raise InputError(f"camera = {camera!r:.60}: give a Pinhole(K, distortion, size) or a Calibration")
    return pinhole
