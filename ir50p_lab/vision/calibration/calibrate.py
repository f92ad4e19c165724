"""Calibrate a camera with pictures of a checkerboard: focal lengths, centre, lens distortion, and how sure they are."""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from ir50p_lab.errors import CalibrationError, ImageError, InputError
from ir50p_lab.vision.arguments import picture_size, point_list
from ir50p_lab.vision.board_pose import transform
from ir50p_lab.vision.calibration import doubts
from ir50p_lab.vision.calibration.board import Checkerboard
from ir50p_lab.vision.calibration.calibration_result import LENS, NAMES, Calibration, View
from ir50p_lab.vision.calibration.corners import find_checkerboard
from ir50p_lab.vision.calibration.fit import errors, fit, fit_bent, fit_lens, halves_agree, heights
from ir50p_lab.vision.calibration.reject_reasons import NotUsable, Reason, Rejected
from ir50p_lab.vision.image import list_images, load_image, to_grey

_FEWEST = 3  # views: with fewer there is no calibration
_BAR_FROM = 8  # pictures: from here on a bar is shown
_SAME = 1 / 800  # share of the picture's diagonal: if the board moved less, it is the same view again
# If the error of fx by the scatter of views is so many times that by the scatter of corners, views contradict each
# other: they are not of one camera and one board.
_CONTRADICT = 3
_USUAL = ("k1", "k2", "p1", "p2")  # k3 must be asked for: outside the outermost corner it may become huge


def calibrate(images, pattern=(9, 6), square=0.025, *, lens=_USUAL, progress=None):
    """Calibrate a camera from pictures of a checkerboard.

    OpenCV finds and refines the corners; pictures that are of no use are left out, each with a Reason; the camera is
    the least-squares fit of `cv2.calibrateCamera`; its standard errors are the larger of two kinds (`fit.errors`).
    If residuals become much smaller when every corner of the board may move, the board is bent: a warning says so, and
    its shape is estimated with the camera. A bend of 0.3 to 0.5 mm over 200 mm may pass for flat (12 views, corners to
    0.1 px): fx was then off by 0.3 %, at most 1.2 %, which is two of its standard errors, at most five. A plate of
    glass has no bend. The inner corners of a ChArUco board pass for those of a checkerboard, but its markers displace
    them by half a pixel: take a plain one.

    Args:
        images: list of pictures (h, w, 3) uint8 RGB, grey ones (h, w), Frames or paths, mixed; or a folder.
        pattern: (columns, rows) of inner corners; square: side of a square, m. A wrong square only scales the distances
        of the board: K and distortion come out the same.
        lens: coefficients to estimate, out of k1, k2, p1, p2, k3; () for none.
        progress: True or False to show a bar or not; None: if there are 8 pictures or more.

    Returns: Calibration.
    Raises CalibrationError if fewer than 3 pictures are of use (the message says why), or they determine no camera;
    InputError for arguments that make no sense; ImageError if `images` is an empty or missing folder.
    """
    from tqdm.auto import tqdm

    board, lens = Checkerboard(pattern, square), _coefficients(lens)
    pictures = _read(images)
    sizes = Counter(grey.shape[::-1] for _, grey in pictures if not isinstance(grey, ImageError))
    size = max(sizes, key=sizes.get, default=None)
    found, rejected, seen = [], [], Counter()
    bar = len(pictures) >= _BAR_FROM if progress is None else progress
    for index, (name, grey) in enumerate(tqdm(pictures, desc="finding corners", leave=False, disable=not bar)):
        try:
            found.append((name, index, _corners(grey, size, board, found)))
        except NotUsable as why:
            rejected.append(Rejected(name, index, why.reason, why.detail))
            seen[why.seen] += 1
    if len(found) < _FEWEST:
        raise CalibrationError(_why_too_few(len(found), rejected, seen, board))
    return _calibrate(found, [board.points] * len(found), size, lens, rejected, board)


def calibrate_corners(object_points, image_points, size, *, lens=_USUAL):
    """Calibrate a camera from corners that were found elsewhere, on a flat board.

    Args:
        object_points: for each view the points on the board (n, 3) m, z = 0; or one array for all of them.
        image_points: for each view the pixels (n, 2), or (n, 1, 2) as in OpenCV.
        size: (width, height) of the picture, px. lens: as for `calibrate`.

    Returns: Calibration. Raises CalibrationError as `calibrate` does, InputError for shapes that do not fit, or NaN.
    """
    lens, size = _coefficients(lens), picture_size(size)
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
    found = [(f"view {k + 1}", k, xy) for k, xy in enumerate(pixels)]
    return _calibrate(found, points, size, lens, [], None)


def _calibrate(found, points, size, lens, rejected, board):
    """Calibration from (name, index, corners) of each view; board: Checkerboard that may be bent, or None."""
    fitted, doubt = fit_lens(points, [xy for *_, xy in found], size, lens)
    for _ in range(0 if doubt else len(found) // 4):
        odd = doubts.odd_view(fitted.view_rms)
        if odd is None:
            break
        (name, index, _), rms = found.pop(odd), fitted.view_rms
        detail = f"its corners are {rms[odd]:.2g} px off the model, those of the others {np.median(rms):.2g} px"
        rejected.append(Rejected(name, index, Reason.OUTLIER, detail))
        points = [*points[:odd], *points[odd + 1 :]]
        fitted = fit(points, [xy for *_, xy in found], size, lens, fitted.K)
    pixels, said = [xy for *_, xy in found], []
    if board is not None and not doubt:
        freed = fit_bent(fitted, pixels, size, lens, board.pattern[0])
        if freed.bent and halves_agree(pixels, fitted, size, lens, board.pattern[0]):
            fitted = freed
    if fitted.bent:
        bend = 1000 * np.ptp(heights(fitted.points[0]))
        said.append(
            f"the board is bent by {bend:.1f} mm: its shape was estimated, too, and the errors may be two to three "
            "times as large as given. Glue it to a plate and repeat"
        )
    covariance, sigma, contradiction = errors(fitted, lens)
    if contradiction > _CONTRADICT:
        said.append("the views contradict each other: two cameras, or was the zoom, the focus or the board changed?")
    parts = zip(found, fitted.points, fitted.residuals, fitted.poses, strict=True)
    views = tuple(
        View(name=name, index=index, points=p, corners=xy, residuals=e, T_cam_board=transform(*pose))
        for (name, index, xy), p, e, pose in parts
    )
    deviations = np.sqrt(np.diag(covariance))
    result = Calibration(
        K=fitted.K,
        distortion=fitted.camera[4:],
        rms=float(np.sqrt((np.concatenate(fitted.residuals) ** 2).sum(axis=1).mean())),
        stderr={name: float(one) if one > 0 else np.nan for name, one in zip(NAMES, deviations, strict=True)},
        covariance=covariance,
        views=views,
        rejected=tuple(sorted(rejected, key=lambda one: one.index)),
        size=size,
        board=board,
        model=lens,
        sigma=sigma,
    )
    # of a lens outside the model the other doubts would name causes that are none
    return replace(result, warnings=(doubt,) if doubt else (*said, *doubts.warnings_about(result)))


def _coefficients(lens):
    """The coefficients to estimate, checked, in the order of OpenCV. Raises InputError."""
    names = [lens] if isinstance(lens, str) or not np.iterable(lens) else list(lens)
    if any(name not in LENS for name in names) or ("p1" in names) != ("p2" in names):
        raise InputError(f"lens = {lens!r}: give coefficients out of {LENS}, p1 and p2 together")
    return tuple(name for name in LENS if name in names)


def _read(images):
    """[(name, grey picture (h, w) or the ImageError that says why there is none)]. Raises InputError, ImageError."""
    if isinstance(images, str | Path):
        images = list_images(images)
    if not np.iterable(images) or (isinstance(images, np.ndarray) and images.ndim < 4):
        raise InputError("images: give a list of pictures or paths, or a folder; one picture is not enough")
    pictures = [_picture(index, one) for index, one in enumerate(images)]
    if not pictures:
        raise InputError("no pictures were given: take 10 to 20 of the board, in different places and tilts")
    return pictures


def _picture(index, one):
    if isinstance(one, str | Path):
        try:
            return Path(one).name, to_grey(load_image(one, allow_grey=True))
        except ImageError as error:
            return Path(one).name, error
    name, array = f"picture {index + 1}", np.asarray(getattr(one, "image", one))
    if array.dtype != np.uint8 or not array.size or array.shape[2:] not in ((), (3,), (4,)):
        return name, ImageError(f"{array.dtype} array of shape {array.shape}: give uint8 of shape (h, w, 3) or (h, w)")
    return name, array if array.ndim == 2 else to_grey(np.ascontiguousarray(array[..., :3]))


def _corners(grey, size, board, found):
    """Corners (n, 2) px in a picture, which must have the size of most. Raises NotUsable."""
    if isinstance(grey, ImageError):
        raise NotUsable(Reason.UNREADABLE, str(grey))
    if grey.shape[::-1] != size:
        sizes = "{}x{}, most are {}x{}".format(*grey.shape[::-1], *size)
        raise NotUsable(Reason.OTHER_SIZE, f"{sizes}: another size, or upright in place of across, is another camera")
    xy = find_checkerboard(grey, board.pattern)
    for other, _, before in found:
        moved = np.median(np.linalg.norm(xy - before, axis=1))
        if moved < _SAME * np.hypot(*size):
            detail = f"the board is where it was in {other}, {moved:.2f} px away: move it between pictures"
            raise NotUsable(Reason.DUPLICATE, detail)
    return xy


def _why_too_few(count, rejected, seen, board):
    """The message if too few pictures are usable; seen: how often a board of other (columns, rows) was found."""
    reasons = Counter(str(one.reason) for one in rejected)
    message = f"{count} usable pictures of a {board}, at least {_FEWEST} are needed, 10 to 20 are good"
    if rejected:
        message += "; the others: " + ", ".join(f"{n} {reason}" for reason, n in reasons.most_common())
    seen.pop(None, None)
    likely, often = seen.most_common(1)[0] if seen else (None, 0)
    if often and (reasons[Reason.WRONG_BOARD] or often >= _FEWEST):
        message += f". They seem to show a board with {likely[0]}x{likely[1]} inner corners: pattern={likely}"
    elif rejected:
        message += f". The first: {rejected[0].name}: {rejected[0].detail}"
    return message
