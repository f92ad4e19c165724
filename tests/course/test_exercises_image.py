"""Exercises of notebook 16: each right answer by another route."""

import colorsys

import cv2
import numpy as np
import pytest

from ir50p_lab.course.exercises import solution
from ir50p_lab.vision import Pinhole


def test_hue_in_the_scale_of_opencv():
    rgb = np.rint(255 * np.array(colorsys.hsv_to_rgb(350 / 360, 1, 1))).astype(np.uint8)
    assert cv2.cvtColor(rgb[None, None], cv2.COLOR_RGB2HSV)[0, 0, 0] == pytest.approx(solution("image-1"), abs=1)


def test_distance_is_the_angle_between_two_directions():
    a, b = np.radians([350.0, 77.0]), np.radians([10.0, 300.0])
    between = np.degrees(np.arccos(np.cos(a - b)))
    np.testing.assert_allclose(solution("image-2")(np.degrees(a), np.degrees(b)), between)


def test_kernel_on_one_white_pixel():
    grey = np.zeros((9, 9), np.float32)
    grey[4, 4] = 255
    kernel = (
        np.float32([[2, 4, 5, 4, 2], [4, 9, 12, 9, 4], [5, 12, 15, 12, 5], [4, 9, 12, 9, 4], [2, 4, 5, 4, 2]]) / 159
    )
    assert cv2.filter2D(grey, -1, kernel)[4, 4] == pytest.approx(solution("image-3"), abs=1e-3)


def test_radius_of_a_ball_by_projection():
    camera = Pinhole.simple(700.0)
    middle, rim = camera.project(np.eye(4), np.array([(0, 0, 0.80), (0.030, 0, 0.80)]))
    assert np.linalg.norm(rim - middle) == pytest.approx(solution("image-4"))


def test_lens_by_two_rays():
    h, alpha, f = 0.001, 0.05, 0.004  # a parallel ray goes through the focus, a middle ray goes straight on
    slopes = np.array([-h / f, -h / alpha])
    beta = h / (slopes[1] - slopes[0])
    assert beta == pytest.approx(solution("image-5"))
