"""From the picture to the base frame of the arm: where the ball is, and where the camera sees the hand."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import VisionError
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.vision.arguments import rigid
from ir50p_lab.vision.ball.colour import RED, Colour
from ir50p_lab.vision.ball.find import find_balls
from ir50p_lab.vision.board_pose import inverse_transform, transform_points

GREEN = Colour(hue=135.0, tolerance=35.0, name="green")  # of the marker on the hand
MARKER_AT = (-0.042, 0.0, 0.0)  # m, tool coordinates: between the fingers, before the end of the forearm
_MARKER_NEAR = 80.0  # px, some 90 mm: if a green ball is farther from where q puts the marker, it is not the marker
_SPIKE = 5.0  # standard errors: if the picture asks a potentiometer to be off by more, one of both is wrong


@dataclass(frozen=True, eq=False)
class Seen:
    """What one look found.

    position: (3,) m, the ball's centre in the base frame, or None if there was no ball (then `reason` says why); ball:
    Ball in pixels; image: RGB; simulated: whether the picture was rendered.
    """

    position: np.ndarray | None
    ball: object
    image: np.ndarray = field(repr=False)
    simulated: bool
    reason: str = ""

    def __bool__(self):
        return self.position is not None


class BallLocator:
    """A camera that knows where it stands: it finds ball and hand in the base frame of the arm.

    Args:
        camera: what `open_camera()` gives, or anything with read() -> frame with .image (RGB) and .simulated.
        plane: TablePlane of that camera. T_base_table: (4, 4), takes table to base coordinates; default the
        identity: the board was laid out in base coordinates. (The thesis calls the table's frame 'world', and never
        writes this transform down.)
        radius: of the ball, m. colour: Colour of the ball. marker_at: (3,) m, centre of the small ball on the hand in
        tool coordinates (frame 3: origin at the tip, x along the forearm).

    Attributes: marker: Colour of the small ball on the hand, GREEN; sigma_px: standard error of a centre, px.
    """

    marker, sigma_px = GREEN, 0.3

    def __init__(self, camera, plane, *, T_base_table=None, radius=0.03, colour=RED, marker_at=MARKER_AT):
        self.camera, self.plane, self.colour = camera, plane, colour
        self.T_base_table = np.eye(4) if T_base_table is None else rigid("T_base_table", T_base_table)
        self.radius = number("radius", radius, "> 0", unit="m")
        self.marker_at = vector3("marker_at", marker_at, unit="m")

    def look(self):
        """Take a picture and find the best ball in it. Returns Seen, which is false if no ball is seen."""
        frame = self.camera.read()
        return self.seen_in(frame.image, frame.simulated)

    def seen_in(self, image, simulated=False):
        """Find the best ball in a picture (RGB) that was already taken; returns Seen, as `look` does.

        Raises CalibrationError if the picture is of another size than the calibration.
        """
        balls = find_balls(image, self.colour, camera=self.plane.pinhole)
        if not balls:
            return Seen(None, None, image, simulated, balls.reason)
        xy = [balls[0].x, balls[0].y]
        try:
            place = self.plane.to_points(xy, self.radius)
        except VisionError as error:
            return Seen(None, balls[0], image, simulated, str(error))
        return Seen(transform_points(self.T_base_table, place), balls[0], image, simulated)

    def to_image(self, p):
        """Return the pixel (2,) of a point p (3,) m of the base frame."""
        return self.plane.to_image(transform_points(inverse_transform(self.T_base_table), np.asarray(p, dtype=float)))

    def marker_place(self, arm, q):
        """Return where the marker is in the base frame, (3,) m, with the arm at q (3,) rad."""
        return transform_points(frames(arm, q)[3], self.marker_at)

    def marker_pixel(self, arm, q):
        """Return the pixel (2,) where the marker should be seen with the arm at q (3,) rad."""
        return self.to_image(self.marker_place(arm, q))

    def marker_jacobian(self, arm, q, step=1e-5):
        """Return d pixel / d q (2, 3), px/rad, of the marker with the arm at q (3,) rad: by differences."""
        ends = [(self.marker_pixel(arm, q + d), self.marker_pixel(arm, q - d)) for d in step * np.eye(3)]
        return np.column_stack([(forth - back) / (2 * step) for forth, back in ends])

    def find_marker(self, image, arm, q):
        """Return the pixel (2,) of the marker on the hand, sought near where q (3,) rad puts it; None if not seen."""
        expected = self.marker_pixel(arm, q)
        for one in find_balls(image, self.marker, camera=self.plane.pinhole, least_radius=4.0):
            if np.hypot(one.x - expected[0], one.y - expected[1]) < _MARKER_NEAR:
                return np.array([one.x, one.y])
        return None

    def joint_errors(self, arm, q, xy, sigma_q):
        """Return the potentiometers' errors according to the picture: the marker is seen at xy, not where q puts it.

            minimise |xy - project(p(q + e))|^2 / sigma_px^2 + sum (e_i / sigma_q_i)^2

        One pixel gives two equations for three joints. What is missing comes from sigma_q, how far each potentiometer
        is believed to be off, and so does the hand's distance from the camera. Errors of some
        hundredths of a rad move the pixel linearly, so with H = d pixel / d q and P = diag(sigma_q^2) the minimum is
        e = P H^T (H P H^T + sigma_px^2 I)^-1 (xy - project(p(q))).
        Args: arm: Arm; q: (3,) rad; xy: (2,) px; sigma_q: (3,) rad.
        Returns: e (3,) rad. Raises VisionError if the picture contradicts q by more than 5 sigma.
        """
        sigma_q = vector3("sigma_q", sigma_q)
        H, P = self.marker_jacobian(arm, q), np.diag(sigma_q**2)
        e = P @ H.T @ np.linalg.solve(H @ P @ H.T + self.sigma_px**2 * np.eye(2), xy - self.marker_pixel(arm, q))
        if (np.abs(e) > _SPIKE * sigma_q).any():
            off = np.linalg.norm(xy - self.marker_pixel(arm, q))
            raise VisionError(
                f"the hand is seen {off:.0f} px from where the potentiometers put it, more than they can be off: was "
                "something else taken for the marker, did the camera move, or is the arm's calibration wrong?"
            )
        return e
