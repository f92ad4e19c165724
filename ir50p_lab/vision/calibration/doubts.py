"""What may be wrong with a calibration although it fits: a view that does not fit the others, and warnings."""

import numpy as np

_SQUARE = 0.0075  # if fx/fy is farther from 1, something is stretched: pixels of sensors are square to better than this
_TILTED = np.deg2rad(15)  # rad: if a board is tilted by less, it hardly tells the focal length


def odd_view(view_rms):
    """Return the index of the view whose corners fit no camera that fits the others, or None. view_rms: (v,) px."""
    worst = int(np.argmax(view_rms))
    others = np.delete(view_rms, worst)
    # A view is odd if it is both 3 times the median and 8 times the scatter over the mean of the others.
    far = max(3 * np.median(others), np.mean(others) + 8 * np.std(others))
    return worst if len(others) > 3 and view_rms[worst] > far else None


def warnings_about(found):
    """Yield the doubts about a Calibration, sentence by sentence.

    A webcam with square pixels and 10 to 20 good pictures stays within every limit.
    """
    K, views = found.K, found.views
    if found.rms > 0.7 * max(1, found.size[0] / 1280):
        yield f"rms {found.rms:.2g} px is more than corners err: a bent board, a ChArUco, or did focus or zoom change?"
    ratio = K[0, 0] / K[1, 1]
    if abs(ratio - 1) > _SQUARE:
        yield f"fx/fy = {ratio:.3f}: pixels are not square. Is the picture or the board stretched, or the board bent?"
    if (np.abs(K[:2, 2] / found.size - 0.5) > 0.15).any():
        yield f"the centre ({K[0, 2]:.0f}, {K[1, 2]:.0f}) is far from the middle: were the pictures cropped?"
    relative = max(found.stderr["fx"] / K[0, 0], found.stderr["fy"] / K[1, 1])
    if relative > 0.01:
        yield f"the focal length is known only to {100 * relative:.1f} %: tilt the board more, take more views"
    away = float(np.median([np.linalg.norm(view.T_cam_board[:3, 3]) for view in views]))
    if not 0.04 < away < 15:
        yield f"the board seems {away:.3g} m away: is square in metres? K and distortion do not depend on it"
    if len(views) < 8:
        yield f"{len(views)} views are few: 10 to 20 make the standard errors themselves trustworthy"
    tilts = np.array([view.T_cam_board[:2, 2] for view in views if view.tilt > _TILTED])
    if len(tilts) < 3:
        yield f"too few tilts: {len(tilts)} of {len(views)} views by more than 15 degrees; only they tell focal length"
    # If directions of tilt scatter less than 0.3 times as much one way as the other, they are all one direction.
    elif np.linalg.cond(tilts / np.linalg.norm(tilts, axis=1, keepdims=True)) > 1 / 0.3:
        yield "all tilts are about one axis: tilt the board up or down as well as left or right"
    x, y = (np.concatenate([view.corners for view in views]) * (8, 6) / found.size).astype(int).T
    filled = len(set(zip(x, y, strict=True))) / 48
    if filled < 0.5:
        yield f"corners fill only {100 * filled:.0f} % of the picture: hold the board in its corners, too"
