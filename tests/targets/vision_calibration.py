"""Targets of the calibration: painted sets from random cameras, corners with known noise, errors that must be seen."""

import time

import numpy as np

from ir50p_lab.course.camera.board_poses import board_poses
from ir50p_lab.vision import Checkerboard, Pinhole, calibrate, calibrate_corners
from tests.support.board_pictures import painted_set
from tests.targets.rows import Row

JOINT = 16.25  # chi-square of 4 numbers that 99.73 % stay below: what 3 standard errors are for one


def random_camera(rng):
    """A webcam: focal length, nearly square pixels, centre near the middle, lens with or without each term."""
    f = rng.uniform(600, 900)
    K = np.array(
        [[f, 0, 319.5 + rng.normal(0, 12)], [0, f * rng.normal(1, 0.004), 239.5 + rng.normal(0, 9)], [0, 0, 1]]
    )
    k1 = rng.uniform(-0.22, 0.1)
    k2 = rng.choice([0, -0.4 * k1 * rng.uniform(0.3, 1.2)])
    p = rng.choice([0, 1]) * rng.normal(0, 8e-4, 2)
    return Pinhole(K, (k1, k2, *p, 0), (640, 480))


def off(calibration, camera):
    """(largest error of fx, fy, cx, cy in standard errors, chi-square of the four)."""
    error = np.array([calibration.fx, calibration.fy, calibration.cx, calibration.cy])
    error = error - [camera.fx, camera.fy, camera.cx, camera.cy]
    stderr = np.array([calibration.stderr[name] for name in ("fx", "fy", "cx", "cy")])
    return np.abs(error / stderr).max(), error @ np.linalg.solve(calibration.covariance[:4, :4], error), stderr[0]


def rendered_set(seed, count):
    """(camera, pictures) of a random camera, blur, noise and JPEG."""
    rng = np.random.default_rng([7, seed])
    camera, how = (
        random_camera(rng),
        {"noise": rng.uniform(1, 5), "levels": (rng.uniform(20, 60), rng.uniform(130, 230))},
    )
    blur, jpeg = rng.uniform(0.5, 1.3), int(rng.choice([80, 90, 95]))
    return camera, painted_set(camera, count, 300 + seed, blur=blur, jpeg=jpeg, **how)


def corner_set(seed, count, noise=0.1):
    """(camera, calibration) from corners with noise, no pictures."""
    rng = np.random.default_rng([8, seed])
    camera, points = random_camera(rng), Checkerboard().points
    seen = [camera.project(T, points) + rng.normal(0, noise, (54, 2)) for T in board_poses(camera, count, seed)]
    return camera, calibrate_corners(points, seen, camera.size)


def rows(quick):
    """Rows of the calibration; quick: few sets."""
    sets, views, synthetic = (3, 8, 10) if quick else (50, 12, 50)
    each, joint, errors, refused, seconds = [], [], [], 0, []
    for seed in range(sets):
        camera, images = rendered_set(seed, views)
        start = time.perf_counter()
        calibration = calibrate(images, progress=False)
        seconds.append((time.perf_counter() - start) / views)
        worst, chi2, stderr = off(calibration, camera)
        each, joint, errors = [*each, worst], [*joint, chi2], [*errors, stderr]
        refused += len(calibration.rejected)
    in_each, in_joint = np.mean(np.array(each) < 3), np.mean(np.array(joint) < JOINT)
    found = [
        Row(
            f"fx, fy, cx, cy each within 3 standard errors ({sets} painted sets of {views})",
            ">= 95 %", f"{100 * in_each:.0f} %", ok=bool(in_each >= 0.95),
        ),
        Row(
            "fx, fy, cx, cy jointly within 3 standard errors (chi-square)",
            ">= 95 %", f"{100 * in_joint:.0f} %", ok=bool(in_joint >= 0.95),
        ),
        Row("standard error of fx, median", "-", f"{np.median(errors):.2f} px", "not given"),
        Row("good pictures refused", "-", f"{refused} of {sets * views}"),
        Row("time for a picture, median", "-", f"{1000 * np.median(seconds):.0f} ms"),
    ]  # fmt: skip
    ratios, hits = [], []
    for seed in range(synthetic):
        camera, calibration = corner_set(seed, 20)
        p, n = 4 + len(calibration.model) + 6 * 20, 20 * 54
        ratios.append(calibration.rms / (0.1 * np.sqrt(2) * np.sqrt(1 - p / (2 * n))))
        worst, chi2, _ = off(calibration, camera)
        hits.append(worst < 3 and chi2 < JOINT)
    away = np.abs(np.array(ratios) - 1).max()
    found += [
        Row(
            f"rms against 0.1 sqrt(2) sqrt(1 - p/2N), worst of {synthetic} sets of corners",
            "<= 5 %", f"{100 * away:.1f} %", "0.15 px mean error", ok=bool(away <= 0.05),
        ),
        Row(
            "fx, fy, cx, cy within 3 standard errors, both ways, from corners",
            ">= 95 %", f"{100 * np.mean(hits):.0f} %", ok=bool(np.mean(hits) >= 0.95),
        ),
    ]  # fmt: skip
    return [*found, bent_row(quick)]


def bent_row(quick):
    """A bent board is recognised, a flat one is not taken for bent."""
    seen, count = 0, 2 if quick else 10
    for seed in range(count):
        bend = 0.0 if seed % 2 else 0.12  # 1/m: 0.6 mm over 20 cm
        camera = random_camera(np.random.default_rng([9, seed]))
        calibration = calibrate(painted_set(camera, 8, 500 + seed, bend=bend, jpeg=92), progress=False)
        said = any("board is bent" in text for text in calibration.warnings)
        seen += said == (seed % 2 == 0)
    what = f"bend of 0.6 mm over 200 mm recognised, flat boards flat ({count} sets)"
    return Row(what, "all", f"{seen} of {count}", ok=seen == count)
