"""From a pixel to a place on the table, or at a height above it (4.5.3 corrected), with its standard error."""

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError, VisionError
from ir50p_lab.inputs import number
from ir50p_lab.vision.board_pose import BoardPose, board_points, board_pose, inverse_transform, rvec_tvec, transform
from ir50p_lab.vision.checks import check_picture_size, point_list, rigid
from ir50p_lab.vision.pinhole import Pinhole, as_pinhole

_SMALL = 1e-3  # standard deviations: steps of derivatives
_SLANT = 0.02  # rad above the plane; a ray flatter than this meets it anywhere


class TablePlane:
    """Planes parallel to the table, as a calibrated camera sees them.

    With x_n = (x_n, y_n, 1) the pixel after removing the distortion and K, and T_cam_table = [r1 r2 r3 t],

        s x_n = H (X, Y, 1),  H = [r1  r2  t + h r3]                                       (4.5.3 corrected)

    for the plane at height h. The thesis inverts [R; t] K, which is 4x3 and has no inverse: the third row of [R; t]
    must go, and with it Z, which is known, not found. In its row notation H^T = [r1; r2; t + h r3].

    Args:
        camera: Pinhole or Calibration, whose covariance counts (a Pinhole is exactly known).
        T_cam_table: (4, 4), takes coordinates of the table (z up, 0 on its surface) to those of the camera (z forward,
        y down), exactly known; or a BoardPose with its errors.

    Attributes: camera; T_cam_table; rms: px, of the board it was made from, or None; centre: (3,) m, of the lens.
    Raises InputError if T_cam_table is no rigid transform, a shape is wrong, or the camera lies below the table.
    """

    def __init__(self, camera, T_cam_table):
        self.camera, self.pinhole = camera, as_pinhole(camera)
        pose = T_cam_table
        if not isinstance(pose, BoardPose):
            pose = BoardPose(rigid("T_cam_table", pose).copy(), np.zeros((6, 6)), np.zeros((6, 9)), rms=None)
        self._pose, self.T_cam_table, self.rms = pose, pose.T_cam_board, pose.rms
        self.centre = inverse_transform(self.T_cam_table)[:3, 3]
        if self.centre[2] <= 0:
            raise InputError(
                f"the camera would be {-self.centre[2]:.3g} m below the table: T_cam_table takes table to camera "
                "coordinates (is it inverted?), and z of the table points up (is the board's first corner right?)"
            )

    @classmethod
    def from_board(cls, camera, corners, points):
        """The plane from a board that lies at a known place on the table.

        Args: camera: Pinhole or Calibration; corners: (n, 2) px, as found; points: (n, 3) m, the same corners in table
        coordinates (`board_points`).
        The standard errors then hold the scatter of the corners, and that an error of the camera's own numbers
        shifts this pose with it: most of it cancels near the board.
        Raises as `board_pose`.
        """
        return cls(camera, board_pose(camera, corners, points))

    @classmethod
    def from_picture(cls, camera, image, pattern=(9, 6), square=0.025, T_table_board=None):
        """The plane from a picture (RGB) of a checkerboard that lies at T_table_board; see `board_points`.

        Raises CalibrationError for a picture of another size than the calibration's, and if the board is not found,
        with the reason; else as `from_board`.
        """
        from ir50p_lab.vision.calibration.corners import find_checkerboard
        from ir50p_lab.vision.calibration.reasons import NotUsable
        from ir50p_lab.vision.image import to_grey

        grey = to_grey(image)
        check_picture_size(camera, grey.shape[::-1])
        try:
            corners = find_checkerboard(grey, pattern).xy
        except NotUsable as why:
            raise CalibrationError(f"the board on the table is not found: {why}") from None
        return cls.from_board(camera, corners, board_points(pattern, square, T_table_board))

    def homography(self, height=0.0):
        """H (3, 3) of the plane at `height` m: s (x_n, y_n, 1) = H (X, Y, 1)."""
        R, t = self.T_cam_table[:3, :3], self.T_cam_table[:3, 3]
        return np.column_stack([R[:, 0], R[:, 1], t + number("height", height, unit="m") * R[:, 2]])

    def to_table(self, xy, height=0.0):
        """Places (n, 2) m on the plane at `height` m for pixels (n, 2); a single pixel (2,) gives (2,).

        Args:
            xy: px, centre of the top-left pixel (0, 0); distorted, as in the picture. Of a ball, where its centre is
            seen, as `find_balls` gives it: the middle of its outline lies a little farther from that of the picture.
            height: m above the table; a ball of radius r on the table has its centre at height r. Read at height 0
            it seems farther away, by r times the tangent of the camera's angle from the vertical.

        Raises InputError on bad pixels; VisionError for a pixel whose line of sight does not meet the plane.
        """
        points, height = point_list("xy", xy, 2), number("height", height, unit="m")
        rays = np.column_stack([self.pinhole.undistort_points(points), np.ones(len(points))])
        R, t = self.T_cam_table[:3, :3], self.T_cam_table[:3, 3]
        down = -(rays @ R)[:, 2] / np.linalg.norm(rays, axis=1)  # of the line of sight, towards the table
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
        """The same with the height as third coordinate: (n, 3) or (3,) m, table coordinates."""
        place = self.to_table(xy, height)
        return np.concatenate([place, np.full((*place.shape[:-1], 1), float(height))], axis=-1)

    def to_image(self, points):
        """Where points (n, 3) or (3,) m of the table appear: (n, 2) or (2,) px."""
        return self.pinhole.project(self.T_cam_table, points)

    def standard_error(self, xy, height=0.0, *, sigma_px=0.3):
        """Standard errors of x and y, (n, 2) m ((2,) for one pixel), of pixel, camera and pose, to first order.

        Args: sigma_px: standard error of each pixel coordinate.
        """
        points, changes = point_list("xy", xy, 2), []
        for step in 1e-2 * np.eye(2):
            forth, back = self.to_table(points + step, height), self.to_table(points - step, height)
            changes.append(sigma_px * (forth - back) / 2e-2)
        here = self.to_table(points, height)
        changes += [(one.to_table(points, height) - here) / _SMALL for one in self.variations(_SMALL)]
        found = np.sqrt(np.square(changes).sum(axis=0))
        return found[0] if np.ndim(xy) == 1 else found

    def variations(self, part=1.0):
        """Planes wrong by (a part of) one standard deviation, in each independent direction of camera and pose errors.

        Whatever is computed from the plane spreads by the root of the summed squares of its changes: a list of
        TablePlane, empty if everything is exactly known.
        """
        known = getattr(self.camera, "covariance", None)  # (9, 9), of fx, fy, cx, cy, k1, k2, p1, p2, k3
        camera = np.zeros((9, 9)) if known is None or not np.isfinite(known).all() else known
        both = np.vstack([np.eye(9), self._pose.by_camera])
        P = both @ camera @ both.T
        P[9:, 9:] += self._pose.covariance
        scale = np.sqrt(np.where(np.diag(P) > 0, np.diag(P), 1.0))  # px, 1, rad and m: alike before the eigenvectors
        sizes, directions = np.linalg.eigh(P / np.outer(scale, scale))
        found = []
        for size, direction in zip(sizes, directions.T, strict=True):
            if size < 1e-12:
                continue
            d = part * np.sqrt(size) * scale * direction
            K, distortion = self.pinhole.K.copy(), self.pinhole.distortion + d[4:9]
            K[[0, 1, 0, 1], [0, 1, 2, 2]] += d[:4]
            pose = np.concatenate(rvec_tvec(self.T_cam_table)) + d[9:]
            found.append(TablePlane(Pinhole(K, distortion), transform(pose[:3], pose[3:])))
        return found
