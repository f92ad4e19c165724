"""What may be wrong with a calibration although it fits: a view that does not belong, and sentences of warning."""

import numpy as np

_FAR_OFF = 3  # times the median: if a view's residuals are larger, and by
_SCATTERS = 8  # times the scatter of the others larger than their mean, the view does not belong
_CONTRADICT = 3  # times: if views err by more than their corners do, they are not of one camera and one board
_SQUARE = 0.0075  # if fx/fy is farther from 1, or from what was prescribed, pixels of no sensor are meant
_ROUGH = 0.7  # px in a picture 1280 wide: good corners of the wrong model are off by more
_ASIDE = 0.15  # of the picture's width or height: if the centre is farther from the middle, the picture was cut
_VAGUE = 0.01  # of the focal length: if its standard error is larger, the views do not tell it
_NEAR, _FAR = 0.04, 15  # m; a board that seems nearer or farther was measured in another unit
_FEW = 8  # views
_TILTED = np.deg2rad(15)  # rad: if a board is tilted by less, it hardly tells the focal length
_ONE_AXIS = (
    0.3  # if directions of tilt scatter less across their main direction than this part along it, it is one axis
)
_EMPTY = 0.5  # of 8 x 6 cells of the picture: if fewer hold corners, the lens in the others is a guess


def odd_view(view_rms):
    """Index of the view whose corners fit no camera that fits the others, or None; view_rms (v,) px."""
    worst = int(np.argmax(view_rms))
    others = np.delete(view_rms, worst)
    far = max(_FAR_OFF * np.median(others), np.mean(others) + _SCATTERS * np.std(others))
    return worst if len(others) > 3 and view_rms[worst] > far else None


def contradiction(times):
    """A sentence if the standard error from views is so many times that from corners that the views contradict."""
    if times > _CONTRADICT:
        yield "the views contradict each other: two cameras, or was zoom, focus or the board changed?"


def prescribed_aspect(aspect, free):
    """A sentence if corners say another fx/fy than was prescribed; free: camera (9,) without it."""
    ratio = free[0] / free[1]
    if abs(ratio / aspect - 1) > _SQUARE:
        yield f"aspect = {aspect} was prescribed, but the corners say fx/fy = {ratio:.4f}: leave aspect=None"


def warnings_about(found):
    """What to mind about a Calibration, sentence by sentence."""
    (w, h), K, views = found.size, found.K, found.views
    if found.rms > _ROUGH * max(1, w / 1280):
        yield f"rms {found.rms:.2g} px is more than corners err: a fisheye, a bent board, or did focus or zoom change?"
    ratio = K[0, 0] / K[1, 1]
    if abs(ratio - 1) > _SQUARE:
        yield f"fx/fy = {ratio:.3f}: pixels are not square. Was the picture stretched, or is the board bent? Use a flat plate"
    if (np.abs(K[:2, 2] - [(w - 1) / 2, (h - 1) / 2]) > (_ASIDE * w, _ASIDE * h)).any():
        yield f"the centre ({K[0, 2]:.0f}, {K[1, 2]:.0f}) is far from the middle: were the pictures cropped?"
    relative = max(found.stderr["fx"] / K[0, 0], found.stderr["fy"] / K[1, 1])
    if relative > _VAGUE:
        yield f"the focal length is known to {100 * relative:.1f} % only: tilt the board more, take more views"
    away = float(np.median([np.linalg.norm(view.T_cam_board[:3, 3]) for view in views]))
    if not _NEAR < away < _FAR:
        yield f"the board seems {away:.3g} m away: is square in metres? K and distortion do not depend on it"
    if len(views) < _FEW:
        yield f"{len(views)} views are few: 10 to 20 make the standard errors themselves trustworthy"
    tilts = np.array([view.T_cam_board[:2, 2] for view in views if view.tilt > _TILTED])
    if len(tilts) < 3:
        yield f"too few tilts: {len(tilts)} of {len(views)} views by more than 15 degrees; only they tell focal length"
    else:
        along, across = np.linalg.svd(tilts / np.linalg.norm(tilts, axis=1, keepdims=True), compute_uv=False)
        if across < _ONE_AXIS * along:
            yield "all tilts are about one axis: tilt the board up or down as well as left or right"
    x, y = (np.concatenate([view.corners for view in views]) * (8, 6) / found.size).astype(int).T
    filled = len(set(zip(x, y, strict=True))) / 48
    if filled < _EMPTY:
        yield f"corners fill {100 * filled:.0f} % of the picture only: hold the board into its corners, too"
