"""The lens law (3.4) and the blur off the focal plane, against rays traced through the lens."""

import numpy as np
import pytest

from ir50p_lab.errors import InputError
from ir50p_lab.vision import blur_diameter, image_distance, rays_on_sensor

F, APERTURE = 0.004, 0.002  # m


@pytest.mark.parametrize("alpha", [0.005, 0.1, 0.7, 20.0])
def test_law(alpha):
    beta = image_distance(alpha, F)
    assert 1 / alpha + 1 / beta == pytest.approx(1 / F)
    assert image_distance(beta, F) == pytest.approx(alpha)  # objects and pictures may change places


def test_limits():
    assert image_distance(1e9, F) == pytest.approx(F)
    assert image_distance(F, F) == np.inf
    assert image_distance(F / 2, F) < 0


@pytest.mark.parametrize("alpha", [0.2, 0.5, 0.7, 1.5])
def test_blur_against_rays(alpha):
    heights = rays_on_sensor(alpha, 0.7, F, APERTURE)
    assert np.ptp(heights) == pytest.approx(blur_diameter(alpha, 0.7, F, APERTURE), abs=1e-15)


def test_sharp_only_at_the_focus_and_less_blur_with_a_smaller_opening():
    assert blur_diameter(0.7, 0.7, F, APERTURE) == 0
    far, near = blur_diameter(1.4, 0.7, F, APERTURE), blur_diameter(0.35, 0.7, F, APERTURE)
    assert near > far > 0
    assert blur_diameter(1.4, 0.7, F, APERTURE / 2) == pytest.approx(far / 2)


def test_bad_arguments():
    for alpha, f in ((0, F), (-1, F), (1, 0)):
        with pytest.raises(InputError, match="positive"):
            image_distance(alpha, f)
    with pytest.raises(InputError, match="beyond"):
        blur_diameter(F / 2, 0.7, F, APERTURE)
