"""Calibration from corners with known noise: against OpenCV, against the truth, and what it must see and refuse."""

import cv2
import numpy as np
import pytest
from board_pictures import LENS, SIZE, K, corner_sets, look, project

from ir50p_lab.errors import CalibrationError, ImageError, InputError
from ir50p_lab.vision import Checkerboard, Reason, calibrate, calibrate_corners
from ir50p_lab.vision.calibration.fit import NAMES

pytestmark = pytest.mark.numeric
POINTS = Checkerboard().points
TRUTH = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2]])
FULL = ("k1", "k2", "p1", "p2")


@pytest.fixture(scope="module")
def views():
    return corner_sets(POINTS, 15, seed=1)


@pytest.fixture(scope="module")
def calibration(views):
    return calibrate_corners(POINTS, views, SIZE)


def values(calibration):
    return np.array([calibration.fx, calibration.fy, calibration.cx, calibration.cy])


def test_same_as_opencv(views):
    """Numbers, rms and the standard errors by corners; another program, another minimiser."""
    ours = calibrate_corners(POINTS, views, SIZE, lens=FULL)
    rms, K_, d, _, _, deviations, _, _ = cv2.calibrateCameraExtended(
        [POINTS.astype(np.float32)] * len(views),
        [xy.astype(np.float32) for xy in views],
        SIZE,
        None,
        None,
        flags=cv2.CALIB_FIX_K3,
        criteria=(cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-12),
    )
    assert abs(ours.rms - rms) < 1e-6
    assert np.allclose(ours.K, K_, atol=2e-3) and np.allclose(ours.distortion, d.ravel(), atol=1e-4)
    errors = [ours.stderr_corners[name] for name in NAMES[:8]]
    assert np.allclose(errors, deviations.ravel()[:8], rtol=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_truth_within_three_standard_errors_and_rms_as_the_noise_says(seed):
    count = 20
    found = calibrate_corners(POINTS, corner_sets(POINTS, count, seed=seed), SIZE)
    error = values(found) - TRUTH
    assert (np.abs(error) < 3 * np.array([found.stderr[n] for n in NAMES[:4]])).all()
    assert error @ np.linalg.solve(found.covariance[:4, :4], error) < 16.3
    parameters, corners = 4 + len(found.model) + 6 * count, 54 * count
    assert abs(found.rms / (0.1 * np.sqrt(2) * np.sqrt(1 - parameters / (2 * corners))) - 1) < 0.05
    assert abs(found.sigma / 0.1 - 1) < 0.05


def test_covariance_belongs_to_the_standard_errors(calibration):
    deviations = np.sqrt(np.diag(calibration.covariance))
    for name, deviation in zip(NAMES, deviations, strict=True):
        assert deviation == (0 if np.isnan(calibration.stderr[name]) else calibration.stderr[name])
        if deviation:
            assert deviation >= max(calibration.stderr_corners[name], calibration.stderr_views[name])
    assert np.linalg.eigvalsh(calibration.covariance).min() > -1e-12


def test_correlated_errors_of_a_view_make_the_larger_standard_error():
    """Each view's corners shifted by a smooth error of its own: errors by corners are then too small by far."""
    rng, points = np.random.default_rng(2), POINTS[:, :2] / POINTS[:, :2].max()
    views = corner_sets(POINTS, 15, noise=0.05, seed=3)
    terms = np.column_stack([points[:, 0] ** 2, points[:, 1] ** 2, points[:, 0] * points[:, 1]])
    bent = [xy + terms @ rng.normal(0, 0.4, (3, 2)) for xy in views]
    found = calibrate_corners(POINTS, bent, SIZE, bend=False)
    assert found.stderr_views["fx"] > 1.5 * found.stderr_corners["fx"]
    assert found.stderr["fx"] >= found.stderr_views["fx"]


LENSES = {
    (): np.zeros(5),
    ("k1",): np.array([-0.2, 0, 0, 0, 0]),
    ("k1", "k2"): np.array([-0.3, 0.25, 0, 0, 0]),
    FULL: np.array([-0.3, 0.25, 0.004, -0.003, 0]),
    (*FULL, "k3"): np.array([-0.3, 0.4, 0.004, -0.003, -1.5]),
}


@pytest.mark.parametrize("model", LENSES, ids=str)
def test_lens_by_evidence(model):
    found = calibrate_corners(POINTS, corner_sets(POINTS, 25, noise=0.03, seed=4, lens=LENSES[model]), SIZE)
    assert found.model == model
    assert all(np.isnan(found.stderr[name]) == (name not in model) for name in NAMES[4:])
    kept = {question.term for question in found.evidence if question.kept}
    assert ("k3" in kept) == ("k3" in model)
    for question in found.evidence:
        yes = "yes" if question.term == "bent board" else "kept"
        assert (f": {yes} (such" in str(question)) == question.kept
        assert question.kept == (question.p_value < question.limit) or "; but " in str(question)


@pytest.mark.parametrize(
    ("evidence", "words"),
    [
        (("k3", 0.046, 2.8, False, 0.01), "k3: dropped (such an improvement by chance: 4.6 %; the limit is 1 %)"),
        (("p1 and p2", 1e-9, 90.0, True, 0.05), "p1 and p2: kept (such an improvement by chance: less than 0.01 %; the limit is 5 %)"),
        (("bent board", 2e-4, 9.0, False, 1e-3, "too little"), "bent board: no (such an improvement by chance: 0.02 %; the limit is 0.1 %; but too little)"),
    ],
)  # fmt: skip
def test_evidence_says_by_which_limit(evidence, words):
    from ir50p_lab.vision.calibration.models import Evidence

    assert str(Evidence(*evidence)) == words


def test_a_coefficient_that_means_nothing_is_named(views):
    found = calibrate_corners(POINTS, views, SIZE, lens=(*FULL, "k3"))
    assert any(text.startswith("k3 =") and "cannot be told from zero" in text for text in found.warnings)


def test_square_is_only_a_scale(views, calibration):
    scaled = calibrate_corners(1.3 * POINTS, views, SIZE)
    assert np.allclose(scaled.K, calibration.K, atol=1e-3) and np.isclose(scaled.rms, calibration.rms)
    for ours, theirs in zip(scaled.views, calibration.views, strict=True):
        assert np.allclose(ours.T_cam_board[:3, 3], 1.3 * theirs.T_cam_board[:3, 3], rtol=1e-5)


def test_millimetres_for_metres_are_noticed(views):
    assert any("square in metres" in text for text in calibrate_corners(1000 * POINTS, views, SIZE).warnings)


def test_prescribed_aspect_is_checked(views):
    wrong = calibrate_corners(POINTS, views, SIZE, aspect=1.02)
    assert np.isclose(wrong.fx / wrong.fy, 1.02) and any("aspect = 1.02" in text for text in wrong.warnings)
    right = calibrate_corners(POINTS, views, SIZE, aspect=700 / 702)
    assert not any("aspect" in text for text in right.warnings)
    assert right.stderr["fx"] / right.fx == pytest.approx(right.stderr["fy"] / right.fy)


@pytest.mark.parametrize("bend", ["along x", "saddle"])
def test_bent_board_is_recognised_and_measured(bend):
    x, y = (POINTS[:, :2] - POINTS[:, :2].mean(axis=0)).T / 0.1
    bent = POINTS.copy()
    bent[:, 2] = 0.001 * (x * x if bend == "along x" else x * y)  # 1 mm at 100 mm from the middle
    views = corner_sets(bent, 12, noise=0.05, seed=5)
    found, flat = (calibrate_corners(POINTS, views, SIZE, bend=choice) for choice in (None, False))
    assert np.allclose(found.sag, [0.001, 0, 0] if bend == "along x" else [0, 0.001, 0], atol=1e-4)
    assert found.warnings[0].startswith("the board is bent") and "bent" in flat.warnings[0]
    assert (np.abs(values(found) - TRUTH) < 3 * np.array([found.stderr[n] for n in NAMES[:4]])).all()
    assert found.rms < 0.8 * flat.rms
    shape = cv2.calibrateCameraRO(  # another route: OpenCV frees every point of the board
        [bent.astype(np.float32) * [1, 1, 0]] * len(views) and [(POINTS).astype(np.float32)] * len(views),
        [xy.astype(np.float32) for xy in views], SIZE, 8, None, None, flags=cv2.CALIB_FIX_K3,
    )[5].reshape(-1, 3)  # fmt: skip
    plane = np.column_stack([POINTS[:, :2], np.ones(54)])
    heights = [z - plane @ np.linalg.lstsq(plane, z, rcond=None)[0] for z in (shape[:, 2], bent[:, 2])]
    assert np.corrcoef(heights)[0, 1] > 0.9


@pytest.mark.parametrize("count", [3, 4, 5])
def test_bent_board_in_few_views(count):
    """The p-value by views cannot fall low enough then; what the shape takes away of the residuals says it."""
    bent = POINTS.copy()
    bent[:, 2] = 0.002 * ((POINTS[:, 0] - 0.1) / 0.1) ** 2
    for seed in range(3):
        found = calibrate_corners(POINTS, corner_sets(bent, count, seed=seed), SIZE)
        assert found.warnings[0].startswith("the board is bent by 2") and found.evidence[-1].kept
        assert (np.abs(values(found) - TRUTH) < 4 * np.array([found.stderr[n] for n in NAMES[:4]])).all()


@pytest.mark.parametrize("count", [3, 4, 5, 12, 12, 12])
def test_flat_board_is_flat(count):
    for seed in (10 + count, 20 + count):
        found = calibrate_corners(POINTS, corner_sets(POINTS, count, seed=seed), SIZE)
        assert found.sag is None and not found.evidence[-1].kept


def test_a_bend_that_cannot_be_tested_is_said():
    four = [0, 8, 45, 53]
    views = [xy[four] for xy in corner_sets(POINTS, 8, noise=0.0, seed=1)]
    found = calibrate_corners(POINTS[four], views[:5], SIZE, lens=())
    assert any("too few or too much alike to test whether the board is bent" in text for text in found.warnings)


def test_a_lens_that_lacks_terms_is_said_and_not_blamed_on_the_board(views):
    for lens in ((), ("k1",)):
        found = calibrate_corners(POINTS, views, SIZE, lens=lens)
        assert found.sag is None and found.model == lens
        assert found.warnings[0].startswith(f"lens = {lens} was prescribed, but the corners say {FULL}")
    found = calibrate_corners(POINTS, views, SIZE, lens=FULL)
    assert not any("was prescribed" in text for text in found.warnings)


def test_evidence_gives_the_reason_for_a_bend_that_is_not_kept():
    """A board that sags by another amount in each view: more than chance, but not known well enough."""
    from ir50p_lab.vision.calibration.checks import bent_board
    from ir50p_lab.vision.calibration.fit import CornerSets, Model, fit, start

    views = []
    for k, sag in enumerate(np.random.default_rng(1).normal(0.0003, 0.0004, 13)):
        z = sag * ((POINTS[:, 0] - 0.1) / 0.1) ** 2
        views.append(corner_sets(np.column_stack([POINTS[:, :2], z]), 13, seed=40)[k])
    corners = CornerSets([POINTS] * 13, views, SIZE)
    question, _ = bent_board(corners, fit(corners, Model(("k1", "k2")), start(corners)))
    assert not question.kept and question.p_value < question.limit
    assert "mm of sag are too little beside their error" in str(question)


def test_view_that_does_not_belong_is_left_out(views):
    spoilt = [xy.copy() for xy in views]
    spoilt[6] += np.random.default_rng(0).normal(0, 1.5, spoilt[6].shape)
    found = calibrate_corners(POINTS, spoilt, SIZE)
    assert [(one.index, one.reason) for one in found.rejected] == [(6, Reason.OUTLIER)]
    assert len(found.views) == 14 and abs(found.fx - TRUTH[0]) < 3 * found.stderr["fx"]


def test_view_that_pulls_the_camera_along_is_left_out_too(views):
    """A picture that was cropped: its centre lies elsewhere, and the other views fit badly for its sake."""
    spoilt = [xy.copy() for xy in views]
    spoilt[4] += [300, 0]
    found = calibrate_corners(POINTS, spoilt, (940, 480))
    assert [(one.index, one.reason) for one in found.rejected] == [(4, Reason.OUTLIER)]
    assert (np.abs(values(found) - TRUTH) < 3 * np.array([found.stderr[n] for n in NAMES[:4]])).all()


def test_the_view_that_alone_needs_k3_is_no_outlier():
    """Eleven views in the middle, one far out: 1.4 px off with k1 and k2 only, with good corners."""
    K_wide, lens = np.array([[350, 0, 322.0], [0, 351, 238], [0, 0, 1]]), np.array([-0.3, 0.12, 0, 0, -0.03])
    rng = np.random.default_rng(5)
    poses = [look(0.35, rng.uniform(0.2, 0.6), 0.6 * k, at=rng.uniform(-0.25, 0.25, 2)) for k in range(11)]
    views = [
        cv2.projectPoints(POINTS, cv2.Rodrigues(T[:3, :3])[0], T[:3, 3], K_wide, lens)[0][:, 0]
        + rng.normal(0, 0.07, (54, 2))
        for T in (*poses, look(0.25, 0.3, 2.0, at=(0.7, 0.45)))
    ]
    found = calibrate_corners(POINTS, views, SIZE)
    assert not found.rejected and "k3" in found.model
    assert abs(found.fx - 350) < 3 * found.stderr["fx"]


@pytest.mark.parametrize("count", [5, 8])
def test_corners_without_noise_give_the_camera_itself(count):
    """What is left of the error is rounding, and no step makes it less: that is no fit that does not converge."""
    for seed in range(15):
        found = calibrate_corners(POINTS, corner_sets(POINTS, count, noise=0, seed=seed), SIZE, lens=FULL)
        np.testing.assert_allclose(values(found), TRUTH, rtol=1e-6)


def test_honest_noise_is_no_outlier():
    for seed in range(5):
        assert not calibrate_corners(POINTS, corner_sets(POINTS, 12, seed=30 + seed), SIZE).rejected


def test_too_few_tilts():
    rng = np.random.default_rng(0)
    poses = [
        look(d, 0.03 * (-1) ** k, k, at=at)
        for k, (d, at) in enumerate([(0.4, (0, 0)), (0.5, (0.1, 0)), (0.6, (0, 0.1)), (0.7, (-0.1, 0))])
    ]
    views = [project(T, POINTS) + rng.normal(0, 0.1, (54, 2)) for T in poses]
    found = calibrate_corners(POINTS, views, SIZE, lens=("k1",))
    assert any("too few tilts: 0 of 4" in text for text in found.warnings)
    assert found.stderr["fx"] > 5  # and the standard error says so, too


def test_tilts_about_one_axis():
    rng = np.random.default_rng(0)
    views = [
        project(look(0.5, tilt, 0.0, at=(0.03 * k, 0)), POINTS) + rng.normal(0, 0.1, (54, 2))
        for k, tilt in enumerate((-0.6, -0.4, 0.3, 0.5, 0.6))
    ]
    assert any("one axis" in text for text in calibrate_corners(POINTS, views, SIZE, lens=("k1",)).warnings)


def test_a_fisheye_is_not_passed_off_as_a_lens_of_this_model(calibration):
    """Equidistant, 160 degrees across the diagonal: the polynomial in r is left behind by a pixel."""
    K_fish, rng, views = np.array([[280, 0, 322.0], [0, 280, 238], [0, 0, 1]]), np.random.default_rng(0), []
    while len(views) < 15:
        turn, (aside, about) = rng.normal(0, 0.35, 3), rng.uniform((0, 0), (1.1, 6.28))
        away = np.array([np.sin(aside) * np.cos(about), np.sin(aside) * np.sin(about), np.cos(aside)])
        R = cv2.Rodrigues(turn)[0]
        shift = rng.uniform(0.12, 0.3) * away - R @ POINTS.mean(axis=0)
        if (POINTS @ R.T + shift)[:, 2].min() > 0.02:
            xy = cv2.fisheye.projectPoints(POINTS[None], turn, shift, K_fish, np.zeros(4))[0][0]
            if (xy > 3).all() and (xy < (636, 476)).all():
                views.append(xy)
    assert any("fisheye" in text for text in calibrate_corners(POINTS, views, SIZE).warnings)
    assert not any("fisheye" in text for text in calibration.warnings)


def test_stretched_pictures_are_noticed(views):
    wide = [xy * [4 / 3, 1] for xy in views]
    assert any("not square" in text for text in calibrate_corners(POINTS, wide, (853, 480)).warnings)


def test_a_lens_that_folds_back_is_noticed():
    from dataclasses import replace

    from ir50p_lab.vision.calibration.checks import warnings_about

    found = calibrate_corners(POINTS, corner_sets(POINTS, 8, seed=2), SIZE, lens=("k1",))
    folded = replace(found, distortion=np.array([-1.5, 0, 0, 0, 0]))
    assert any("folds back" in text for text in warnings_about(folded))


def test_views_know_their_poses(calibration, views):
    for view, xy in zip(calibration.views, views, strict=True):
        model = calibration.pinhole.project(view.T_cam_board, view.points)
        assert np.allclose(xy - model, view.residuals, atol=1e-8)
        assert np.isclose(view.rms, np.sqrt((view.residuals**2).sum(axis=1).mean()))
    assert np.isclose(calibration.rms, np.sqrt(np.mean([view.rms**2 for view in calibration.views])))
    assert 0 < min(v.tilt for v in calibration.views) and max(v.tilt for v in calibration.views) < 0.9


@pytest.mark.parametrize(
    ("arguments", "error", "match"),
    [
        ((POINTS, [], SIZE), CalibrationError, "0 views"),
        ((POINTS, [np.zeros((54, 2))] * 2, SIZE), CalibrationError, "2 views"),
        ((POINTS, [np.zeros((53, 2))] * 4, SIZE), InputError, "as many points"),
        ((POINTS, [np.full((54, 2), np.nan)] * 4, SIZE), InputError, "finite"),
        ((POINTS[:, :2], [np.zeros((54, 2))] * 4, SIZE), InputError, "object_points"),
        ((POINTS + [0, 0, 1] * POINTS[:, :1], [np.zeros((54, 2))] * 4, SIZE), InputError, "plane"),
    ],
)
def test_corners_that_are_refused(arguments, error, match):
    with pytest.raises(error, match=match):
        calibrate_corners(*arguments)


def test_one_pose_again_and_again_is_refused(views):
    """One picture of a plane has eight numbers, and ten are asked of it: rounding must not make up the difference."""
    for view in views:
        with pytest.raises(CalibrationError, match="tilt"):
            calibrate_corners(POINTS, [view] * 4, SIZE, lens=())


@pytest.mark.parametrize(
    ("images", "options", "error", "match"),
    [
        ([], {}, InputError, "no pictures"),
        (3, {}, InputError, "list of pictures"),
        (np.zeros((480, 640, 3), np.uint8), {}, InputError, "one picture"),
        ("nowhere/at/all", {}, ImageError, "does not exist"),
        ([np.zeros((480, 640, 3), np.uint8)] * 3, {"board": 9}, InputError, "Checkerboard"),
        (["a.jpg", "b.jpg"], {}, CalibrationError, "2 unreadable"),
    ],
)
def test_pictures_that_are_refused(images, options, error, match):
    with pytest.raises(error, match=match):
        calibrate(images, **options)


def test_empty_folder(tmp_path):
    with pytest.raises(ImageError, match="holds no picture"):
        calibrate(tmp_path)


def test_views_with_different_numbers_of_points(views, calibration):
    some = [slice(9 * (k % 3), None) for k in range(len(views))]
    found = calibrate_corners([POINTS[s] for s in some], [xy[s] for xy, s in zip(views, some, strict=True)], SIZE)
    assert abs(found.fx - calibration.fx) < 3 * found.stderr["fx"]
    assert calibrate_corners(POINTS.tolist(), views, SIZE).fx == pytest.approx(calibration.fx, rel=1e-9)


@pytest.mark.parametrize("size", [(640,), "ab", None, (0, 0), (640.5, 480), (np.nan, 3), (320, 240), (480, 640)])
def test_a_size_that_cannot_be(views, size):
    with pytest.raises(InputError, match="size = "):
        calibrate_corners(POINTS, views, size)


@pytest.mark.parametrize(
    ("points", "seen"), [(None, ...), (POINTS, None), (POINTS, 5), ("x", ...), (POINTS, ["a"] * 4), ([None] * 15, ...)]
)
def test_points_that_are_no_points(views, points, seen):
    with pytest.raises(InputError, match="_points"):
        calibrate_corners(points, views if seen is ... else seen, SIZE)


@pytest.mark.parametrize(
    "option",
    [{"aspect": a} for a in (0, -1, np.nan, "a", True)] + [{"lens": a} for a in (5, (5,), ["k1", None], "k4")]
    + [{"bend": a} for a in (True, "a", 0)],
)  # fmt: skip
def test_options_that_make_no_sense(views, option):
    (name,) = option
    with pytest.raises(InputError, match=f"{name} = "):
        calibrate_corners(POINTS, views, SIZE, **option)
    with pytest.raises(InputError, match=f"{name} = "):
        calibrate(["a.jpg", "b.jpg", "c.jpg"], **option)


def test_unknown_coefficient(views):
    with pytest.raises(InputError, match="k4"):
        calibrate_corners(POINTS, views, SIZE, lens=("k4",))
    assert LENS[4] == 0


# ---- warnings that good-looking fits leave


def stretched(points, bend):
    """Points of a board that is 3 % longer along y than it says, and bent by `bend` m at 0.1 m from its middle."""
    x = (points[:, 0] - points[:, 0].mean()) / 0.1
    return points * [1, 1.03, 1] + np.column_stack([0 * x, 0 * x, bend * x * x])


@pytest.mark.parametrize("seed", range(4))
def test_the_ratio_of_focal_lengths_is_judged_with_its_covariance(seed):
    """A board longer one way looks like pixels that are not square: fx/fy is known far better than fx and fy."""
    right = calibrate_corners(POINTS, corner_sets(POINTS, 8, 0.3, seed), SIZE)
    wrong = calibrate_corners(POINTS, corner_sets(stretched(POINTS, 0.0), 8, 0.3, seed), SIZE)
    assert not any("square" in text for text in right.warnings)
    assert any("pixels are not square" in text for text in wrong.warnings)


@pytest.mark.parametrize("seed", range(3))
def test_a_board_bent_and_stretched_is_said_to_be_not_separable(seed):
    found = calibrate_corners(POINTS, corner_sets(stretched(POINTS, 0.0015), 12, 0.05, seed), SIZE)
    assert found.sag is not None and any("cannot be separated" in text for text in found.warnings)


def zoomed(views, which, other):
    """The views, those of these numbers as a camera with `other` times the focal length sees them."""
    scaled = np.diag([other, other, 1]) @ K
    for i in which:
        ray = cv2.undistortPoints(views[i][:, None], K, LENS)
        views[i] = cv2.projectPoints(cv2.convertPointsToHomogeneous(ray), *np.zeros((2, 3)), scaled, LENS)[0][:, 0]
        views[i] -= (scaled - K)[:2, 2]
    return [xy for xy in views if (xy > 0).all() and (xy < np.array(SIZE) - 1).all()]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("other", [0.8, 0.93, 1.1])
def test_two_cameras_in_one_call_are_noticed(seed, other):
    inside = zoomed(corner_sets(POINTS, 14, 0.1, seed), range(0, 14, 2), other)
    assert any("two cameras" in text for text in calibrate_corners(POINTS, inside, SIZE).warnings)


@pytest.mark.parametrize("seed", range(8))
def test_a_few_views_of_another_camera_are_noticed_and_do_no_harm(seed):
    """They are left out one by one as outliers until too few are left to look like a second camera."""
    rng = np.random.default_rng(seed)
    other = 1 + rng.uniform(0.05, 0.25) * rng.choice([-1, 1])
    found = calibrate_corners(POINTS, zoomed(corner_sets(POINTS, 18, 0.1, seed), range(3), other), SIZE)
    said = " ".join(found.warnings)
    assert "two cameras" in said or "fit no camera that fits the others" in said or len(found.rejected) < 2, found
    if "two cameras" not in said:
        assert (np.abs(values(found) - TRUTH) < 4 * np.array([found.stderr[name] for name in NAMES[:4]])).all()


@pytest.mark.parametrize("seed", range(6))
def test_views_of_a_cropped_picture_are_noticed(seed):
    """The centre is elsewhere in some of the views: a crop to the same size."""
    views = corner_sets(POINTS, 14, 0.1, seed)
    for i in range(0, 14, 2):
        views[i] = views[i] - [50, 40]
    inside = [xy for xy in views if (xy > 0).all()]
    assert any("two cameras" in text for text in calibrate_corners(POINTS, inside, SIZE).warnings)


@pytest.mark.parametrize("seed", range(6))
def test_a_stretched_board_is_not_taken_for_two_cameras(seed):
    """Turned boards ask for different focal lengths: what is wrong is said, not something else; 1 % is noticed."""
    board = POINTS * [1, 1.01 + 0.01 * (seed % 3), 1]
    warnings = calibrate_corners(POINTS, corner_sets(board, 14, 0.1, seed), SIZE).warnings
    assert any("not square" in text for text in warnings) and not any("two cameras" in text for text in warnings)


@pytest.mark.parametrize("seed", range(6))
def test_the_centre_is_no_surer_where_p1_and_p2_are_dropped(seed):
    """They move it; as small as lenses have them, most views cannot see them, and the centre was up to six errors off."""
    small = np.array([*LENS[:2], *np.random.default_rng(seed).normal(0, 4e-4, 2), 0.0])
    seen = corner_sets(POINTS, 14, 0.15, seed, lens=small)
    found, whole = (calibrate_corners(POINTS, seen, SIZE, lens=lens) for lens in (None, (*FULL, "k3")))
    for name in ("cx", "cy"):
        assert found.stderr[name] >= 0.999 * whole.stderr[name]
    assert (np.abs(values(found) - TRUTH)[2:] < 3.5 * np.array([found.stderr[name] for name in ("cx", "cy")])).all()


@pytest.mark.parametrize("seed", range(4))
def test_views_that_contradict_each_other_are_not_asked_for_more_tilt(seed):
    """A board 3 % longer one way, turned by 90 degrees in every second picture."""
    rng, seen = np.random.default_rng(seed), []
    while len(seen) < 14:
        tilt, about, spin = rng.uniform(0.1, 0.75), rng.uniform(0, 2 * np.pi), np.pi / 2 * (len(seen) % 2)
        xy = project(look(rng.uniform(0.4, 0.7), tilt, about, spin, rng.uniform(-0.1, 0.1, 2)), POINTS * [1, 1.03, 1])
        if (xy > 5).all() and (xy < np.array(SIZE) - 6).all():
            seen.append(xy + rng.normal(0, 0.1, xy.shape))
    said = " ".join(calibrate_corners(POINTS, seen, SIZE).warnings)
    assert "contradict each other" in said or "two cameras" in said
    assert "tilt the board more" not in said


@pytest.mark.parametrize("noise", [0.1, 0.5, 1.0])
def test_one_camera_is_not_taken_for_two(noise):
    for seed in range(3):
        found = calibrate_corners(POINTS, corner_sets(POINTS, 12, noise, seed), SIZE)
        assert not any("two cameras" in text for text in found.warnings)
