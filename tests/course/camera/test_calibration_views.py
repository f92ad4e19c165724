"""Figures of notebook 17: drawn from a small calibration, and saying what they show."""

import numpy as np
import pytest
from board_pictures import SIZE, corner_sets
from matplotlib.text import Text

from ir50p_lab.course.camera import views
from ir50p_lab.course.draw.pictures import STAMP
from ir50p_lab.vision import Checkerboard, Reason, Rejected, calibrate_corners


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
    text = text_of(views.board_residual_figure(images[0], calibration, calibration))
    assert "Board taken for flat" in text and STAMP in text


def test_contact_sheet_names_the_reason(calibration, images):
    from dataclasses import replace

    lost = replace(calibration, views=calibration.views[:4], rejected=(Rejected("x", 4, Reason.BLURRED, "soft"),))
    assert "blurred" in text_of(views.contact_sheet(images, lost))
    assert "blurred" in text_of(views.contact_sheet([*images, images[0]], lost))  # the last row is not full


def test_pinhole_figure_marks_where_rays_cut_the_plane():
    figure = views.pinhole_figure({"X": (0.12, -0.05, 0.60), "far": (0.24, -0.1, 1.2), "(b)": (0.12, -0.05, 1.2)})
    text = text_of(figure)
    assert text.count("x = 0.20") == 1 and text.count("x = 0.10") == 1 and "(b)" in text
