"""Calibration from corners with known noise: against the truth, and what it must see and refuse."""

import sys

import cv2
import numpy as np
import pytest
from board_pictures import LENS, SIZE, K, corner_sets, look, painted_set, project
from refusals import refused

from ir50p_lab.errors import CalibrationError, ImageError, InputError
from ir50p_lab.vision import Checkerboard, Pinhole, Reason, calibrate, calibrate_corners
from ir50p_lab.vision.calibration.calibration_result import NAMES
from ir50p_lab.vision.calibration.fit import errors, fit, fit_bent, heights

POINTS = Checkerboard().points
TRUTH = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2]])
FULL = ("k1", "k2", "p1", "p2")


@pytest.fixture(scope="module")
def views():
    return corner_sets(POINTS, 15, seed=1)


@pytest.fixture(scope="module")
def calibration(views):
    return calibrate_corners(POINTS, views, SIZE)


def off(found):
    """Errors of fx, fy, cx, cy in standard errors."""
    values = np.array([found.fx, found.fy, found.cx, found.cy])
    return (values - TRUTH) / [found.stderr[name] for name in NAMES[:4]]


def test_standard_errors_are_those_of_opencv_where_corners_err_alone(views, calibration):
    """Never smaller; by views they are larger by chance only."""
    points, pixels = [np.float32(POINTS)] * len(views), [np.float32(xy) for xy in views]
    stop = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-12)
    flags = cv2.CALIB_FIX_K3
    extended = cv2.calibrateCameraExtended(points, pixels, SIZE, None, None, flags=flags, criteria=stop)
    theirs, ours = extended[5].ravel()[:8], np.array([calibration.stderr[name] for name in NAMES[:8]])
    assert (ours > 0.99 * theirs).all() and (ours < 2 * theirs).all()
    assert calibration.model == FULL and np.isnan(calibration.stderr["k3"])


def test_truth_within_standard_errors_and_rms_as_the_noise_says():
    """Twenty sets: the errors of K have the size that is claimed, one by one and jointly."""
    sets = [calibrate_corners(POINTS, corner_sets(POINTS, 12, seed=seed), SIZE) for seed in range(20)]
    z = np.array([off(found) for found in sets])
    assert np.abs(z).max() < 4 and (0.6 < np.sqrt((z**2).mean(axis=0))).all()
    assert (np.sqrt((z**2).mean(axis=0)) < 1.4).all()
    for found in sets:
        expected = 0.1 * np.sqrt(2) * np.sqrt(1 - (8 + 6 * 12) / (2 * 54 * 12))
        assert abs(found.rms / expected - 1) < 0.06 and abs(found.sigma / 0.1 - 1) < 0.06
        assert np.linalg.eigvalsh(found.covariance).min() > -1e-12


def test_correlated_errors_of_a_view_make_a_larger_standard_error():
    """Each view's corners shifted by a smooth error of its own: errors by corners are then too small by far."""
    rng, points = np.random.default_rng(2), POINTS[:, :2] / POINTS[:, :2].max()
    terms = np.column_stack([points[:, 0] ** 2, points[:, 1] ** 2, points[:, 0] * points[:, 1]])
    smooth = [xy + terms @ rng.normal(0, 0.4, (3, 2)) for xy in corner_sets(POINTS, 15, noise=0.05, seed=3)]
    assert errors(fit([POINTS] * 15, smooth, SIZE, FULL), FULL)[2] > 1.5


def bowl(sag):
    """Board points (54, 3) that lie `sag` m deeper at 0.1 m from the middle along x."""
    return POINTS + np.outer(sag * ((POINTS[:, 0] - 0.1) / 0.1) ** 2, [0, 0, 1])


@pytest.mark.parametrize(("sag", "count"), [(0.001, 12), (0.002, 5)])
def test_a_bent_board_is_estimated_with_the_camera_and_the_errors_still_hold(sag, count):
    z = []
    for seed in range(8):
        pixels = corner_sets(bowl(sag), count, noise=0.05, seed=seed)
        flat = fit([POINTS] * count, pixels, SIZE, FULL)
        bent = fit_bent(flat, pixels, SIZE, FULL, 9)
        assert bent.bent and bent.squares < 0.5 * flat.squares
        assert abs(np.ptp(heights(bent.points[0])) / sag - 1) < 0.5
        covariance = errors(bent, FULL)[0]
        z.append((bent.camera - [*TRUTH, *LENS])[:4] / np.sqrt(np.diag(covariance)[:4]))
    assert np.sqrt(np.mean(np.square(z))) < 1.5


@pytest.mark.parametrize("count", [3, 6, 12])
def test_a_flat_board_is_flat(count):
    for seed in range(4):
        pixels = corner_sets(POINTS, count, seed=10 * count + seed)
        flat = fit([POINTS] * count, pixels, SIZE, FULL)
        assert fit_bent(flat, pixels, SIZE, FULL, 9) is flat


def test_pictures_of_a_bent_board_say_so():
    camera = Pinhole(K, LENS, SIZE)
    found = calibrate(painted_set(camera, 8, 3, bend=0.3), progress=False)
    assert found.warnings[0].startswith("the board is bent by 1.") and np.abs(off(found)).max() < 4


def test_square_is_only_a_scale_and_millimetres_are_noticed(views, calibration):
    scaled = calibrate_corners(1000 * POINTS, views, SIZE)
    assert np.allclose(scaled.K, calibration.K, atol=1e-2) and np.isclose(scaled.rms, calibration.rms)
    for ours, theirs in zip(scaled.views, calibration.views, strict=True):
        assert np.allclose(ours.T_cam_board[:3, 3], 1000 * theirs.T_cam_board[:3, 3], rtol=1e-4)
    assert any("square in metres" in text for text in scaled.warnings)


def test_fewer_coefficients_are_kept_at_zero(views):
    found = calibrate_corners(POINTS, views, SIZE, lens=("k2", "k1"))
    assert found.model == ("k1", "k2") and not found.distortion[2:].any()
    assert found.covariance[6, 6] == 0 and "p1" not in str(found)


def test_view_that_does_not_belong_is_left_out(views):
    spoilt = [xy.copy() for xy in views]
    spoilt[6] += np.random.default_rng(0).normal(0, 3, spoilt[6].shape)
    found = calibrate_corners(POINTS, spoilt, SIZE)
    assert [(one.index, one.reason) for one in found.rejected] == [(6, Reason.OUTLIER)]
    assert len(found.views) == 14 and np.abs(off(found)).max() < 4


def test_one_cropped_picture_that_spoils_the_others_is_said(views):
    """Its centre lies elsewhere; the other views fit badly for its sake, so that it does not stand out."""
    seen = [xy + np.array([300, 0]) if k == 6 else xy for k, xy in enumerate(views)]
    assert "contradict each other" in calibrate_corners(POINTS, seen, (940, 480)).warnings[0]


def test_honest_noise_is_no_outlier():
    for seed in range(5):
        assert not calibrate_corners(POINTS, corner_sets(POINTS, 12, seed=30 + seed), SIZE).rejected


def zoomed(views, which, other):
    """The views, those of these numbers as a camera with `other` times the focal length sees them."""
    scaled = np.diag([other, other, 1]) @ K
    for i in which:
        ray = cv2.undistortPoints(views[i][:, None], K, LENS)
        views[i] = cv2.projectPoints(cv2.convertPointsToHomogeneous(ray), *np.zeros((2, 3)), scaled, LENS)[0][:, 0]
        views[i] -= (scaled - K)[:2, 2]
    return [xy for xy in views if (xy > 0).all() and (xy < np.array(SIZE) - 1).all()]


@pytest.mark.parametrize("other", [0.8, 0.93, 1.1])
def test_two_cameras_in_one_call_are_noticed(other):
    for seed in range(2):
        both = zoomed(corner_sets(POINTS, 14, 0.1, seed), range(0, 14, 2), other)
        assert "two cameras" in calibrate_corners(POINTS, both, SIZE).warnings[0]


def fisheye(focal=280, bends=(0, 0, 0, 0), noise=0.1, seed=0):
    """(15 views by OpenCV, angle of the outermost corner in degrees) of a fisheye: f (theta + k1 theta^3 + ...)."""
    matrix, rng, views, angles = (
        np.array([[focal, 0, 322.0], [0, focal, 238], [0, 0, 1]]),
        np.random.default_rng(seed),
        [],
        [],
    )
    while len(views) < 15:
        turn, (aside, about) = rng.normal(0, 0.35, 3), rng.uniform((0, 0), (1.1, 6.28))
        away = np.array([np.sin(aside) * np.cos(about), np.sin(aside) * np.sin(about), np.cos(aside)])
        R = cv2.Rodrigues(turn)[0]
        shift = rng.uniform(0.12, 0.3) * away - R @ POINTS.mean(axis=0)
        X, Y, Z = (POINTS @ R.T + shift).T
        xy = cv2.fisheye.projectPoints(POINTS[None], turn, shift, matrix, np.float64(bends))[0][0]
        if Z.min() > 0.02 and (xy > 3).all() and (xy < (636, 476)).all():
            views.append(xy + rng.normal(0, noise, xy.shape))
            angles.append(np.rad2deg(np.arctan2(np.hypot(X, Y), Z).max()))
    return views, max(angles)


# The first coefficients of the models r = f theta, 2 f sin(theta/2), 2 f tan(theta/2), f sin(theta), and of a real lens
BENDS = [(0,), (-1 / 24, 1 / 1920), (1 / 12, 1 / 120), (-1 / 6, 1 / 120), (-0.05, 0.01)]


@pytest.mark.parametrize(("bends", "focal"), list(zip(BENDS, [150, 220, 300, 150, 300], strict=True)))
def test_a_fisheye_is_called_one_with_its_angle_and_no_other_cause(bends, focal):
    views, angle = fisheye(focal, [*bends, 0, 0, 0][:4], seed=focal)
    (said,) = calibrate_corners(POINTS, views, SIZE).warnings
    assert said.startswith("a fisheye") and "cv2.fisheye" in said
    assert abs(float(said.split("corners lie ")[1].split()[0]) - angle) < 3


def test_a_fisheye_is_no_bent_board(monkeypatch):
    views, _ = fisheye()
    calibrate_module = sys.modules["ir50p_lab.vision.calibration.calibrate"]
    monkeypatch.setattr(calibrate_module, "_corners", lambda *_: views[len(_[-1])])
    found = calibrate([np.zeros(SIZE[::-1], np.uint8)] * len(views), progress=False)
    assert len(found.views) == 15 and [text[:9] for text in found.warnings] == ["a fisheye"]


def wide(lens, across_deg, seed=0):
    """(focal length, views) of a lens that sees so much across, with boards where its polynomial rises."""
    x = np.tan(np.deg2rad(across_deg) / 2)
    f = 320 / (x * (1 + lens[0] * x**2 + lens[1] * x**4 + lens[4] * x**6))
    camera, rng, views = Pinhole.simple(f, SIZE, lens), np.random.default_rng(seed), []
    while len(views) < 15:
        T = look(rng.uniform(0.15, 0.5), rng.uniform(0.1, 0.7), *rng.uniform(0, 6.28, 2), rng.uniform(-0.9, 0.9, 2))
        deep = POINTS @ T[2, :3] + T[2, 3]
        if deep.min() > 0.05 and np.hypot(*(POINTS @ T[:2, :3].T + T[:2, 3]).T / deep).max() < 1.2 * x:
            xy = camera.project(T, POINTS)
            if (xy > 3).all() and (xy < (636, 476)).all():
                views.append(xy + rng.normal(0, 0.1, xy.shape))
    return f, views


@pytest.mark.parametrize(
    ("across_deg", "lens"), [(70, (-0.3, 0.1, 0, 0, 0)), (85, (-0.35, 0.15, 0, 0, 0)), (100, (-0.4, 0.15, 0, 0, 0))]
)
def test_a_wide_lens_that_the_model_describes_is_no_fisheye(lens, across_deg):
    f, seen = wide(lens, across_deg)
    found = calibrate_corners(POINTS, seen, SIZE)
    assert abs(found.fx / f - 1) < 0.01
    assert not any("fisheye" in text or "contradict" in text or "needs more" in text for text in found.warnings)


@pytest.mark.parametrize(("lens", "given"), [((-0.4, 0.25, 0, 0, -0.08), FULL), (LENS, ()), (LENS, ("p1", "p2"))])
def test_a_lens_that_needs_more_coefficients_is_told_which(lens, given):
    _, seen = wide(lens, 95 if lens[4] else 60)
    (said,) = calibrate_corners(POINTS, seen, SIZE, lens=given).warnings
    assert "needs more" in said and "fisheye" not in said
    assert not any("needs more" in text for text in calibrate_corners(POINTS, seen, SIZE, lens=NAMES[4:]).warnings)


def tilted(tilts, about):
    rng, places = np.random.default_rng(0), np.linspace(-0.1, 0.1, len(tilts))
    poses = [look(0.5, tilt, a, at=(x, 0)) for tilt, a, x in zip(tilts, about, places, strict=True)]
    return [project(T, POINTS) + rng.normal(0, 0.1, (54, 2)) for T in poses]


SAID = {
    "fisheye": lambda views: (fisheye(noise=0)[0], SIZE),
    "pixels are not square": lambda views: ([xy * [4 / 3, 1] for xy in views], (853, 480)),
    "far from the middle": lambda views: ([xy + np.array([300, 0]) for xy in views], (940, 480)),
    "4 views are few": lambda views: (views[:4], SIZE),
    "too few tilts: 0 of 5": lambda views: (tilted([0.03, -0.03, 0.05, -0.05, 0.04], range(5)), SIZE),
    "one axis": lambda views: (tilted([-0.6, -0.4, 0.3, 0.5, 0.6], [0] * 5), SIZE),
    "corners fill only": lambda views: (tilted([0.4] * 5, range(5)), SIZE),
}


@pytest.mark.parametrize("words", SAID)
def test_what_a_good_fit_does_not_show_is_said(views, calibration, words):
    seen, size = SAID[words](views)
    assert any(words in text for text in calibrate_corners(POINTS, seen, size).warnings)
    assert not any(words in text for text in calibration.warnings)


def test_views_know_their_poses(calibration, views):
    for view, xy in zip(calibration.views, views, strict=True):
        model = calibration.pinhole.project(view.T_cam_board, view.points)
        assert np.allclose(xy - model, view.residuals, atol=1e-8)
    assert np.isclose(calibration.rms, np.sqrt(np.mean(calibration.view_rms**2)))


@pytest.mark.parametrize(
    ("arguments", "error", "match"),
    [
        ((POINTS, [], SIZE), CalibrationError, "0 views"),
        ((POINTS, [np.zeros((54, 2))] * 2, SIZE), CalibrationError, "2 views"),
        ((POINTS, [np.zeros((53, 2))] * 4, SIZE), InputError, "as many points"),
        ((POINTS, [np.full((54, 2), np.nan)] * 4, SIZE), InputError, "finite"),
        ((POINTS[:, :2], [np.zeros((54, 2))] * 4, SIZE), InputError, "object_points"),
        ((POINTS + [0, 0, 1] * POINTS[:, :1], [np.zeros((54, 2))] * 4, SIZE), InputError, "plane"),
        ((POINTS, [np.full((54, 2), 500.0)] * 4, (640, 480)), InputError, "outside pictures of size"),
        ((POINTS, [np.zeros((54, 2))] * 4, "ab"), InputError, "size = "),
        ((None, [np.zeros((54, 2))] * 4, SIZE), InputError, "_points"),
        ((POINTS, 5, SIZE), InputError, "_points"),
        (("x", ["a"] * 4, SIZE), InputError, "_points"),
    ],
)
def test_corners_that_are_refused(arguments, error, match):
    refused(match, calibrate_corners, *arguments, error=error)


def test_one_pose_again_and_again_is_refused(views):
    """One picture of a plane has eight numbers, and ten are asked of it: rounding must not make up the difference."""
    for view in views:
        refused("tilt", calibrate_corners, POINTS, [view] * 4, SIZE, lens=(), error=CalibrationError)


@pytest.mark.parametrize(
    ("images", "error", "match"),
    [
        ([], InputError, "no pictures"),
        (3, InputError, "list of pictures"),
        (np.zeros((480, 640, 3), np.uint8), InputError, "one picture"),
        ("nowhere/at/all", ImageError, "does not exist"),
        (["a.jpg", "b.jpg"], CalibrationError, "2 unreadable"),
    ],
)
def test_pictures_that_are_refused(images, error, match):
    refused(match, calibrate, images, error=error)


def test_views_with_different_numbers_of_points(views, calibration):
    some = [slice(9 * (k % 3), None) for k in range(len(views))]
    found = calibrate_corners([POINTS[s] for s in some], [xy[s] for xy, s in zip(views, some, strict=True)], SIZE)
    assert abs(found.fx - calibration.fx) < 3 * found.stderr["fx"]
    assert calibrate_corners(POINTS.tolist(), views, SIZE).fx == pytest.approx(calibration.fx, rel=1e-9)


@pytest.mark.parametrize("lens", [5, ["k1", None], "k4", "p1"])
def test_coefficients_that_make_no_sense(views, lens):
    refused("lens = ", calibrate_corners, POINTS, views, SIZE, lens=lens)
    refused("lens = ", calibrate, ["a.jpg", "b.jpg", "c.jpg"], lens=lens)
