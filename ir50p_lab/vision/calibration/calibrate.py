"""Calibrate a camera with pictures of a checkerboard: OpenCV's fit, with standard errors and a reason for each refusal."""

from collections import Counter
from pathlib import Path

import cv2
import numpy as np

from ir50p_lab.errors import CalibrationError, ImageError, InputError
from ir50p_lab.inputs import number
from ir50p_lab.vision.board_pose import transform
from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.calibration.corners import find_checkerboard
from ir50p_lab.vision.calibration.reasons import NotUsable, Reason, Rejected
from ir50p_lab.vision.calibration.result import LENS, NAMES, Calibration, View
from ir50p_lab.vision.checks import picture_size, point_list
from ir50p_lab.vision.image import list_images, load_image

_FEWEST = 3
_LENS = ("k1", "k2", "p1", "p2")  # k3 runs wild beyond the outermost corner: it must be asked for


def calibrate(images, pattern=(9, 6), square=0.025, *, lens=_LENS, aspect=None, progress=None):
    """Calibrate a camera from pictures (h, w, 3) or their paths, or a folder: Calibration.

    pattern: (columns, rows) of inner corners; square: m, of a side; lens: coefficients to estimate out of k1, k2, p1,
    p2, k3; aspect: fx/fy if it is known; progress: show a bar (None: from 8 pictures on).
    Raises CalibrationError if fewer than 3 pictures are of use: the message says why.
    """
    board = Checkerboard(pattern, square)
    _options(lens, aspect)
    if isinstance(images, np.ndarray) and images.ndim < 4 or not np.iterable(images) or hasattr(images, "image"):
        raise InputError("images: give a list of pictures or paths, or a folder; one picture is not enough")
    images = list_images(images) if isinstance(images, str | Path) else list(images)
    if not images:
        raise InputError("no pictures were given: take 10 to 20 of the board, in different places and tilts")
    pictures = [_picture(k, one) for k, one in enumerate(images)]
    sizes = Counter(grey.shape[::-1] for _, grey in pictures if grey is not None)
    if not sizes:
        raise CalibrationError("no picture can be read: " + (str(pictures[0][0]) if pictures else "none was given"))
    size, found, rejected, seen = sizes.most_common(1)[0][0], [], [], Counter()
    for k, (name, grey) in enumerate(_with_bar(pictures, progress)):
        try:
            found.append((name, k, _corners(grey, size, board, found, name)))
        except NotUsable as why:
            rejected.append(Rejected(name, k, why.reason, why.detail))
            seen[why.seen] += 1
    if len(found) < _FEWEST:
        raise CalibrationError(_why_too_few(len(found), rejected, seen, board))
    corners = [xy for _, _, xy in found]
    for _ in range(len(found) // 4):  # a view that fits no camera that fits the others
        rms = calibrate_corners(board.points, corners, size, lens=lens, aspect=aspect).view_rms
        worst, others = int(np.argmax(rms)), np.delete(rms, np.argmax(rms))
        if len(rms) < 5 or rms[worst] < 3 * np.median(others) or rms[worst] < np.mean(others) + 8 * np.std(others):
            break
        name, index, _ = found.pop(worst)
        corners.pop(worst)
        detail = f"its corners are {rms[worst]:.2g} px off the model, those of the others {np.median(others):.2g} px"
        rejected.append(Rejected(name, index, Reason.OUTLIER, detail))
    names = [(name, index) for name, index, _ in found]
    rejected = tuple(sorted(rejected, key=lambda one: one.index))
    return calibrate_corners(board.points, corners, size, lens=lens, aspect=aspect, names=names, rejected=rejected, board=board)


def calibrate_corners(points, corners, size, *, lens=_LENS, aspect=None, names=(), rejected=(), board=None):
    """The same from corners found before: points (n, 3) m on the board, or one such array a view; corners (n, 2) px."""
    size = picture_size(size)
    if not np.iterable(corners) or not np.iterable(points) or len(points) == 0:
        raise InputError("object_points and image_points: give lists with the points of each view, (n, 3) and (n, 2)")
    pixels = [point_list("image_points", one, 2) for one in corners]
    points = [points] * len(pixels) if np.ndim(points[0]) < 2 else points
    points = [point_list("object_points", one, 3, "m") for one in points]
    if [len(p) for p in points] != [len(xy) for xy in pixels] or min(map(len, points), default=4) < 4:
        raise InputError("object_points and image_points must hold as many views, and each as many points, at least 4")
    if len(pixels) < _FEWEST:
        raise CalibrationError(f"{len(pixels)} views: at least {_FEWEST} are needed, 10 to 20 are good")
    if any(np.ptp(p[:, 2]) > 0 for p in points):
        raise InputError("object_points must lie in the plane z = 0 of the board")
    lens, aspect = _options(lens, aspect)
    camera, poses, residuals = _fit(points, pixels, size, lens, aspect)
    said, shape = [], None
    if board is not None and not aspect:
        shape = _shape(points, pixels, size, board, sum((e**2).sum() for e in residuals))
    if shape is not None:
        points = [shape] * len(points)
        camera, poses, residuals = _fit(points, pixels, size, lens, aspect, _matrix(camera))
        said.append(f"the board is bent by {1e3 * np.ptp(shape[:, 2]):.1f} mm: glue it to glass or a plate and repeat")
    stderr, covariance, sigma, apart = _errors(points, residuals, camera, poses, lens, aspect)
    T = [transform(*pose) for pose in poses]
    names = names or [(f"view {k + 1}", k) for k in range(len(pixels))]
    K, distortion = _matrix(camera), camera[4:]
    views = tuple(
        View(name=name, index=k, points=p, corners=xy, residuals=e, T_cam_board=pose)
        for (name, k), p, xy, e, pose in zip(names, points, pixels, residuals, T, strict=True)
    )
    found = Calibration(
        K=K,
        distortion=distortion,
        rms=float(np.sqrt(np.mean([(e**2).sum(axis=1).mean() for e in residuals]))),
        stderr=stderr,
        covariance=covariance,
        views=views,
        rejected=rejected,
        size=size,
        board=board or Checkerboard(),
        model=tuple(name for name in LENS if name in lens),
        sigma=sigma,
    )
    warnings = (*said, *_warnings(found))
    if apart > 3:
        warnings = ("the views contradict each other: two cameras, or was zoom, focus or the board changed?", *warnings)
    if aspect:
        free = _fit(points, pixels, size, lens, None)[0]
        if abs(free[0] / free[1] / aspect - 1) > 0.0075:
            warnings = (f"aspect = {aspect} was prescribed, but the corners say fx/fy = {free[0] / free[1]:.4f}", *warnings)
    object.__setattr__(found, "warnings", warnings)
    return found


def _options(lens, aspect):
    if aspect is not None:
        aspect = number("aspect", aspect, "> 0", hint="fx/fy, 1 for square pixels, or None to estimate it")
    names = [lens] if isinstance(lens, str) or not np.iterable(lens) else list(lens)
    if any(name not in LENS for name in names):
        raise InputError(f"lens = {lens!r}: give coefficients out of {LENS}")
    return tuple(names), aspect


def _matrix(camera):
    return np.array([[camera[0], 0, camera[2]], [0, camera[1], camera[3]], [0, 0, 1]])


def _fit(points, pixels, size, lens, aspect, start=None):
    """camera (9,), poses [(rvec, tvec)], residuals [(n, 2)]."""
    flags = 0
    for name, flag in zip(("k1", "k2", "k3"), (cv2.CALIB_FIX_K1, cv2.CALIB_FIX_K2, cv2.CALIB_FIX_K3), strict=True):
        flags |= 0 if name in lens else flag
    flags |= 0 if "p1" in lens else cv2.CALIB_ZERO_TANGENT_DIST
    if start is not None:  # a bent board needs one
        flags |= cv2.CALIB_USE_INTRINSIC_GUESS
    if aspect:
        start, flags = np.diag([aspect, 1.0, 1.0]), flags | cv2.CALIB_FIX_ASPECT_RATIO
    many = [[np.float32(one) for one in each] for each in (points, pixels)]
    try:
        _, K, d, *poses = cv2.calibrateCamera(*many, size, start, None, flags=flags, criteria=(3, 100, 1e-9))
    except cv2.error:
        remedy = "tilt the board in different directions by 20 to 45 degrees, and fill the picture"
        raise CalibrationError(f"OpenCV finds no camera for these {len(points)} views: {remedy}") from None
    camera = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *d.ravel()[:5]])
    poses = list(zip(*poses, strict=True))
    residuals = [xy - cv2.projectPoints(p, *pose, K, d)[0][:, 0] for p, xy, pose in zip(points, pixels, poses, strict=True)]
    return camera, poses, residuals


def _shape(points, pixels, size, board, cost):
    """The points (n, 3) of a board that is clearly bent, z from its plane; or None. OpenCV frees each (Strobl, Hirzinger)."""
    many = [[np.float32(one) for one in each] for each in (points, pixels)]
    flags = cv2.CALIB_FIX_K3
    rms, *_, free = cv2.calibrateCameraRO(*many, size, board.pattern[0] - 1, None, None, flags=flags, criteria=(3, 60, 1e-9))
    if rms**2 * sum(map(len, points)) > 0.25 * cost:
        return None
    free = np.float64(free).reshape(-1, 3)
    plane = np.column_stack([free[:, :2], np.ones(len(free))])
    free[:, 2] -= plane @ np.linalg.lstsq(plane, free[:, 2], rcond=None)[0]
    return free


def _errors(points, residuals, camera, poses, lens, aspect):
    """Standard errors by name, covariance (9, 9), sigma: the larger of corners on their own, and views on their own."""
    free = np.array([True, not aspect, True, True, *(name in lens for name in LENS)])
    B = np.eye(9)[:, free]
    if aspect:
        B[1, 0] = 1 / aspect
    total, pull = np.zeros((B.shape[1],) * 2), []
    for p, e, pose in zip(points, residuals, poses, strict=True):
        J = cv2.projectPoints(p, *pose, _matrix(camera), camera[4:])[1]
        Q, _ = np.linalg.qr(J[:, :6])
        A = J[:, 6:15] @ B
        A = A - Q @ (Q.T @ A)  # the pose is free
        total += A.T @ A
        pull.append(A.T @ e.ravel())
    count = sum(e.size for e in residuals)
    sigma = np.sqrt(sum((e**2).sum() for e in residuals) / max(1, count - B.shape[1] - 6 * len(poses)))
    scale = np.sqrt(np.diag(total))
    inverse = np.linalg.inv(total / np.outer(scale, scale)) / np.outer(scale, scale)
    by_corners = sigma**2 * inverse
    n = len(poses)
    by_views = inverse @ (np.transpose(pull) @ pull) @ inverse * n / max(n - 1, 1)
    larger = np.sqrt(np.maximum(np.diag(by_views) / np.diag(by_corners), 1))
    V = B @ (by_corners * np.outer(larger, larger)) @ B.T
    used = B.any(axis=1)
    return {n: float(np.sqrt(V[k, k])) if used[k] else np.nan for k, n in enumerate(NAMES)}, V, float(sigma), larger[0]


def _warnings(found):
    (w, h), K, views = found.size, found.K, found.views
    if found.rms > 0.7 * max(1, w / 1280):
        yield f"rms {found.rms:.2g} px is more than corners err: a fisheye, a bent board, or did focus or zoom change?"
    ratio = K[0, 0] / K[1, 1]
    if abs(ratio - 1) > 0.0075:
        yield f"fx/fy = {ratio:.3f}: pixels are not square. Was the picture stretched, or is the board bent? Use a flat plate"
    if (np.abs(K[:2, 2] - [(w - 1) / 2, (h - 1) / 2]) > (0.15 * w, 0.15 * h)).any():
        yield f"the centre ({K[0, 2]:.0f}, {K[1, 2]:.0f}) is far from the middle: were the pictures cropped?"
    relative = max(found.stderr["fx"] / K[0, 0], found.stderr["fy"] / K[1, 1])
    if relative > 0.01:
        yield f"the focal length is known to {100 * relative:.1f} % only: tilt the board more, take more views"
    if not 0.04 < (away := float(np.median([np.linalg.norm(v.T_cam_board[:3, 3]) for v in views]))) < 15:
        yield f"the board seems {away:.3g} m away: is square in metres? K and distortion do not depend on it"
    if len(views) < 8:
        yield f"{len(views)} views are few: take 10 to 20"
    tilted = sum(v.tilt > np.deg2rad(15) for v in views)
    if tilted < 3:
        yield f"too few tilts: {tilted} of {len(views)} views by more than 15 degrees; only they tell focal length"
    x, y = (np.concatenate([v.corners for v in views]) * (8, 6) / found.size).astype(int).T
    if (share := len(set(zip(x, y, strict=True))) / 48) < 0.5:
        yield f"corners fill {100 * share:.0f} % of the picture only: hold the board into its corners, too"


def _picture(index, one):
    """(name or what is wrong, grey picture or None)."""
    if isinstance(one, str | Path):
        try:
            one, name = load_image(one, allow_grey=True), Path(one).name
        except ImageError:
            return Path(one).name, None
    else:
        name, one = getattr(one, "source", f"picture {index + 1}"), getattr(one, "image", one)
    return name, one if one.ndim == 2 else cv2.cvtColor(one, cv2.COLOR_RGB2GRAY)


def _with_bar(pictures, progress):
    if progress is False or (progress is None and len(pictures) < 8):
        return pictures
    from tqdm.auto import tqdm

    return tqdm(pictures, desc="finding corners", leave=False)


def _corners(grey, size, board, found, name):
    if grey is None:
        raise NotUsable(Reason.UNREADABLE, f"{name} is no picture, or damaged")
    if grey.shape[::-1] != size:
        raise NotUsable(Reason.OTHER_SIZE, "{}x{}, most are {}x{}".format(*grey.shape[::-1], *size))
    xy = find_checkerboard(grey, board.pattern).xy
    for other, _, before in found:
        if np.median(np.linalg.norm(xy - before, axis=1)) < np.hypot(*size) / 800:
            raise NotUsable(Reason.DUPLICATE, f"the board is where it was in {other}: move it between pictures")
    return xy


def _why_too_few(count, rejected, seen, board):
    reasons = Counter(str(one.reason) for one in rejected)
    message = f"{count} usable pictures of a {board}, at least {_FEWEST} are needed, 10 to 20 are good"
    if rejected:
        message += "; the others: " + ", ".join(f"{n} {reason}" for reason, n in reasons.most_common())
        message += f". The first: {rejected[0].detail}"
    seen.pop(None, None)
    if seen:
        message += ". They seem to show a board with {}x{} inner corners".format(*seen.most_common(1)[0][0])
    return message
