"""Figures of notebook 17: drawn from a small calibration, and saying what they show."""

import numpy as np
import pytest
from board_pictures import LENS, SIZE, K, corner_sets
from matplotlib.text import Text

from ir50p_lab.course.camera import views
from ir50p_lab.course.draw.pictures import STAMP
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
        "Board taken for flat": views.board_residual_figure(images[0], calibration, calibration),
        "Table 4.8": views.table_figure(images[0], np.ones((4, 2)), {"ours": np.zeros((4, 2))}),
    }
    for words, figure in drawn.items():
        text = text_of(figure)
        assert words in text and STAMP in text


def test_contact_sheet_names_the_reason(calibration, images):
    from dataclasses import replace

    lost = replace(calibration, views=calibration.views[:4], rejected=(Rejected("x", 4, Reason.BLURRED, "soft"),))
    assert "blurred" in text_of(views.contact_sheet(images, lost))
    assert "blurred" in text_of(views.contact_sheet([*images, images[0]], lost))  # the last row is not full


def test_lens_view_moves_lines_as_the_lens_does():
    view = views.DistortionView(Pinhole.simple(700))
    straight = [line.copy() for line in view._lines.get_segments()]
    assert view.update() == "straight: a point moves by up to 0.0 px"
    assert float(view.update(k1=-0.3).split()[-2]) > 20
    bent = view._lines.get_segments()
    lens = Pinhole(view.pinhole.K, (-0.3, 0), SIZE)
    assert np.allclose(bent[0], lens.to_pixels(lens.distort(view.pinhole.to_normalised(straight[0]))))


@pytest.mark.parametrize(
    ("k", "shape"),
    [
        ({"k1": -0.3}, "barrel"),
        ({"k1": 0.3}, "pincushion"),
        ({"k2": 0.3}, "pincushion"),
        ({"k1": -0.1, "k2": 0.5}, "barrel and further out pincushion"),
        ({"k1": 0.1, "k2": -0.5}, "pincushion and further out barrel"),
        ({"p1": 0.01}, "wider on one side"),
        ({"k1": -0.3, "p2": 0.01}, "barrel, wider on one side"),
    ],
)
def test_lens_view_says_what_the_grid_looks_like(k, shape):
    assert views.DistortionView(Pinhole.simple(700)).update(**k).split(":")[0] == shape


def test_pinhole_figure_marks_where_rays_cut_the_plane():
    figure = views.pinhole_figure({"X": (0.12, -0.05, 0.60), "far": (0.24, -0.1, 1.2), "(b)": (0.12, -0.05, 1.2)})
    text = text_of(figure)
    assert text.count("x = 0.20") == 1 and text.count("x = 0.10") == 1 and "(b)" in text


def test_residuals_point_down_as_in_the_picture(calibration, images):
    low, high = views.residual_figure(images, calibration, 0).axes[1].get_ylim()
    assert low > 0 > high
