"""From a pixel to a place on the table, or at a height above it (4.5.3 corrected)."""

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError, VisionError
from ir50p_lab.inputs import number
from ir50p_lab.vision.arguments import check_picture_size, point_list, rigid
from ir50p_lab.vision.board_pose import board_points, board_pose, inverse_transform
from ir50p_lab.vision.pinhole import as_pinhole

_SLANT = 0.02  # rad: if a line of sight meets the plane at a smaller angle, where it does is unknown


class TablePlane:
    """Planes parallel to the table, as a calibrated camera sees them.

    With x_n = (x_n, y_n, 1) the pixel after removing the distortion and K, and T_cam_table = [r1 r2 r3 t],

        s x_n = H (X, Y, 1),  H = [r1  r2  t + h r3]                                       (4.5.3 corrected)

    for the plane at height h. The thesis inverts [R; t] K, which is 4x3 and has no inverse: the third row of [R; t]
    must be left out, and with it Z, which is known and need not be found. In its row notation H^T = [r1; r2; t + h r3].

    Args:
        camera: Pinhole or Calibration.
        T_cam_table: (4, 4), takes coordinates of the table (z up, 0 on its surface) to those of the camera (z forward,
        y down).

    Attributes: camera; T_cam_table; rms: px, of the board from which it was made, or None; centre: of the lens, (3,) m.
    Raises InputError if T_cam_table is not a rigid transform, a shape is wrong, or the camera lies below the table.
    """

    def __init__(self, camera, T_cam_table, rms=None):
        self.pinhole, self.T_cam_table, self.rms = as_pinhole(camera), rigid("T_cam_table", T_cam_table).copy(), rms
        self.centre = inverse_transform(self.T_cam_table)[:3, 3]
        if self.centre[2] <= 0:
            raise InputError(
                f"the camera would be {-self.centre[2]:.3g} m below the table: T_cam_table takes table to camera "
                "coordinates (is it inverted?), and z of the table points up (is the board's first corner right?)"
            )

    @classmethod
    def from_board(cls, camera, corners, points):
        """Make the plane from a board that lies at a known place on the table.

        Args: camera: Pinhole or Calibration; corners: (n, 2) px, as found; points: (n, 3) m, the same corners in table
        coordinates (`board_points`).
        Raises the same as `board_pose`.
        """
        return cls(camera, *board_pose(camera, corners, points))

    @classmethod
    def from_picture(cls, camera, image, pattern=(9, 6), square=0.025, T_table_board=None):
        """Make the plane from a picture (RGB) of a checkerboard that lies at T_table_board; see `board_points`.

        Raises CalibrationError for a picture of another size than the calibration's, and, with the reason, if the board
        is not found; else the same as `from_board`.
        """
        from ir50p_lab.vision.calibration.corners import find_checkerboard
        from ir50p_lab.vision.calibration.reject_reasons import NotUsable
        from ir50p_lab.vision.image import to_grey

        grey = to_grey(image)
        check_picture_size(camera, grey.shape[::-1])
        try:
            corners = find_checkerboard(grey, pattern)
        except NotUsable as why:
            raise CalibrationError(f"the board on the table is not found: {why}") from None
        return cls.from_board(camera, corners, board_points(pattern, square, T_table_board))

    def homography(self, height=0.0):
        """Return H (3, 3) of the plane at `height` m: s (x_n, y_n, 1) = H (X, Y, 1)."""
        R, t = self.T_cam_table[:3, :3], self.T_cam_table[:3, 3]
        return np.column_stack([R[:, 0], R[:, 1], t + number("height", height, unit="m") * R[:, 2]])

    def to_table(self, xy, height=0.0):
        """Return the places (n, 2) m on the plane at `height` m that pixels (n, 2) show; a pixel (2,) gives (2,).

        Args:
            xy: px, with (0, 0) the centre of the top left pixel; distorted, as in the picture. For a ball give the
                place where its centre is seen, as `find_balls` does; the middle of its outline lies a little farther
                out.
            height: m above the table; a ball of radius r on the table has its centre at height r. Read at height 0
                it seems farther away, by r times the tangent of the camera's angle from the vertical.

        Raises InputError on bad pixels; VisionError for a pixel whose line of sight does not meet the plane.
        """
        points, height = point_list("xy", xy, 2), number("height", height, unit="m")
        rays = self.pinhole.rays(points)
        R, t = self.T_cam_table[:3, :3], self.T_cam_table[:3, 3]
        down = -(rays @ R)[:, 2]  # of the line of sight, towards the table
        above = -R[:, 2] @ t - height  # of the lens, over the plane
        lost = (down * np.sign(above) < _SLANT) | (above == 0)
        if lost.any():
            raise VisionError(
                f"the pixel {np.round(points[lost][0], 1).tolist()} looks past the plane at height {height:g} m: it "
                "lies at or above the horizon, so no place on the table belongs to it"
            )
        X = np.linalg.solve(self.homography(height), rays.T)
        found = (X[:2] / X[2]).T
        return found[0] if np.ndim(xy) == 1 else found

    def to_points(self, xy, height=0.0):
        """Return the same as `to_table` with the height as third coordinate: (n, 3) or (3,) m, table coordinates."""
        place = self.to_table(xy, height)
        return np.concatenate([place, np.full((*place.shape[:-1], 1), float(height))], axis=-1)

    def to_image(self, points):
        """Return where points (n, 3) or (3,) m of the table appear: (n, 2) or (2,) px."""
        return self.pinhole.project(self.T_cam_table, points)
