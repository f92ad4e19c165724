"""Corners against the projection they were painted by; each reason for refusing a picture, provoked."""

from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from board_pictures import look, paint, project

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.vision import Checkerboard, Reason, board_points, calibrate, find_checkerboard
from ir50p_lab.vision.calibration.corners import _check_whole
from ir50p_lab.vision.calibration.reject_reasons import NotUsable

BOARD = Checkerboard()


def grey(T, **changes):
    return paint(T, **changes)[..., 0].copy()


@pytest.mark.parametrize(("spin", "blur"), [(0.0, 0.5), (1.4, 1.5), (3.0, 0.5), (-1.8, 1.5)])
def test_corners_where_they_were_painted(spin, blur):
    """To 0.1 px rms, and in the order of the board however it is turned: the colours tell."""
    T = look(0.55, 0.5, about=1.0 + spin, spin=spin)
    off = find_checkerboard(grey(T, blur=blur, over=4), (9, 6)) - project(T, BOARD.points)
    assert np.sqrt((off**2).sum(axis=1).mean()) < 0.1
    assert np.abs(off.mean(axis=0)).max() < 0.03


@pytest.mark.parametrize(("distance", "tilt", "rim"), [(0.55, 0.4, 0.45), (1.9, 0.3, 1.0), (2.3, 0.3, 1.0)])
def test_narrow_outer_squares_as_opencv_prints_them_and_squares_of_7_px(distance, tilt, rim):
    T = look(distance, tilt, 1.0)
    off = find_checkerboard(grey(T, over=4, rim=rim), (9, 6)) - project(T, BOARD.points)
    assert np.sqrt((off**2).sum(axis=1).mean()) < 0.25


@pytest.mark.parametrize("spin", [-2.6, -0.7, 0.7, 2.6])
def test_order_of_a_square_board_is_the_same_but_for_half_a_turn(spin):
    """A quarter turn swaps dark and light. Mixed, the bend of a board in many views averages out."""
    T = look(0.6, 0.3, 0.5, spin=spin)
    xy, true = find_checkerboard(grey(T, pattern=(7, 7)), (7, 7)), project(T, Checkerboard((7, 7)).points)
    assert min(np.abs(xy - true).max(), np.abs(xy - true[::-1]).max()) < 1
    assert xy[0].sum() < xy[-1].sum()


def test_a_large_picture_is_searched_small_and_measured_large():
    T = look(0.55, 0.4, 1.0)
    large = cv2.resize(grey(T, noise=0, over=4), None, fx=4, fy=4, interpolation=cv2.INTER_CUBIC)
    xy = (find_checkerboard(large, (9, 6)) + 0.5) / 4 - 0.5
    assert np.abs(xy - project(T, BOARD.points)).max() < 0.2


def torn(picture):
    """The right half 4 px lower, as a rolling shutter or a folded board might show it."""
    picture[:, 330:] = np.roll(picture[:, 330:], 4, axis=0)
    return picture


def hidden(window):
    picture = paint(look(0.5, 0.3, 1.0))
    picture[window] = 100
    return picture


CASES = {
    "other size": lambda: paint(look(0.5, 0.3, 1.0))[:400],
    "no board": lambda: np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8),
    "wrong board": lambda: paint(look(0.5, 0.3, 1.0, centre=(0.075, 0.05)), pattern=(7, 5)),
    "cropped": lambda: paint(look(0.45, 0.3, 1.0, at=(0.25, 0.0))),
    "blurred": lambda: paint(look(0.5, 0.3, 1.0), blur=10),
    "duplicate": lambda: paint(look(0.5, 0.4, 2.0), seed=9),
    "unreadable": lambda: np.zeros((480, 640, 3)),
    "outlier": lambda: torn(paint(look(0.5, 0.4, 3.0))),
}


@pytest.fixture(scope="module")
def good():
    return [paint(look(0.5, 0.4, about), seed=about) for about in (0, 2, 4, 5)]


def test_each_reason_is_given_where_it_holds(good):
    assert set(CASES) == {str(reason) for reason in Reason}
    calibration = calibrate([*good, *(make() for make in CASES.values())])
    assert [str(one.reason) for one in calibration.rejected] == list(CASES)
    assert len(calibration.views) == 4
    last = calibration.rejected[-1]
    assert (last.index, last.name) == (11, "picture 12")
    assert str(last) == f"picture 12: outlier ({last.detail})"


def reason_for(picture, pattern=(9, 6)):
    with pytest.raises(NotUsable) as caught:
        find_checkerboard(picture, pattern)
    return caught.value.reason, caught.value.detail


@pytest.mark.parametrize(
    ("window", "shown"), [(np.s_[200:280, 250:330], "4x6"), (np.s_[:, 420:], "7x6"), (np.s_[300:400, 400:500], "9x5")]
)
def test_a_board_partly_covered_is_cropped_not_another_board(window, shown):
    reason, detail = reason_for(hidden(window)[..., 0].copy())
    assert reason is Reason.CROPPED
    assert f"{shown} of 9x6" in detail


@pytest.mark.parametrize(
    ("tilt", "about", "window"),
    [(0.7, 5.0, np.s_[:, :377]), (0.5, 0.5, np.s_[:290]), (0.7, 5.0, np.s_[:, 181:]), (0.9, 0.5, np.s_[:274])],
)
def test_a_board_partly_out_of_the_picture(tilt, about, window):
    """Cut obliquely; in one of them the finder sees a grid across the squares."""
    picture = np.ascontiguousarray(grey(look(0.45, tilt, about, spin=0.3))[window])
    assert reason_for(picture)[0] is Reason.CROPPED


def test_no_board_is_seen_where_there_is_none():
    """Writing, and smooth random patches, are full of crossings; a picture of a few pixels makes OpenCV fail."""
    text = np.full((480, 640), 230, np.uint8)
    for line in range(20):
        cv2.putText(text, "The quick brown fox jumps over ####", (5, 25 * line + 10), 0, 0.8, 30, 2)
    pictures = [text, np.zeros((8, 8), np.uint8)]
    for seed, size in enumerate((1, 2, 5, 12)):
        soft = cv2.GaussianBlur(np.random.default_rng(seed).normal(0, 1, (480, 640)), (0, 0), size)
        pictures.append(cv2.normalize(soft, None, 0, 255, cv2.NORM_MINMAX).astype(np.uint8))
    for picture in pictures:
        assert reason_for(picture)[0] is Reason.NO_BOARD


@pytest.mark.parametrize(
    ("pattern", "told"), [((13, 9), (9, 6)), ((13, 9), (7, 5)), ((8, 5), (9, 6)), ((9, 6), (8, 6))]
)
def test_another_board_is_counted(pattern, told):
    """A finder is content with a part of a larger one; the calibration must not be."""
    reason, detail = reason_for(grey(look(0.7, 0.3, 1.0), pattern=pattern), told)
    assert reason is Reason.WRONG_BOARD
    assert f"{pattern[0]}x{pattern[1]} inner corners" in detail


@pytest.mark.parametrize(("shown", "same"), [((9, 6), True), ((6, 3), True), ((15, 12), False)])
def test_a_part_in_the_middle_of_a_steep_view_may_be_of_the_same_board(shown, same):
    """Where OpenCV sees that much of 13x12 corners, at a tilt of 65 to 70 degrees; a larger board is another one."""
    grid = np.stack(np.meshgrid(200.0 + 12 * np.arange(shown[0]), 150.0 + 9 * np.arange(shown[1])), axis=-1)
    with pytest.raises(NotUsable, match="wrong board: it seems to have") as caught:
        _check_whole(grid, np.zeros((480, 640), np.uint8), (13, 12))
    assert ("if it is the same board, tilt it less" in str(caught.value)) == same


@pytest.mark.parametrize("pattern", [(8, 6), (10, 7), (9, 7)])
def test_a_wrong_pattern_is_told_which_seems_right(good, pattern):
    with pytest.raises(CalibrationError, match=r"9x6 inner corners: pattern=\(9, 6\)"):
        calibrate(good, pattern=pattern)


def test_frames_and_grey_pictures_are_taken_and_floats_are_not(good):
    frames = [SimpleNamespace(image=picture) for picture in good]
    assert np.array_equal(calibrate(frames).K, calibrate([picture[..., 0].copy() for picture in good]).K)
    with pytest.raises(CalibrationError, match=r"4 unreadable.*float64 array .* give uint8"):
        calibrate([picture / 255 for picture in good])


@pytest.mark.parametrize(
    ("pattern", "square", "error", "match"),
    [
        ((9,), 0.025, CalibrationError, "columns, rows"),
        ((1, 6), 0.025, CalibrationError, "at least 3x3"),
        ((9.5, 6), 0.025, CalibrationError, "inner corners"),
        ((9, 6), 0, InputError, "positive length"),
        ((9, 6), np.nan, InputError, "positive length"),
        ((9, 6), "25 mm", InputError, "positive length"),
    ],
)
def test_boards_that_cannot_be(pattern, square, error, match):
    for make in (Checkerboard, board_points):
        with pytest.raises(error, match=match):
            make(pattern, square)
