"""The kernel of (3.2), the convolution, and the four steps of Canny against OpenCV, pixel by pixel."""

import cv2
import numpy as np
import pytest
from drawn_balls import add_ball, empty, photograph
from scipy import ndimage

from ir50p_lab.errors import InputError
from ir50p_lab.vision import KERNEL_3_2, canny_steps, convolve, gaussian_kernel

GREY = cv2.cvtColor(photograph(add_ball(empty(grain=0.1), 700, (300, 200), 60), noise=6), cv2.COLOR_RGB2GRAY)[
    100:320, 180:420
]


def test_kernel_of_the_thesis_is_nearly_a_gaussian():
    assert KERNEL_3_2.sum() == pytest.approx(1)
    assert round(KERNEL_3_2[0, 0] * 159) == 2 and round(KERNEL_3_2[2, 2] * 159) == 15
    off = [np.abs(KERNEL_3_2 - gaussian_kernel(5, sigma)).max() for sigma in (1.0, 1.4, 1.8)]
    assert off[1] == min(off) and off[1] < 0.0031


def test_gaussian_kernel_against_opencv():
    line = cv2.getGaussianKernel(9, 1.7)
    np.testing.assert_allclose(gaussian_kernel(9, 1.7), line @ line.T, atol=1e-12)


def test_convolution_against_scipy():
    kernel = np.random.default_rng(1).normal(size=(3, 5))
    np.testing.assert_allclose(
        convolve(GREY, kernel), ndimage.convolve(GREY.astype(float), kernel, mode="mirror"), atol=1e-9
    )


@pytest.mark.parametrize(("low", "high"), [(0, 0), (30, 90), (80, 80), (100, 180), (400, 2000)])
@pytest.mark.parametrize("smooth", [True, False])
def test_edges_are_the_crests_that_hang_on_a_strong_one(low, high, smooth):
    steps = canny_steps(GREY, low, high, kernel=KERNEL_3_2 if smooth else None)
    pieces, _ = ndimage.label(steps.thin > low, structure=np.ones((3, 3)))
    assert (steps.edges == np.isin(pieces, pieces[steps.thin > high])).all()
    assert high > 1000 or steps.edges.any()


def test_each_step_leaves_less():
    steps = canny_steps(GREY, 60, 150, kernel=KERNEL_3_2)
    assert (steps.strength > 60).sum() > 2 * (steps.thin > 60).sum() > 2 * 0
    assert (steps.thin > 150).sum() < steps.edges.sum() < (steps.thin > 60).sum()
    gx, gy = (
        cv2.Sobel(steps.smoothed, cv2.CV_64F, *axis, borderType=cv2.BORDER_REPLICATE) for axis in ((1, 0), (0, 1))
    )
    np.testing.assert_array_equal(steps.strength, np.abs(gx) + np.abs(gy))


def test_bad_arguments():
    with pytest.raises(InputError, match="low"):
        canny_steps(GREY, 90, 30)
    with pytest.raises(InputError, match="odd"):
        gaussian_kernel(4, 1)
    with pytest.raises(InputError, match="sigma"):
        gaussian_kernel(5, 0)
    with pytest.raises(InputError, match="odd size"):
        convolve(GREY, np.ones((2, 2)))
