"""Figures of notebook 10: drawn from a small calibration, and saying what they show."""

import numpy as np
import pytest
from board_pictures import LENS, SIZE, K, corner_sets
from matplotlib.text import Text

from ir50p_lab.course import calibration_views as views
from ir50p_lab.course.vision_views import STAMP
from ir50p_lab.vision import Checkerboard, Pinhole, Reason, Rejected, calibrate_corners


@pytest.fixture(scope="module")
def calibration():
    points = Checkerboard().points
    return calibrate_corners(points, corner_sets(points, 5, seed=1), SIZE)


@pytest.fixture(scope="module")
def images():
    return [np.full((480, 640, 3), 60 * k, np.uint8) for k in range(5)]


def text_of(figure):
    figure.canvas.draw()
    return " ".join(text.get_text() for text in figure.findobj(Text))


def test_every_figure_of_pictures_says_that_they_are_rendered(calibration, images):
    truth = Pinhole(K, LENS, SIZE)
    drawn = {
        "residuals": views.residual_figure(images, calibration, 2),
        "standard errors of every number": views.estimate_figure(calibration, truth),
        "Best next view": views.coverage_figure(calibration),
        "Board taken for flat": views.board_residual_figure(calibration, calibration),
        "Table 4.8": views.table_figure(images[0], np.ones((4, 2)), {"ours": np.zeros((4, 2))}),
    }
    for words, figure in drawn.items():
        text = text_of(figure)
        assert words in text and STAMP in text


def test_contact_sheet_names_the_reason(calibration, images):
    from dataclasses import replace

    lost = replace(calibration, views=calibration.views[:4], rejected=(Rejected("x", 4, Reason.BLURRED, "soft"),))
    assert "blurred" in text_of(views.contact_sheet(images, lost))


def test_lens_view_moves_lines_as_the_lens_does():
    view = views.LensView(Pinhole.simple(700))
    straight = [line.copy() for line in view._lines.get_segments()]
    assert view.update() == "the outermost point moves by 0.0 px"
    assert "moves by" in view.update(k1=-0.3) and float(view.update(k1=-0.3).split()[-2]) > 20
    bent = view._lines.get_segments()
    lens = Pinhole(view.pinhole.K, (-0.3, 0), SIZE)
    assert np.allclose(bent[0], lens.to_pixels(lens.distort(view.pinhole.to_normalised(straight[0]))))
