"""Calibrate a camera with pictures of a board: focal lengths, centre, lens distortion, and how sure they are."""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.inputs import choice, number
from ir50p_lab.vision.board_pose import transform
from ir50p_lab.vision.calibration import checks
from ir50p_lab.vision.calibration.board import Charuco, Checkerboard
from ir50p_lab.vision.calibration.charuco import find_charuco
from ir50p_lab.vision.calibration.corners import BoardCorners, find_checkerboard
from ir50p_lab.vision.calibration.fit import LENS, NAMES, CornerSets, Model, fit, start
from ir50p_lab.vision.calibration.models import choose, in_percent, total_covariance
from ir50p_lab.vision.calibration.pictures import common_size, pictures_of, with_bar
from ir50p_lab.vision.calibration.reasons import NotUsable, Reason, Rejected
from ir50p_lab.vision.calibration.result import Calibration, View
from ir50p_lab.vision.checks import picture_size, point_list

_FEWEST = 3
_SAME = 1.0 / 800  # of the diagonal: a board that moved less is taken for the same view
_COMMON = 0.8  # of the corners seen, at which two views of part of a board are compared


def calibrate(images, pattern=(9, 6), square=0.025, *, board=None, lens=None, aspect=None, bend=None, progress=None):
    """Calibrate a camera from pictures of a checkerboard or ChArUco board.

    Corners are found by both of OpenCV's finders and refined to sub-pixel; pictures that are of no use are left out,
    each with a Reason; the lens model is the simplest that the corners do not object to (k1, k2, p1, p2, k3, see
    `calibration_models`); standard errors are the larger of two kinds. A bent board is recognised, and then estimated
    with the camera.

    On OpenCV's photographs left01.jpg to left14.jpg it finds fx = 533.2 +- 0.6 px where OpenCV's left_intrinsics.yml
    says 535.9: there corners were refined in windows of 23 px, and the smallest squares in left02.jpg measure 22 px, so
    that corners moved by up to 6 px (1.2 px rms are left in that file). With windows of 11 px OpenCV finds 532.8.

    Args:
        images: list of pictures (h, w, 3) uint8 RGB, grey ones (h, w), Frames or paths, mixed; or a folder.
        pattern: (columns, rows) of inner corners; square: side of a square, m. A wrong square scales the distances of
        the board, nothing else: K and distortion come out the same.
        board: Checkerboard or Charuco in place of pattern and square.
        lens: None to let the data choose, or coefficients to estimate, such as ("k1", "k2"); () for none.
        aspect: None estimates fx and fy; a number prescribes fx/fy (1 for square pixels), and is checked.
        bend: None tests whether the board is bent, and estimates its shape if so; False takes it for flat all the same.
        progress: True or False to show a bar; None: from 8 pictures on.

    Returns: Calibration.
    Raises CalibrationError if fewer than 3 pictures are of use (the message says why), or they determine no camera;
    InputError for arguments that make no sense; ImageError if `images` is an empty or missing folder.
    """
    board = board if board is not None else Checkerboard(pattern, square)
    if not isinstance(board, Checkerboard):
        raise InputError(f"board = {board!r}: give a Checkerboard or a Charuco")
    options = _options(lens, aspect, bend)
    pictures = pictures_of(images, progress)
    found, rejected, seen = [], [], Counter()
    size = common_size(pictures)
    for picture in with_bar(pictures, progress):
        try:
            other = max((one for one in seen if one and seen[one] > len(found)), key=seen.get, default=None)
            found.append((picture.name, picture.index, _corners_in(picture, board, size, other)))
        except NotUsable as why:
            rejected.append(Rejected(picture.name, picture.index, why.reason, why.detail))
            seen[why.seen] += 1
    found = _without_duplicates(found, size, board, rejected)
    if len(found) < _FEWEST:
        raise CalibrationError(_why_too_few(len(found), rejected, seen, board))
    return _calibrate(found, size, board, board.points, options, rejected)


def calibrate_corners(object_points, image_points, size, *, lens=None, aspect=None, bend=None):
    """Calibrate from corners that were found elsewhere.

    Args:
        object_points: for each view the points on the board (n, 3) m, z = 0; or one array for all of them.
        image_points: for each view the pixels (n, 2); also (n, 1, 2) as OpenCV has them.
        size: (width, height) of the picture, px. lens, aspect, bend: as for `calibrate`.

    Returns: Calibration. Raises CalibrationError as `calibrate`, InputError for shapes that do not fit, or NaN.
    """
    options, size = _options(lens, aspect, bend), picture_size(size)
    if not np.iterable(image_points) or not np.iterable(object_points) or len(object_points) == 0:
        raise InputError("object_points and image_points: give lists with the points of each view, (n, 3) and (n, 2)")
    pixels = [point_list("image_points", one, 2) for one in image_points]
    if np.ndim(object_points[0]) < 2:
        object_points = [object_points] * len(pixels)
    points = [point_list("object_points", one, 3, "m") for one in object_points]
    if [len(p) for p in points] != [len(xy) for xy in pixels] or min(map(len, points), default=4) < 4:
        raise InputError("object_points and image_points must hold as many views, and each as many points, at least 4")
    if len(pixels) < _FEWEST:
        raise CalibrationError(f"{len(pixels)} views: at least {_FEWEST} are needed, 10 to 20 are good")
    if any(np.ptp(p[:, 2]) > 0 for p in points):
        raise InputError("object_points must lie in the plane z = 0 of the board")
    outside = [xy for xy in np.concatenate(pixels) if (xy < -1.5).any() or (xy > np.array(size) + 0.5).any()]
    if outside:
        raise InputError(f"corner {outside[0].round()} lies outside pictures of size = {size}: give (width, height)")
    everything, inverse = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    places = np.split(inverse.ravel(), np.cumsum([len(p) for p in points])[:-1])
    found = [(f"view {i + 1}", i, BoardCorners(*one)) for i, one in enumerate(zip(pixels, places, strict=True))]
    return _calibrate(found, size, _board_like(everything), everything, options, [])


def _calibrate(found, size, board, points, options, rejected):
    """From (name, index, BoardCorners) to a Calibration: outlier views out, lens chosen, bend of the board tested."""
    wanted, aspect, bend = options
    corners = CornerSets([points[one.index] for _, _, one in found], [one.xy for _, _, one in found], size)
    full = fit(corners, Model(LENS, aspect), start(corners))
    for _ in range(max(1, len(found) // 4)):
        outlier = checks.outlier_view(corners, full)
        if outlier is None:
            break
        worst, rms, corners, full = outlier
        name, index, _ = found.pop(worst)
        detail = f"its corners are {rms:.2g} px off the model, those of the others {np.median(full.view_rms):.2g} px"
        rejected.append(Rejected(name, index, Reason.OUTLIER, detail))
    best, evidence, tried, said = _best(corners, full, wanted, bend)
    if not any("was prescribed" in text for text in said):  # else what is prescribed explains the residuals
        said = checks.two_cameras(corners, best) + said
    views = tuple(
        View(
            name=name,
            index=index,
            points=points[one.index],
            corners=one.xy,
            residuals=residuals,
            T_cam_board=transform(pose[:3], pose[3:]),
        )
        for (name, index, one), residuals, pose in zip(found, best.residuals, best.poses, strict=True)
    )
    total = total_covariance(best, tried, full if wanted is None else best)
    result = Calibration(
        K=np.array([[best.camera[0], 0, best.camera[2]], [0, best.camera[1], best.camera[3]], [0, 0, 1.0]]),
        distortion=best.camera[4:9].copy(),
        rms=best.rms,
        stderr=_named(total, best),
        covariance=total,
        views=views,
        rejected=tuple(sorted(rejected, key=lambda one: one.index)),
        size=size,
        board=board,
        model=best.model.lens,
        evidence=evidence,
        sigma=best.sigma,
        sag=best.camera[9:].copy() if best.model.bent else None,
        stderr_corners=_named(best.by_corners, best),
        stderr_views=_named(best.by_views if len(views) > 3 else best.by_corners, best),
    )
    if len(rejected) > len(views):
        said.append(f"{len(rejected)} of {len(rejected) + len(views)} pictures were of no use: see `rejected`")
    odd = sum(one.reason == Reason.OUTLIER for one in rejected)
    if odd > 1:
        said.append(f"{odd} views fit no camera that fits the others: another camera, or zoomed? See `rejected`")
    return replace(result, warnings=(*said, *checks.warnings_about(result)))


def _best(corners, full, wanted, bend):
    """(CameraFit, evidence, models tried, warnings): lens as the data say or as asked for, board flat or bent, aspect.

    Whether the board is bent is asked with all that the lens needs: what a prescribed lens lacks looks like a bend.
    """
    said = []

    def estimate(full):
        if wanted is None:
            best, evidence, tried = choose(corners, full)
            return best, best, None, evidence, tried
        held = fit(corners, full.model.with_lens(wanted), full)
        lacking, wide = checks.lacking_terms(corners, held, full)
        return held, wide, lacking, (lacking,) if lacking else (), ((held.camera, 0.0),)

    best, wide, lacking, evidence, tried = estimate(full)
    try:
        shape, bent = checks.bent_board(corners, wide)
        if shape.kept and bend is None:
            best, wide, lacking, evidence, tried = estimate(fit(corners, bent.model.with_lens(LENS), bent))
        evidence += (shape,)
    except CalibrationError:
        shape = None
        said.append("the views are too few or too much alike to test whether the board is bent")
    if best.model.bent:
        size, error = checks.sag(corners, best)
        said.append(
            f"the board is bent by {1e3 * size:.2g} +- {1e3 * error:.1g} mm: its shape was estimated with the camera. "
            "Glue it to glass or a plate and repeat"
        )
    prescribed = [("lens", best.model.lens, wide.model.lens, lacking)]
    if bend is False:
        prescribed.append(("bend", False, "that the board is bent", shape))
    if full.model.aspect:
        question, ratio = checks.free_aspect(corners, wide)
        evidence += (question,)
        prescribed.append(("aspect", full.model.aspect, f"fx/fy = {ratio:.4f}", question))
    said += [
        f"{name} = {value} was prescribed, but the corners say {says} (by chance: {in_percent(question.p_value)}): "
        f"leave {name}=None"
        for name, value, says, question in prescribed
        if question is not None and question.kept
    ]
    return best, evidence, tried, said


def _named(covariance, fitted):
    used = fitted.model.columns.any(axis=1)
    return {name: float(np.sqrt(covariance[i, i])) if used[i] else float("nan") for i, name in enumerate(NAMES)}


def _options(lens, aspect, bend):
    """(coefficients of the lens, aspect, bend), checked. Raises InputError."""
    if aspect is not None:
        aspect = number("aspect", aspect, "> 0", hint="fx/fy, 1 for square pixels, or None to estimate it")
    if bend is not None and choice("bend", bend, (True, False)):
        raise InputError("bend = True: give None to test for a bend and estimate it, or False for a flat board")
    if lens is not None:
        names = [lens] if isinstance(lens, str) or not np.iterable(lens) else list(lens)
        if any(name not in LENS for name in names):
            raise InputError(f"lens = {lens!r}: give coefficients out of {LENS}, or None to let the data choose")
        lens = tuple(name for name in LENS if name in names)
    return lens, aspect, bend


def _board_like(points):
    """The checkerboard that points (n, 3) seem to be of, for coverage and advice."""
    columns, rows = (len(np.unique(points[:, k].round(9))) for k in (0, 1))
    width = float(np.ptp(points[:, 0]))
    return Checkerboard((max(columns, 3), max(rows, 3)), width / max(columns - 1, 1) if width else 0.025)


def _corners_in(picture, board, size, other):
    if picture.problem is not None:
        raise NotUsable(Reason.UNREADABLE, picture.problem)
    if picture.size != size:
        raise NotUsable(
            Reason.OTHER_SIZE,
            f"{picture.size[0]}x{picture.size[1]}, most are {size[0]}x{size[1]}: another size is another camera",
        )
    import cv2

    try:
        if isinstance(board, Charuco):
            return find_charuco(picture.image, board)
        return find_checkerboard(picture.image, board.pattern, other)
    except cv2.error as error:  # one picture must not lose the others
        raise NotUsable(Reason.NO_BOARD, f"OpenCV finds no corners in it: {' '.join(str(error).split())}") from error


def _without_duplicates(found, size, board, rejected):
    """The views in which the board is not where it was before; the others go to `rejected`."""
    kept = []
    places = np.full((len(found), len(board.points), 2), np.nan)
    for k, (name, index, corners) in enumerate(found):
        places[k, corners.index] = corners.xy
        moved = np.linalg.norm(places[kept] - places[k], axis=2)
        common, still = np.isfinite(moved).sum(axis=1), (moved < _SAME * np.hypot(*size)).sum(axis=1)
        same = np.flatnonzero((common >= _COMMON * len(corners.index)) & (still > common / 2))
        if len(same):
            least, first = np.nanmedian(moved[same[0]]), found[kept[same[0]]][0]
            detail = f"the board is where it was in {first}, {least:.2f} px away: move it between pictures"
            rejected.append(Rejected(name, index, Reason.DUPLICATE, detail))
        else:
            kept.append(k)
    return [found[k] for k in kept]


def _why_too_few(count, rejected, seen, board):
    reasons = Counter(str(one.reason) for one in rejected)
    message = f"{count} usable pictures of a {board}, at least {_FEWEST} are needed, 10 to 20 are good"
    if rejected:
        message += "; the others: " + ", ".join(f"{n} {reason}" for reason, n in reasons.most_common())
    likely, often = max(((parts, n) for parts, n in seen.items() if parts), key=lambda one: one[1], default=(None, 0))
    if likely and (reasons.get(Reason.WRONG_BOARD) or often >= _FEWEST):
        message += f". They seem to show a board with {likely[0]}x{likely[1]} inner corners: pattern={likely}"
    elif rejected:
        message += f". The first: {Path(rejected[0].name).name}: {rejected[0].detail}"
    return message
