"""A ball locator without pictures: the truth of a rendered bench, projected, with the noise of a good detection."""

import numpy as np

from ir50p_lab.vision.board_pose import transform_points
from ir50p_lab.vision.reaching.ball_locator import BallLocator, Seen


class QuickLocator(BallLocator):
    """Sees ball and marker of a RenderedBench with `noise` px per coordinate; no picture is drawn."""

    def __init__(self, world, plane, *, noise=0.15, seed=0, **options):
        super().__init__(world, plane, **options)
        self.noise, self.rng, self.blind = noise, np.random.default_rng(seed), False
        self.no_ball = ""

    def _pixel(self, p):
        return self.camera.scene.pinhole.project(self.camera.scene.T_cam_world, p) + self.rng.normal(0, self.noise, 2)

    def look(self):
        if self.no_ball:
            return Seen(None, None, None, True, self.no_ball)
        xy = self._pixel(self.camera.balls_true[0])
        place = transform_points(self.T_base_table, self.plane.to_points(xy, self.radius))
        return Seen(place, None, None, True)

    def find_marker(self, image, arm, q):
        return None if self.blind else self._pixel(self.marker_place(arm, self.camera.bench.plant.q_true))
