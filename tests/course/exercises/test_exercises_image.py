"""Exercises of notebook 16: each right answer by another route."""

import numpy as np
import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.vision import Pinhole


def test_distance_is_the_angle_between_two_directions():
    a, b = np.radians([350.0, 77.0]), np.radians([10.0, 300.0])
    between = np.degrees(np.arccos(np.cos(a - b)))
    np.testing.assert_allclose(solution("image-2")(np.degrees(a), np.degrees(b)), between)


def test_radius_of_a_ball_by_projection():
    camera = Pinhole.simple(700.0)
    middle, rim = camera.project(np.eye(4), np.array([(0, 0, 0.80), (0.030, 0, 0.80)]))
    assert np.linalg.norm(rim - middle) == pytest.approx(solution("image-4"))
