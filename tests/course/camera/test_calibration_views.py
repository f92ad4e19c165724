"""Views and trials of notebook 17: what they say and show, and that a click moves the hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from board_pictures import SIZE, corner_sets
from matplotlib.text import Text

from ir50p_lab.course import camera, my_robot
from ir50p_lab.course.draw.pictures import STAMP
from ir50p_lab.vision import Checkerboard, Reason, Rejected, calibrate_corners
from ir50p_lab.vision.rendering import bench_camera


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


def test_contact_sheet_names_the_reason(calibration, images):
    from dataclasses import replace

    lost = replace(calibration, views=calibration.views[:4], rejected=(Rejected("x", 4, Reason.BLURRED, "soft"),))
    assert "blurred" in text_of(camera.contact_sheet(images, lost)) and STAMP in text_of(
        camera.contact_sheet([*images, images[0]], lost)
    )  # the last row is not full


def test_pinhole_figure_marks_where_rays_cut_the_plane():
    figure = camera.pinhole_figure(X=(0.12, -0.05, 0.60), far=(0.24, -0.1, 1.2), pushed=(0.12, -0.05, 1.2))
    text = text_of(figure)
    assert text.count("x = 0.20") == 2 and "pushed, x = 0.10" in text


def test_the_grid_is_where_the_homography_puts_it(images):
    H = np.array([[0, 0.001, 0.2], [0.001, 0, -0.3], [0, 0, 1]])  # 1 mm a pixel, seen from above
    figure = camera.grid_figure(images[3], H)
    first = figure.axes[0].lines[0].get_xydata()
    np.testing.assert_allclose(first, [[0, 0], [600, 0]], atol=1e-9)  # X = 0.20 m from Y = -0.30 to 0.30 m
    assert STAMP in text_of(figure)


def test_two_triangles_say_how_far_beyond_the_ball_is_read():
    lens = np.linalg.inv(bench_camera()[1])[:3, 3]
    text = text_of(camera.triangles_figure(lens, np.array([0.42, -0.15, 0.03])))
    assert all(number in text for number in ("590 mm", "614 mm", "30 mm", "31 mm"))


def test_a_click_and_the_slider_move_the_hand(images):
    asked, hand = [], SimpleNamespace(q=None)

    def pose_for(pixel, height):
        asked.append((*pixel, height))
        return None if pixel[0] > 500 else 1 / pixel[1] * np.ones(3)

    import ipywidgets

    view = camera.SightView(images[0], pose_for, ipywidgets.HTML(), (197, 223))
    view._hand = hand
    view.picture._clicked(100.5 / 640, 1 - 50.5 / 480)
    assert asked[-1] == (100, 50, 0.03) and hand.q == [0.02] * 3
    assert "pixel (100, 50) at 30 mm" in view.picture.status.value
    view.height.value = 10
    assert asked[-1] == (100, 50, 0.01) and "at 10 mm" in view.picture.status.value
    view.picture._clicked(600.5 / 640, 0.5)
    assert "does not reach" in view.picture.status.value and hand.q == [0.02] * 3
    view.picture._clicked(0.1, 1.0)
    assert "ZeroDivisionError" in view.picture.status.value
    assert "image/png" in view._repr_mimebundle_()[0]


def test_circles_are_found_one_after_the_other():
    rows, columns = np.indices((120, 160))
    discs = [(40, 30, 12), (110, 80, 15), (60, 85, 10)]
    mask = np.any([np.hypot(columns - x, rows - y) < r for x, y, r in discs], axis=0)
    found = camera.find_circles(mask, my_robot.circle_votes, range(8, 18), 3)
    for disc in discs:
        assert min(np.abs(np.subtract(one, disc)).max() for one in found) <= 1


def test_more_pictures_leave_the_noise_and_make_the_camera_known():
    few, many = (camera.calibrated_with_noise(bench_camera()[0], count, 0.1) for count in (3, 12))
    assert abs(few.rms - 0.137) < 0.01 and abs(many.rms - 0.140) < 0.01
    assert many.stderr["fx"] < 0.5 * few.stderr["fx"]
