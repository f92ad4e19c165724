"""Corners against the projection they were painted by; each reason for refusing a picture, provoked."""

import importlib
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from board_pictures import SIZE, look, paint, project

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.vision import Charuco, Checkerboard, Reason, calibrate
from ir50p_lab.vision.calibration.charuco import find_charuco
from ir50p_lab.vision.calibration.corners import find_checkerboard
from ir50p_lab.vision.calibration.reasons import NotUsable

BOARD = Checkerboard()


@pytest.fixture(scope="module", autouse=True)
def one_thread():
    before = cv2.getNumThreads()
    cv2.setNumThreads(1)
    yield
    cv2.setNumThreads(before)


def found(T, **changes):
    picture = paint(T, **changes)
    return find_checkerboard(cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY), changes.get("pattern", (9, 6))).xy


@pytest.mark.parametrize("spin", [0.0, 1.4, 3.0, -1.8])
@pytest.mark.parametrize("blur", [0.5, 1.5])
def test_corners_where_they_were_painted(spin, blur):
    """To 0.1 px rms, and in the order of the board however it is turned: the colours tell."""
    T = look(0.55, 0.5, about=1.0 + spin, spin=spin)
    off = found(T, blur=blur, over=4) - project(T, BOARD.points)
    assert np.sqrt((off**2).sum(axis=1).mean()) < 0.1
    assert np.abs(off.mean(axis=0)).max() < 0.03


def test_a_board_with_narrow_outer_squares():
    """The board of OpenCV's own sample pictures has them."""
    T = look(0.55, 0.4, 1.0)
    assert np.abs(found(T, rim=0.45) - project(T, BOARD.points)).max() < 0.5


@pytest.mark.parametrize("distance", [1.9, 2.3])
def test_small_squares_are_used_if_sharp_and_blurred_if_not(distance):
    """Squares of 9 and 7 px, on which OpenCV does not measure the edges."""
    T = look(distance, 0.3, 2.0)
    off = found(T, over=4) - project(T, BOARD.points)
    assert np.sqrt((off**2).sum(axis=1).mean()) < 0.25
    with pytest.raises(NotUsable, match=r"edges are \d\.\d px wide") as caught:
        found(T, over=4, blur=2.2)
    assert caught.value.reason is Reason.BLURRED


def test_order_of_a_board_that_looks_alike_upside_down():
    xy = found(look(0.6, 0.3, 0.5, spin=3.1), pattern=(9, 7))
    assert xy[0].sum() < xy[-1].sum()


@pytest.mark.parametrize("spin", np.linspace(-3, 3, 9))
def test_order_of_a_square_board_is_the_same_but_for_half_a_turn(spin):
    """A quarter turn swaps dark and light. Mixed, the bend of a board in many views averages out."""
    T = look(0.6, 0.3, 0.5, spin=spin)
    xy, true = found(T, pattern=(7, 7)), project(T, Checkerboard((7, 7)).points)
    assert min(np.abs(xy - true).max(), np.abs(xy - true[::-1]).max()) < 1


def test_a_large_picture_is_searched_small_and_measured_large():
    T = look(0.55, 0.4, 1.0)
    small = cv2.cvtColor(paint(T, noise=0, over=4), cv2.COLOR_RGB2GRAY)
    large = cv2.resize(small, None, fx=4, fy=4, interpolation=cv2.INTER_CUBIC)
    xy = (find_checkerboard(large, (9, 6)).xy + 0.5) / 4 - 0.5
    assert np.abs(xy - project(T, BOARD.points)).max() < 0.2


def covered():
    picture = paint(look(0.5, 0.3, 1.0))
    picture[200:280, 250:330] = 100
    return picture


def torn(picture):
    """The right half 4 px lower, as a rolling shutter or a folded board might show it."""
    picture[:, 330:] = np.roll(picture[:, 330:], 4, axis=0)
    return picture


CASES = {
    Reason.OTHER_SIZE: lambda: paint(look(0.5, 0.3, 1.0))[:400],
    Reason.NO_BOARD: lambda: np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8),
    Reason.WRONG_BOARD: lambda: paint(look(0.5, 0.3, 1.0, centre=(0.075, 0.05)), pattern=(7, 5)),
    Reason.CROPPED: lambda: paint(look(0.45, 0.3, 1.0, at=(0.25, 0.0))),
    Reason.BLURRED: lambda: paint(look(0.5, 0.3, 1.0), blur=10),
    Reason.DUPLICATE: lambda: paint(look(0.5, 0.4, 2.0), seed=9),
    Reason.UNREADABLE: lambda: np.zeros((480, 640, 3)),
    Reason.OUTLIER: lambda: torn(paint(look(0.5, 0.4, 3.0))),
}


@pytest.fixture(scope="module")
def good():
    return [paint(look(0.5, 0.4, about), seed=about) for about in (0, 2, 4, 5)]


def test_every_reason_is_provoked():
    assert set(CASES) == set(Reason)


@pytest.mark.parametrize("reason", CASES, ids=str)
def test_reason(good, reason):
    calibration = calibrate([*good, CASES[reason]()])
    assert [one.reason for one in calibration.rejected] == [reason]
    (one,) = calibration.rejected
    assert one.index == 4 and one.name == "picture 5" and len(one.detail) > 15
    assert str(one) == f"picture 5: {reason} ({one.detail})"
    assert len(calibration.views) == 4


def test_part_of_the_board_covered_is_cropped_not_another_board(good):
    (one,) = calibrate([*good, covered()]).rejected
    assert one.reason is Reason.CROPPED


@pytest.mark.parametrize(
    ("tilt", "about", "window"),
    [
        (0.7, 5.0, np.s_[:, :377]),
        (0.9, 5.0, np.s_[:, :356]),
        (0.5, 0.5, np.s_[:290]),
        (0.5, 5.0, np.s_[:285]),
        (0.9, 0.5, np.s_[:274]),
        (0.7, 0.5, np.s_[:, :436]),
        (0.7, 2.0, np.s_[:, 216:]),
        (0.7, 5.0, np.s_[:, 181:]),
    ],
)
def test_a_board_partly_out_of_the_picture(tilt, about, window):
    """Cut obliquely: there is no part of 4x3 that SB's finder sees, or corners lie beyond the edge."""
    grey = np.ascontiguousarray(paint(look(0.45, tilt, about, spin=0.3))[..., 0][window])
    with pytest.raises(NotUsable) as caught:
        find_checkerboard(grey, (9, 6))
    assert caught.value.reason is Reason.CROPPED


def test_no_board_is_seen_where_there_is_none():
    """Writing, and smooth random patches, are full of saddles."""
    soft = cv2.GaussianBlur(np.random.default_rng(0).normal(0, 1, (480, 640)), (0, 0), 5)
    text = np.full((480, 640), 230, np.uint8)
    for line in range(20):
        cv2.putText(text, "The quick brown fox jumps over ####", (5, 25 * line + 10), 0, 0.8, 30, 2)
    for grey in (cv2.normalize(soft, None, 0, 255, cv2.NORM_MINMAX).astype(np.uint8), text):
        with pytest.raises(NotUsable) as caught:
            find_checkerboard(grey, (9, 6))
        assert caught.value.reason is Reason.NO_BOARD


def test_a_picture_that_opencv_fails_on_does_not_lose_the_others(good, monkeypatch):
    module = importlib.import_module("ir50p_lab.vision.calibration.calibrate")
    seen = []

    def fails_once(grey, pattern, other):
        seen.append(grey)
        if len(seen) == 2:
            raise cv2.error("OpenCV(4.10.0) error: (-215) initial corner is outside the image")
        return find_checkerboard(grey, pattern, other)

    monkeypatch.setattr(module, "find_checkerboard", fails_once)
    (one,) = calibrate(good).rejected
    assert one.index == 1 and one.reason is Reason.NO_BOARD and "outside the image" in one.detail


def test_a_larger_board_is_another_board():
    """A finder is content with a part of it; the calibration must not be."""
    grey = cv2.cvtColor(paint(look(0.7, 0.3, 1.0), pattern=(13, 9)), cv2.COLOR_RGB2GRAY)
    for pattern in ((9, 6), (8, 6), (7, 5)):
        with pytest.raises(NotUsable, match="13x9"):
            find_checkerboard(grey, pattern)


def test_wrong_pattern_says_which_seems_right(good):
    with pytest.raises(CalibrationError, match=r"9x6 inner corners: pattern=\(9, 6\)"):
        calibrate(good, pattern=(8, 6))


def test_frames_and_grey_pictures_are_taken(good):
    frames = [SimpleNamespace(image=picture) for picture in good]
    assert np.array_equal(calibrate(frames).K, calibrate([picture[..., 0].copy() for picture in good]).K)


def charuco_picture(board, warp):
    columns, rows = board.pattern
    flat = board.opencv().generateImage(((columns + 1) * 60, (rows + 1) * 60))
    return cv2.warpPerspective(flat, warp, SIZE, borderValue=255, flags=cv2.INTER_AREA)


WARP = np.array([[0.9, 0.05, 40], [0.02, 0.85, 30], [1e-4, 1e-4, 1.0]])


@pytest.mark.parametrize("shift", [(0, 0), (250, 0), (0, -180)])
def test_charuco_corners_by_number_also_where_part_is_out_of_view(shift):
    board = Charuco((9, 6))
    warp = np.array([[1, 0, shift[0]], [0, 1, shift[1]], [0, 0, 1]]) @ WARP
    corners = find_charuco(charuco_picture(board, warp), board)
    places = board.points[corners.index, :2] / board.square * 60 + 59.5
    expected = cv2.perspectiveTransform(places[:, None], warp)[:, 0]
    assert np.abs(corners.xy - expected).max() < 0.3
    assert len(corners.xy) == 54 if shift == (0, 0) else 8 <= len(corners.xy) < 54


def test_charuco_corners_that_no_map_fits_are_cropped(monkeypatch):
    monkeypatch.setattr("ir50p_lab.vision.calibration.charuco.homography", lambda points, xy: None)
    with pytest.raises(NotUsable, match="lie on a line") as caught:
        find_charuco(charuco_picture(Charuco((9, 6)), WARP), Charuco((9, 6)))
    assert caught.value.reason is Reason.CROPPED


@pytest.mark.parametrize(
    ("board", "image", "reason"),
    [
        (Charuco((9, 6)), np.full((480, 640), 128, np.uint8), Reason.NO_BOARD),
        (Charuco((9, 6)), charuco_picture(Charuco((9, 6)), np.array([[1, 0, 470.0], [0, 1, 0], [0, 0, 1]])), Reason.CROPPED),
        (Charuco((4, 8)), charuco_picture(Charuco((9, 6)), WARP), Reason.WRONG_BOARD),
    ],
    ids=str,
)  # fmt: skip
def test_charuco_reasons(board, image, reason):
    with pytest.raises(NotUsable) as caught:
        find_charuco(image, board)
    assert caught.value.reason is reason


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: Checkerboard((9,)), "columns, rows"),
        (lambda: Checkerboard((1, 6)), "at least 3x3"),
        (lambda: Checkerboard((3, 2)), "at least 3x3"),
        (lambda: Charuco((3, 2)), "at least 3x3"),
        (lambda: find_checkerboard(np.zeros((480, 640), np.uint8), (3, 2)), "at least 3x3"),
        (lambda: Checkerboard((9.5, 6)), "inner corners"),
        (lambda: Charuco((9, 6), 0.02, 0.025), "smaller than a square"),
        (lambda: Charuco((9, 6), dictionary="DICT_9X9"), "no dictionary"),
        (lambda: Charuco((9, 6), dictionary=999), "no dictionary 999"),
        (lambda: Charuco((30, 30), dictionary="DICT_4X4_50").opencv(), "too few markers"),
    ],
)
def test_boards_that_cannot_be(make, match):
    with pytest.raises(CalibrationError, match=match):
        make()


def test_a_square_of_no_size():
    with pytest.raises(InputError, match="positive length"):
        Checkerboard((9, 6), 0)


@pytest.mark.parametrize(
    ("printed", "told", "words"),
    [
        (Charuco((9, 6)), Charuco((6, 9)), "swap columns and rows"),
        (Charuco((9, 6)), Charuco((10, 7)), "count inner corners"),
        (Charuco((8, 5), legacy=True), Charuco((8, 5)), "legacy=True"),
        (Charuco((9, 6)), Charuco((9, 6), dictionary="DICT_4X4_100"), "name the dictionary"),
    ],
    ids=["swapped", "squares counted", "printed by an older OpenCV", "other dictionary"],
)
def test_charuco_told_wrongly_says_what_to_try(printed, told, words):
    with pytest.raises(NotUsable, match=words) as caught:
        find_charuco(charuco_picture(printed, WARP), told)
    assert caught.value.reason is (Reason.NO_BOARD if told.dictionary != printed.dictionary else Reason.WRONG_BOARD)


def test_a_mirrored_charuco_says_so():
    mirrored = np.ascontiguousarray(charuco_picture(Charuco((9, 6)), WARP)[:, ::-1])
    with pytest.raises(NotUsable, match="mirroring"):
        find_charuco(mirrored, Charuco((9, 6)))


def test_a_dictionary_may_be_given_by_its_number():
    assert Charuco((9, 6), dictionary=cv2.aruco.DICT_4X4_100) == Charuco((9, 6), dictionary="DICT_4X4_100")


@pytest.mark.parametrize("hidden", [0, 1, 3])
def test_a_charuco_view_again_is_a_duplicate_also_with_corners_hidden(hidden):
    board, tilts = Charuco((9, 6)), ((1e-4, 1e-4), (-1e-4, 3e-4), (3e-4, -1e-4), (4e-4, 4e-4))
    warps = [np.vstack([WARP[:2], (*tilt, 1.0)]) for tilt in tilts]
    pictures = [charuco_picture(board, warp) for warp in warps]
    again = pictures[1].copy()
    for xy in find_charuco(again, board).xy[:hidden].astype(int):
        cv2.circle(again, xy.tolist(), 14, 128, -1)
    (one,) = calibrate([*pictures, again], board=board).rejected
    assert one.reason is Reason.DUPLICATE and "picture 2" in one.detail


@pytest.mark.parametrize(
    ("pattern", "blur", "scale"),
    [
        ((9, 6), 3, 0.5), ((6, 4), 3, 1.0), ((9, 6), 3, 2.25),
        ((6, 4), 6, 0.5), ((9, 6), 6, 1.0), ((6, 4), 6, 2.25),
        ((9, 6), 10, 0.5), ((6, 4), 10, 1.0), ((9, 6), 10, 2.25),
    ],
)  # fmt: skip
def test_a_charuco_too_blurred_for_its_markers_is_told_to_focus(pattern, blur, scale):
    """Its squares still are a checkerboard, the more so as blur takes the markers away."""
    noise = np.random.default_rng(blur).normal(0, 3, (round(480 * scale), round(640 * scale)))
    sharp = cv2.resize(charuco_picture(Charuco(pattern), WARP), noise.shape[::-1], interpolation=cv2.INTER_AREA)
    soft = cv2.GaussianBlur(sharp, (0, 0), blur * scale)
    with pytest.raises(NotUsable, match="focus"):
        find_charuco(np.clip(20 + 0.7 * soft + noise, 0, 255).astype(np.uint8), Charuco(pattern))


def test_a_larger_board_that_only_the_slow_finder_sees_is_not_taken_for_the_pattern(monkeypatch):
    squares = 40 + 180 * (np.indices((8, 11)).sum(axis=0) % 2)  # 10x7 inner corners
    board = np.pad(np.kron(squares, np.ones((40, 40))).astype(np.uint8), 60, constant_values=220)
    part = 99.5 + 40 * np.argwhere(np.ones((6, 9)))[:, None, ::-1]
    monkeypatch.setattr(cv2, "findChessboardCorners", lambda *args: (False, None))
    monkeypatch.setattr(cv2, "findChessboardCornersSB", lambda *args, **flags: (True, part.astype(np.float32)))
    monkeypatch.setattr("ir50p_lab.vision.calibration.corners.part_of_a_checkerboard", lambda grey: None)
    with pytest.raises(NotUsable, match="10x7"):
        find_checkerboard(cv2.GaussianBlur(board, (0, 0), 1.0), (9, 6))
