"""One picture of the board, as a calibration keeps it."""

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """One picture of the board that was used.

    name, index: as in `Rejected`; points (n, 3) m on the board; corners (n, 2) px as found; residuals (n, 2) px, found
    minus model; rms: of their lengths, px; T_cam_board (4, 4) takes board to camera coordinates.
    """

    name: str
    index: int
    points: np.ndarray = field(repr=False)
    corners: np.ndarray = field(repr=False)
    residuals: np.ndarray = field(repr=False)
    T_cam_board: np.ndarray = field(repr=False)

    @property
    def rms(self):
        """Root mean square distance between found and model corners, px."""
        return float(np.sqrt((self.residuals**2).sum(axis=1).mean()))

    @property
    def tilt(self):
        """Angle between the board and the plane of the picture, rad."""
        return float(np.arccos(np.clip(abs(self.T_cam_board[2, 2]), 0, 1)))
