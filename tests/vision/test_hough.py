"""Votes for circles: four points of Figure 3.7, a noisy outline, and OpenCV's transform on the same picture."""

import cv2
import numpy as np
import pytest
from drawn_balls import circle_corners

from ir50p_lab.errors import InputError
from ir50p_lab.vision import circle_hough, circle_votes, strongest


def test_four_points_meet_in_the_centre():
    points = circle_corners((50, 40), 25, 4, 0.3)
    votes = circle_votes(points, (90, 110), 25, width=2)
    assert votes.max() == 4
    y, x = np.nonzero(votes == 4)
    assert np.hypot(x.mean() - 50, y.mean() - 40) < 1


@pytest.mark.parametrize("radius", [5, 10, 18])
def test_a_point_draws_a_circle_around_itself(radius):
    """Over all radii: a cone, as below (3.3)."""
    votes = circle_votes([(20, 30)], (60, 60), radius)
    y, x = np.nonzero(votes)
    assert np.abs(np.hypot(x - 20, y - 30) - radius).max() < 0.5
    assert votes.sum() == pytest.approx(2 * np.pi * radius, rel=0.15)


def test_unknown_radius_among_noise():
    rng = np.random.default_rng(0)
    points = np.r_[circle_corners((61, 47), 22, 120)[:80], rng.uniform(0, 100, (120, 2))]
    radii = np.arange(15, 31)
    x, y, r, share = strongest(circle_hough(points, (100, 120), radii, width=1.5), radii)
    assert np.hypot(x - 61, y - 47) <= 1.5 and abs(r - 22) <= 1 and 0.3 < share < 1.2


def test_opencv_finds_the_same_circle():
    picture = np.full((160, 200), 60, np.uint8)
    cv2.circle(picture, (90, 70), 34, 180, -1, cv2.LINE_AA)
    edges = cv2.Canny(picture, 60, 150)
    y, x = np.nonzero(edges)
    radii = np.arange(25, 45)
    ours = strongest(circle_hough(np.column_stack([x, y]), picture.shape, radii), radii)
    theirs = cv2.HoughCircles(picture, cv2.HOUGH_GRADIENT, 1, 50, param1=150, param2=20, minRadius=25, maxRadius=45)[
        0, 0
    ]
    np.testing.assert_allclose(ours[:3], theirs, atol=2)
    np.testing.assert_allclose(ours[:3], (90, 70, 34), atol=1.5)


def test_votes_outside_are_lost_not_wrapped():
    votes = circle_votes([(0, 0)], (30, 30), 10)
    assert votes[20:].sum() == votes[:, 20:].sum() == 0


def test_bad_arguments():
    with pytest.raises(InputError, match="shape"):
        circle_votes([1, 2, 3], (9, 9), 3)
    with pytest.raises(InputError, match="radius"):
        circle_votes([(1, 2)], (9, 9), 0)
    with pytest.raises(InputError, match="nan"):
        circle_votes([(np.nan, 2)], (9, 9), 3)
