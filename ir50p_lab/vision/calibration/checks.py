"""What may be wrong with a calibration although it fits: each question with its answer as a sentence, or none."""

from dataclasses import replace

import numpy as np

from ir50p_lab.errors import CalibrationError
from ir50p_lab.vision.calibration.fit import Guess, fit, pulls
from ir50p_lab.vision.calibration.models import ask, choose, contrast_of

_TILTED = np.deg2rad(15)
_LIMIT = 1e-3  # chance below which a bend, another ratio fx/fy, or a lens with more terms is believed
_GONE = 0.33  # part of the sum of squares: 2 mm of sag make 0.39 of it or more, flat boards in photographs 0.22 or less
_SQUARE = 0.0075  # difference of fx and fy that sensors have without anything being wrong
# Two cameras: by which share they leave fewer squares (0.08 at most in 100 sets of one), by which part of the focal
# length and how many standard errors they differ
_FEWER, _APART, _SIGMAS = 0.12, 0.01, 5.0
_CONTRADICT = 4.0  # standard error by views over that by corners: up to 2.3 for little tilt, 3.4 or more for two zooms
_ROUGH = 0.7  # px rms, of pictures up to 1280 px wide; corners err by 0.05 to 0.5
_STRETCHED = {
    False: "Rare in a webcam: was the picture stretched (4:3 to 16:9), or is the board bent or stretched (paper)? "
    "Measure its squares both ways, use a flat plate",
    True: "The board is bent; if it or the picture is stretched as well, that cannot be separated from fx/fy, and both "
    "focal lengths may be off by as much. Use a flat plate, or aspect=1 for square pixels",
}


def outlier_view(corners, fitted):
    """(number of the view that fits worst, its rms, px, CornerSets and CameraFit without it), or None if it belongs.

    fitted: CameraFit with the full lens: a view far out may be the only one that needs its k3. The view must be three
    times worse than the median view, and eight times the usual scatter of views above it. A view that is far off pulls
    the camera along and spoils the others, too: if they fit twice as well without it, it is tested by the camera that
    they make without it.
    """
    rms = fitted.view_rms
    worst = int(np.argmax(rms))
    others = np.delete(rms, worst)
    if len(rms) < 5 or rms[worst] < 2 * np.median(others):
        return None
    kept = np.arange(len(rms)) != worst
    rest = corners.only(np.flatnonzero(kept))
    try:
        alone = fit(rest, fitted.model, Guess(fitted.camera, fitted.poses[kept]))
    except CalibrationError:
        return None
    off = _seen_by(alone.camera, corners, worst, fitted.poses[worst])
    pulled = np.median(alone.view_rms) < 0.5 * np.median(others) and off > _far_off(alone.view_rms)
    return (worst, off, rest, alone) if pulled or rms[worst] > _far_off(others) else None


def _far_off(rms):
    """Limit of what one more view may be off, px, beside others of these rms."""
    scatter = 1.4826 * np.median(np.abs(rms - np.median(rms)))
    return max(np.median(rms) + max(2 * np.median(rms), 8 * scatter), 0.02)


def _seen_by(camera, corners, view, pose):
    """rms, px, of the corners of a view for a camera (12,) that does not know it: only the pose is fitted."""
    import cv2

    K = np.array([[camera[0], 0, camera[2]], [0, camera[1], camera[3]], [0, 0, 1]])
    points, pixels = corners.points[view], corners.pixels[view]
    _, turn, shift = cv2.solvePnP(points, pixels, K, camera[4:9], pose[:3].copy(), pose[3:].copy(), True)
    xy, _ = cv2.projectPoints(points, turn, shift, K, camera[4:9])
    return float(np.sqrt(((pixels - xy[:, 0]) ** 2).sum(axis=1).mean()))


def two_cameras(corners, best):
    """A sentence if the views are of two cameras (or the zoom was changed between them), else none: a list.

    Two cameras, each with its own views, must leave fewer squares, and differ in focal length or centre. Views of a
    stretched board ask for different focal lengths as well, by how the board was turned.
    """
    parts = _two_heaps(*pulls(corners, best), _FEWER / 2 * best.cost)
    if not parts or all(_not_square(best.camera, covariance)[0] for covariance in (best.by_corners, best.by_views)):
        return []
    model = best.model.with_lens(name for name in best.model.lens if name in ("k1", "k2"))
    try:
        one, other = (fit(corners.only(part), model, Guess(best.camera, best.poses[part])) for part in parts)
    except CalibrationError:
        return []
    apart, error = np.abs(one.camera - other.camera), np.hypot(one.stderr, other.stderr)
    differ = apart > np.maximum(_APART * best.camera[0], _SIGMAS * error)
    if one.cost + other.cost > (1 - _FEWER) * best.cost or not differ[[0, 2, 3]].any():
        return []
    groups = " and ".join(
        "{} with fx = {:.0f} px, centre ({:.0f}, {:.0f})".format(len(each.poses), *each.camera[[0, 2, 3]])
        for each in (one, other)
    )
    return [f"these seem to be pictures of two cameras, or zoom or crop was changed: {groups}. Calibrate them apart"]


def _two_heaps(S, g, least):
    """The views (two arrays) of the two cameras that explain most, each at least three; or none.

    S, g: of `pulls`; least: px^2 to explain. As in k-means: a step of the camera for each heap, then each view to the
    step that suits it.
    """
    found, most = (), least
    for first in (g > 0).T:
        for _ in range(10):
            heaps = [np.flatnonzero(first), np.flatnonzero(~first)]
            if min(map(len, heaps)) < 3:
                break
            steps = [np.linalg.solve(S[heap].sum(axis=0), g[heap].sum(axis=0)) for heap in heaps]
            change = [np.einsum("vij,i,j->v", S, d, d) - 2 * g @ d for d in steps]
            gain = -float(np.minimum(*change).sum())
            if gain > most:
                found, most = heaps, gain
            first = change[0] < change[1]
    return found


def lacking_terms(corners, held, full):
    """(Evidence or None, CameraFit with them): whether a prescribed lens lacks terms that the corners ask for.

    None, and the fit that was held, if the lens that the corners would choose has no others, or they cannot say.
    """
    try:
        chosen, _, _ = choose(corners, full)
    except CalibrationError:
        return None, held
    lacking = tuple(name for name in chosen.model.lens if name not in held.model.lens)
    if not lacking:
        return None, held
    wide = fit(corners, held.model.with_lens((*held.model.lens, *lacking)), chosen)
    question = _clear(ask(f"lens lacks {' and '.join(lacking)}", wide, contrast_of(lacking), _LIMIT)[0], held, wide)
    return question, wide if question.kept else held


def bent_board(corners, flat):
    """(Evidence whether the same bend of the board shows in all the views, CameraFit with it).

    A bend moves the same corners of the board in every view, as far as it is tilted; three numbers describe it to
    second order. Raises CalibrationError if the views cannot tell them from the camera.
    """
    bent = fit(corners, replace(flat.model, bent=True), flat)
    question = _clear(ask("bent board", bent, np.eye(12)[9:], _LIMIT)[0], flat, bent)
    size, error = sag(corners, bent)
    if question.kept and (question.gain <= 15 or size <= 4 * error):
        why = f"the {1000 * size:.2g} mm of sag are too little beside their error, {1000 * error:.1g} mm"
        question = replace(question, kept=False, why=why)
    return question, bent


def _clear(question, small, large):
    """The Evidence, kept also where a third of the sum of squares is gone.

    With few views the p-value by views can hardly fall below the limit, whatever the corners say.
    """
    gone = 1 - large.cost / small.cost
    if question.kept or gone < _GONE:
        return question
    return replace(question, kept=True, why=f"{100 * gone:.0f} % of the squared residuals are gone")


def sag(corners, bent):
    """(largest height of the board over the plane nearest to it, its standard error), m, for a CameraFit."""
    plane, shapes = np.concatenate(corners.points), corners.shapes[corners.there[..., 0, 0] > 0]
    plane[:, 2] = 1
    z = shapes @ np.column_stack([bent.camera[9:], bent.stderr[9:]])
    z -= plane @ np.linalg.lstsq(plane, z, rcond=None)[0]
    size, error = np.ptp(z, axis=0)
    return float(size), float(error / np.sqrt(3))


def free_aspect(corners, held):
    """(Evidence, fx/fy): whether the prescribed ratio of the focal lengths contradicts the corners."""
    free = fit(corners, replace(held.model, aspect=None), held)
    contrast = np.zeros(12)
    contrast[:2] = 1, -held.model.aspect
    return ask("fx/fy free", free, contrast, _LIMIT)[0], free.camera[0] / free.camera[1]


def _not_square(camera, covariance):
    """(Whether fx/fy differs from 1 by more than chance and sensors do, fx/fy, its standard error)."""
    fx, fy = camera[:2]
    slope = np.array([1 / fx, -1 / fy])  # fx and fy err together: their ratio is known far better than they
    error = fx / fy * float(np.sqrt(max(slope @ covariance[:2, :2] @ slope, 0.0)))
    return abs(fx / fy - 1) > max(_SQUARE, 3 * error), fx / fy, error


def warnings_about(calibration):
    """What to mind although the corners fit, sentence by sentence.

    Coefficients that mean nothing, and a lens that folds back; focal lengths and a centre that a camera hardly has;
    views that are too few, too much alike, or leave part of the picture empty.
    """
    (w, h), K, views, pinhole = calibration.size, calibration.K, calibration.views, calibration.pinhole
    for name in calibration.model:
        value, error = calibration.values[name], max(calibration.stderr_corners[name], calibration.stderr_views[name])
        if abs(value) < 2 * error:
            yield f"{name} = {value:.2g} +- {error:.2g} cannot be told from zero: it means nothing by itself"
    ends = np.array([[0, 0], [w, 0], [0, h], [w, h]]) - K[:2, 2]
    farthest = K[0, 0] * pinhole.distort((min(pinhole.widest, 1e3), 0.0))[0]
    if np.isfinite(pinhole.widest) and farthest < np.linalg.norm(ends, axis=1).max():
        yield f"the lens model folds back {farthest:.0f} px from the centre: hold the board in the corners, too"
    if calibration.rms > _ROUGH * max(1, w / 1280):
        yield f"rms {calibration.rms:.2g} px is more than corners err: a fisheye, or did focus or zoom change?"
    oblong, ratio, error = _not_square(np.diag(K), calibration.covariance)
    if oblong:
        yield f"fx/fy = {ratio:.3f} +- {error:.1g}: pixels are not square. {_STRETCHED[calibration.sag is not None]}"
    off = np.abs(K[:2, 2] - [(w - 1) / 2, (h - 1) / 2]) / (w, h)
    if off.max() > 0.15:
        yield f"the centre ({K[0, 2]:.0f}, {K[1, 2]:.0f}) is far from the middle: were the pictures cropped?"
    relative = max(calibration.stderr["fx"] / K[0, 0], calibration.stderr["fy"] / K[1, 1])
    apart = max(calibration.stderr_views[f] / calibration.stderr_corners[f] for f in ("fx", "fy"))
    if relative > 0.01:
        differ = "the views contradict each other: zoom changed, board bent or stretched?"
        remedy = differ if len(views) >= 8 and apart > _CONTRADICT else "tilt the board more, take more views"
        yield f"the focal length is known to {100 * relative:.1f} % only: {remedy}"
    if len(views) < 8:
        yield f"{len(views)} views are few: 10 to 20 make the standard errors themselves trustworthy"
    tilted = np.array([v.T_cam_board[:2, 2] for v in views if v.tilt > _TILTED])
    if len(tilted) < 3:
        yield f"too few tilts: {len(tilted)} of {len(views)} views by more than 15 degrees; only they tell focal length"
    elif (s := np.linalg.svd(tilted / np.linalg.norm(tilted, axis=1, keepdims=True), compute_uv=False))[1] < 0.3 * s[0]:
        yield "all tilts are about one axis: tilt the board up or down as well as left or right"
    distance = float(np.median([np.linalg.norm(v.T_cam_board[:3, 3]) for v in views]))
    if not 0.04 < distance < 15:
        yield f"the board seems {distance:.3g} m away: is square in metres? K and distortion do not depend on it"
    cover = calibration.coverage
    if cover.share < 0.5:
        yield f"corners fill {100 * cover.share:.0f} % of the picture only: {calibration.next_view().text}"
    elif cover.reach < 0.6:
        yield f"no corner beyond {100 * cover.reach:.0f} % of the way to the picture's: the lens there is a guess"
