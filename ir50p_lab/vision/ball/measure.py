"""From a first guess to a measured ball, or the reason why there is none: edges, fit, and what speaks for a ball."""

from dataclasses import dataclass

import cv2
import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.jit import jit
from ir50p_lab.vision.ball.edge import cast, contrast_axis, directions, find_edges, slope_kernel
from ir50p_lab.vision.ball.evidence import NoBallError, hue_of, other_hue, other_paint, paint_of
from ir50p_lab.vision.ball.features import RAYS, look, median
from ir50p_lab.vision.ball.fit import Outline, fit_outline


def _smooth(r):
    """Pixels: of the derivative along a ray; large balls have soft edges, in focus or not."""
    return max(1.2, 0.025 * r)


_INNER, _OUTER = np.linspace(0.1, 0.85, 11), np.array([0.0, 0.04, 0.12, 0.22])  # rings in the disc and around it
_AREA = np.append(_INNER, 0.93) / (_INNER.sum() + 0.93)  # of the rings that the samples stand for
# Whatever else speaks for it, a ball shows an edge on this much of the circle, and this much of its disc has the
# colour: of an overexposed one, which is orange, hardly more than the rim
LEAST_SUPPORT, LEAST_FILL = 0.32, 0.25
_CLEARLY = 0.8  # of the least radius: the first look is that far off at most
# The outline of a ball leaves a circle by less than a part of the radius (an octagon has 0.023 of it) and of a pixel.
_MOST_BUMPS = 0.010, 0.45
_EDGE = 0.30  # least height of an edge, in units of the contrast between ball and surroundings


@dataclass(frozen=True)
class Measured:
    """A fitted outline and the evidence for it, shares of the full circle or disc 0..1.

    outline; centre (x, y) of the sphere, pixels. support: shows an edge on the outline; seen: lies in the picture.
    beyond (n,) bool: rays without an edge on which the ball's colour goes on outside. fill: of the disc towards the
    edges found that has the colour (or is a highlight).
    bumps: what the outline has of waves around a circle, three to eight of them, rms over the radius; oval: two waves
    (motion makes some).
    gaps: into how many pieces what is missing falls. ragged: rms distance of the edge points from the smooth outline,
    over the radius. step: median height of the edges, over the contrast of the disc and its surroundings.
    apart: of the colours in and out, in standard deviations. through: how much of the missing part looks like what
    surrounds the ball. paint: of `paint_of`. samples (RAYS, radii, channels): of `look`. edges (RAYS, 4): whether there
    is an edge on the outline, how far off it is (in units of what is usual), its height, and `beyond`.
    """

    outline: Outline
    centre: tuple
    support: float
    seen: float
    beyond: np.ndarray
    fill: float
    bumps: float
    oval: float
    apart: float
    through: float
    gaps: int
    ragged: float
    step: float
    paint: tuple
    samples: np.ndarray
    edges: np.ndarray


def measure(image, guess, view, colour, camera=None, least_radius=0.0):
    """Measure the ball at a guess (x, y, r); camera: Pinhole, whose lens may distort.

    least_radius: pixels.
    Returns: Measured. Raises NoBallError, which says why not.
    """
    outline, unit = _coarse(image, guess, view)
    if outline.r < max(3.0, _CLEARLY * least_radius):
        raise NoBallError(f"too small, radius {outline.r:.1f} pixels")
    return _fine(image, outline, unit, view, colour, camera, least_radius)


def _coarse(image, guess, view):
    """Outline around a guess that may be a third off, and the unit vectors (cos, sin) of the rays to look along."""
    x, y, r = guess
    unit = directions(min(max(8 * round(r / 4), 48), 96))
    for width in (0.4, 0.25):
        steps = int(min(max(r, 8), 18))
        relative = 1 + np.arange(-steps, steps + 1, dtype=np.float32) * np.float32(0.7 / steps)
        rays = cast(image, x, y, np.float32([r]), relative, unit)
        sigma = max(0.9, round(_smooth(r) * steps / (0.7 * r), 1))
        _, rho, height = _edges(rays, round(0.8 * steps), round(1.3 * steps), steps, width * steps, sigma)
        strong = height > _EDGE
        edges = x + rho[strong] * unit[0][strong], y + rho[strong] * unit[1][strong]
        # the guess may be too large or too small for edges that agree well
        found = fit_outline(*edges, view, (x, y, r)) or fit_outline(*edges, view, (x, y, float(median(rho[strong]))))
        if not found:
            raise NoBallError("its edges lie on no circle")
        moved = np.hypot(found.x - x, found.y - y) + abs(found.r - r)
        x, y, r = found.circle
        if moved < 0.06 * r:
            break
    return found, unit


def _edges(rays, inner, outer, expected, width, sigma):
    """(contrast of `contrast_axis`, distances and heights of the edges along the rays of `cast`)."""
    rho, rgb, within = rays
    contrast = contrast_axis(rgb, within, inner, outer)
    if contrast[2] == 0:
        raise NoBallError("it looks like its surroundings")
    at, height = find_edges(rho, rgb, within, contrast[0], slope_kernel(sigma), expected, width)
    if (height > _EDGE).sum() < 8:
        raise NoBallError("no edge around it")
    return contrast, at, height


def _fine(image, outline, unit, view, colour, camera, least_radius):
    """Look again, finely, along the outline found: the last digits, and the evidence."""
    x, y, r = outline.circle
    half = max(4.5, 0.16 * r)  # pixels searched on either side
    pace = max(0.5, half / 14)
    steps = int(np.ceil(half / pace))
    relative = 1 + np.arange(-steps, steps + 1, dtype=np.float32) * np.float32(pace / r)
    rays = cast(image, x, y, outline.radii(*unit), relative, unit)
    clear, sigma = max(2, steps // 3), max(1.2, round(_smooth(r) / pace, 1))
    contrast, rho, height = _edges(rays, steps - clear + 1, steps + clear, steps, 0.6 * steps, sigma)
    weights, middle, apart = contrast
    strong = height > _EDGE
    ex, ey = x + rho * unit[0], y + rho * unit[1]
    outline = fit_outline(ex[strong], ey[strong], view, (x, y, r), noise=0.2)
    if outline is None:
        raise NoBallError("its edges lie on no circle")
    off = outline.distances(ex, ey)
    on = strong & (np.abs(off) < max(1.2, 0.05 * outline.r))
    if on.mean() < LEAST_SUPPORT:
        raise NoBallError(f"an edge on {on.mean():.0%} of the circle only")
    if outline.r < least_radius:
        raise NoBallError(f"too small, radius {outline.r:.1f} pixels", outline.circle)
    chosen = np.arange(RAYS) * len(on) // RAYS
    samples = look(image, outline, weights, middle, colour)
    # along rays that show an edge: where there is none something in front may show its own hue
    if why := other_hue(hue_of(samples[on[chosen], :6])):
        raise NoBallError(why, outline.circle)
    seen = rays[2][:, steps]
    inside, outside, rgb, hsv = _colours(image, outline, colour, unit)
    fill = float((inside[on] @ _AREA).mean())
    if fill < LEAST_FILL:
        raise NoBallError(f"hollow, or another colour: {fill:.0%} of the disc have the colour")
    paint = paint_of(hsv[inside], colour.centre, colour.swaps)
    bumps, oval, ragged = _waves(off[on], unit[0][on], unit[1][on], outline.r)
    if why := other_paint(paint, colour) or _roughness(bumps, ragged, outline.r):
        raise NoBallError(why, outline.circle)
    missing = ~on & seen
    outside &= rgb[:, 12:] @ weights > middle + 0.05
    beyond = missing & inside[:, -1] & outside[:, 0] & outside[:, 1]
    return Measured(
        outline=outline,
        centre=_through_the_lens(ex[on], ey[on], outline, view, camera),
        support=float(on.mean()),
        seen=float(seen.mean()),
        beyond=beyond,
        fill=fill,
        bumps=bumps,
        oval=oval,
        apart=apart,
        through=_shown_through(rgb, on, missing & ~beyond, inside),
        gaps=_gaps(missing),
        ragged=ragged,
        step=float(median(height[on])),
        paint=paint,
        samples=samples,
        edges=_along(on, off / (0.3 + 0.01 * outline.r), height, beyond)[chosen],
    )


def _roughness(bumps, ragged, r):
    """Why an outline is not round; "" if it may be."""
    rough = max(bumps, 0.6 * np.hypot(bumps, ragged))  # noise alone makes edges scatter
    if rough * r <= _MOST_BUMPS[0] * r + _MOST_BUMPS[1]:
        return ""
    return f"not round: its outline leaves a circle by {rough:.1%} of the radius"


def _along(on, off, height, beyond):
    """Edges for the classifier, (n, 4) float32."""
    off, height = np.minimum(np.maximum(off, -4), 4), np.minimum(np.maximum(height, 0), 2)
    return np.array([on, off * on, height, beyond], np.float32).T


def _through_the_lens(x, y, outline, view, camera):
    """The projected centre (x, y): fitted to the outline as it would be without distortion, and distorted again."""
    if camera is None or not np.any(camera.distortion):
        return outline.x, outline.y
    try:
        straight = camera.to_pixels(camera.undistort_points(np.column_stack([x, y])))
        middle = camera.to_pixels(camera.undistort_points(np.array([outline.x, outline.y])))
    except InputError:  # a ball beyond what the lens can show
        return outline.x, outline.y
    fit = fit_outline(*straight.T, view, (*middle, outline.r), noise=0.2)
    if fit is None:
        return outline.x, outline.y
    return tuple(map(float, camera.to_pixels(camera.distort(camera.to_normalised(np.array([fit.x, fit.y]))))))


@jit()
def _waves(off, cos, sin, r):
    """rms of the waves 3 to 8 in the distances (n,) around the circle, noise taken off, and of wave 2; over r."""
    n, turn = len(off), cos + 1j * sin
    A = np.empty((14, n))
    power = turn * turn
    for k in range(7):
        A[2 * k], A[2 * k + 1] = power.real, power.imag
        power = power * turn
    size = np.linalg.solve(A @ A.T + 0.04 * n * np.eye(14), A @ off)  # an arc cannot tell all waves apart
    oval = size[:2] @ A[:2]
    bumps = size[2:] @ A[2:]
    left = np.mean((off - oval - bumps) ** 2)
    waving = max(np.mean(bumps**2) - left * 12 / n, 0.0)
    return np.sqrt(waving) / r, np.sqrt(np.mean(oval**2)) / r, np.sqrt(left) / r


@jit()
def _gaps(missing):
    """Number of runs of at least two rays in a circular array of bool (n,)."""
    here = missing & np.roll(missing, 1)
    return np.sum(here & ~np.roll(here, 1))


def _shown_through(rgb, on, missing, inside):
    """Share of the missing part of the disc that looks as what surrounds the rest of it: nothing hides it there."""
    if missing.sum() < 4:
        return 0.0
    around = rgb[on, 12:].reshape(-1, 3).astype(np.float32)
    middle = np.array([median(channel) for channel in around.T])
    if np.abs(around - middle).mean() > 12:  # of surroundings that vary nothing can be said
        return 0.0
    gone = rgb[missing, :12][~inside[missing]].astype(np.float32)
    return float((np.abs(gone - middle) < 16).all(axis=1).mean()) if len(gone) >= 8 else 0.0


def _colours(image, outline, colour, unit):
    """Which samples have the ball's colour: inside (n, 12), highlights included, and just outside (n, 4); their rgb."""
    r = outline.r
    rim = 1.5 / r
    inner = np.append(_INNER, max(0.5, 0.97 - rim))
    relative = np.concatenate([inner, 1.03 + rim + _OUTER]).astype(np.float32)
    _, rgb, within = cast(image, outline.x, outline.y, outline.radii(*unit), relative, unit)
    hsv = colour.hsv_of(rgb)
    alike = (cv2.inRange(hsv, *colour.bounds()) > 0) & within
    bright = (hsv[:, :12, 2] > 200) & (hsv[:, :12, 1] < 255 * colour.saturation)
    inside = (colour.loose_mask(hsv[:, :12]) > 0) & within[:, :12]
    if (bright @ inner).mean() < 0.35 * inner.sum():  # a highlight is a part of the disc
        inside = inside | bright
    return inside, alike[:, 12:], rgb, hsv[:, :12]
