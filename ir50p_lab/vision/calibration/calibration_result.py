"""What a calibration found: the camera, its errors, the residuals of each picture, and which pictures were not used."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.calibration.file import load, save
from ir50p_lab.vision.pinhole import Pinhole

NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
LENS = NAMES[4:]


@dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """One picture of the board that was used.

    name, index: as in `Rejected`; points: (n, 3) m on the board, for a bent one as estimated; corners: (n, 2) px as
    found; residuals: (n, 2) px, found minus model; rms: of their lengths, px; T_cam_board: (4, 4), takes board to
    camera coordinates.
    """

    name: str
    index: int
    points: np.ndarray = field(repr=False)
    corners: np.ndarray = field(repr=False)
    residuals: np.ndarray = field(repr=False)
    T_cam_board: np.ndarray = field(repr=False)

    @property
    def rms(self):
        """Root mean square distance between found corners and model, px."""
        return float(np.sqrt((self.residuals**2).sum(axis=1).mean()))

    @property
    def tilt(self):
        """Angle between the board and the image plane, rad."""
        return float(np.arccos(np.clip(abs(self.T_cam_board[2, 2]), 0, 1)))


@dataclass(frozen=True, kw_only=True, eq=False)
class Calibration:
    """A calibrated camera; functions that take a Pinhole take it as well (`pinhole.as_pinhole`).

    ============== ======================================================================================== =========
    field          meaning                                                                                  shape
    ============== ======================================================================================== =========
    K              [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]: column form (OpenCV); pixel (0, 0) is the centre  (3, 3) px
                   of the top left one
    distortion     k1, k2, p1, p2, k3 as in `Pinhole`; 0 where not estimated                                (5,)
    rms            root mean square distance between corners and model: sqrt(sum |e|^2 / N)                 px
    stderr         standard error of "fx", "fy", "cx", "cy", "k1"...: the larger of two kinds               dict
                   (`fit.errors`); nan where not estimated. For a bent board they are two to three times
                   too small (halves of one set of photographs differed by 2.3 of them, root mean square)
    covariance     of fx, fy, cx, cy, k1, k2, p1, p2, k3 with those standard errors; 0 where not estimated  (9, 9)
    views          a View for each picture that was used                                                    tuple
    rejected       a Rejected for each picture that was not used, with a reason                             tuple
    warnings       doubts about it, as sentences                                                            tuple
    size           (width, height) of the pictures                                                          px
    board          Checkerboard; None if the points were given
    model          lens coefficients that were estimated, such as ("k1", "k2")                              tuple
    sigma          standard deviation of a corner in x or y, from the residuals                             px
    T_base_cam     where it stands: takes camera to base coordinates; None: unknown                         (4, 4)
    ============== ======================================================================================== =========
    """

    K: np.ndarray
    distortion: np.ndarray
    rms: float
    stderr: dict
    views: tuple = ()
    rejected: tuple = ()
    warnings: tuple = ()
    size: tuple = (640, 480)
    covariance: np.ndarray = field(default_factory=lambda: np.full((9, 9), np.nan), repr=False)
    board: Checkerboard | None = field(default_factory=Checkerboard)
    model: tuple = ()
    sigma: float = np.nan
    T_base_cam: np.ndarray | None = field(default=None, repr=False)

    @property
    def pinhole(self):
        """The camera as a Pinhole: project, undistort_points, rays."""
        return Pinhole(self.K, self.distortion, self.size)

    @property
    def values(self):
        """All nine numbers by name: fx, fy, cx, cy in px, k1, k2, p1, p2, k3."""
        K = self.K
        return dict(zip(NAMES, map(float, (K[0, 0], K[1, 1], K[0, 2], K[1, 2], *self.distortion)), strict=True))

    @property
    def view_rms(self):
        """The rms of each view, px, (v,)."""
        return np.array([view.rms for view in self.views])

    def __getattr__(self, name):
        if name in NAMES:
            return self.values[name]
        raise AttributeError(f"Calibration has no {name!r}")

    def straighten(self, image):
        """Return a picture of this camera without distortion; see `Pinhole.straighten`."""
        return self.pinhole.straighten(image)

    def save(self, path):
        """Write a JSON file in which cv2.FileStorage (and OpenCV's samples) find the camera. Returns the path.

        Raises CalibrationError if that fails.
        """
        return save(self, path)

    @classmethod
    def load(cls, path, size=None):
        """Read a file that `save` wrote.

        size: (width, height) of the pictures for which it is meant. Raises CalibrationError for a file that is missing
        or no calibration, and for one of another picture size.
        """
        return load(cls, View, path, size)

    def __str__(self):
        lines = [
            f"{self.size[0]}x{self.size[1]} camera from {len(self.views)} pictures of a {self.board or 'given board'}, "
            f"rms {self.rms:.3f} px"
        ]
        for name, value in self.values.items():
            if name in NAMES[:4] or name in self.model:
                lines.append(f"  {name}  {value:12.5g} +- {self.stderr.get(name, np.nan):.2g}")
        lines += [f"not used: {one}" for one in self.rejected]
        return "\n".join([*lines, *self.warnings])
