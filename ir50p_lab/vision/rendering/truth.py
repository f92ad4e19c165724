"""What is really there: the truth beside each rendered picture."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.vision.pinhole import Pinhole


@dataclass(frozen=True, kw_only=True)
class BallTruth:
    """One ball of the picture.

    x, y: projected centre of the sphere, pixels. radius: of the circle with the area of its image, pixels.
    outline_x, outline_y: centre of area of its image; a sphere's image is an ellipse whose middle is not where the
    sphere's centre is seen. All NaN for a ball beside or behind the camera. position: (3,) m in world coordinates;
    colour: name or (r, g, b).
    """

    x: float
    y: float
    radius: float
    outline_x: float
    outline_y: float
    position: tuple
    colour: str | tuple


@dataclass(frozen=True, kw_only=True, eq=False)
class SceneTruth:
    """Of one rendered picture: balls in the order of the scene, camera, scene."""

    balls: tuple
    pinhole: Pinhole
    scene: object

    @property
    def red_balls(self):
        """Those of the colour "red", largest first."""
        return tuple(sorted((ball for ball in self.balls if ball.colour == "red"), key=lambda ball: -ball.radius))


def ball_truth(pinhole, T_cam_world, ball):
    """BallTruth of a SceneBall."""
    x = y = radius = outline_x = outline_y = float("nan")
    centre = T_cam_world[:3, :3] @ np.asarray(ball.position, dtype=float) + T_cam_world[:3, 3]
    nearest = centre[2] - ball.radius
    if nearest > 1e-3 and (np.hypot(*centre[:2]) + ball.radius) / nearest < pinhole.widest:
        x, y = map(float, pinhole.project(np.eye(4), centre))
        area, outline_x, outline_y = _area_and_centre(sphere_rim(pinhole, centre, ball.radius))
        radius = float(np.sqrt(area / np.pi))
    return BallTruth(
        x=x, y=y, radius=radius, outline_x=outline_x, outline_y=outline_y, position=ball.position, colour=ball.colour
    )


def sphere_rim(pinhole, centre, radius, n=256):
    """Outline (n, 2) pixels of a sphere: the circle where rays from the camera touch it, projected."""
    D = np.linalg.norm(centre)
    axis = centre / D
    side, up = np.linalg.svd(axis[None])[2][1:]  # across it
    a = np.arange(n)[:, None] * (2 * np.pi / n)
    rim = centre - radius**2 / D * axis + radius * np.sqrt(1 - (radius / D) ** 2) * (np.cos(a) * side + np.sin(a) * up)
    return pinhole.project(np.eye(4), rim)


def _area_and_centre(rim):
    """Area and centre of area of a polygon (n, 2)."""
    import cv2

    middle = rim.mean(axis=0)  # OpenCV's polygons are in single precision
    moments = cv2.moments((rim - middle).astype(np.float32))
    x, y = middle + np.array([moments["m10"], moments["m01"]]) / moments["m00"]
    return moments["m00"], float(x), float(y)
