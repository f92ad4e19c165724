"""From points of the outline to the projected centre of the sphere: one linear fit, from a circle to a cone of rays.

The outline of a sphere is where the rays that touch it meet the picture. These rays form a circular cone: with unit
vectors u of the rays, u . n = 1, where n points to the centre. In pixels X, Y from the principal point and
kappa = 1/f^2 this reads, after division,

    L = a X + b Y + c,    L = 2 rho^2 / (sqrt(1 + kappa rho^2) + 1),    rho^2 = X^2 + Y^2,

linear in a, b, c. For kappa = 0 (a camera far away) L = rho^2: the algebraic circle. The centre of the ellipse is not
the picture of the centre: that lies nearer to the principal point, by about kappa d r^2 at distance d from it.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from ir50p_lab.jit import jit

NOMINAL_F = 0.9  # focal length over the longer side of the picture, 58 degrees across: assumed where no camera is given
KAPPA_SPREAD = 0.45  # standard deviation of kappa over the assumed one: webcams and phones see 40 to 75 degrees
_LARGE_ENOUGH = 12.0  # pixels: smaller balls do not tell perspective


@dataclass(frozen=True)
class PixelGeometry:
    """Where pixels point: principal point (cx, cy), kappa = 1/f^2 (1/pixels^2), ratio fx/fy; sure: really known."""

    cx: float
    cy: float
    kappa: float
    aspect: float = 1.0
    sure: bool = False


@dataclass(frozen=True)
class Outline:
    """A fitted outline.

    x, y: picture of the sphere's centre, pixels; r: radius of the circle that covers as much of the picture, pixels;
    cone: (a, b, c); kappa: that was used; view.
    """

    x: float
    y: float
    r: float
    cone: tuple
    kappa: float
    view: PixelGeometry

    @property
    def circle(self):
        """(x, y, r)."""
        return self.x, self.y, self.r

    def distances(self, x, y):
        """Signed distance of pixels (n,) to the outline, pixels, outwards positive (first order)."""
        v = self.view
        return _distances(_floats(x), _floats(y), *self.cone, v.cx, v.cy, v.aspect, self.kappa)

    def radii(self, cos, sin):
        """Distance from (x, y) to the outline along unit directions (cos, sin) (n,), pixels."""
        v = self.view
        return _radii(cos, sin, self.x, self.y, self.r, *self.cone, v.cx, v.cy, v.aspect, self.kappa)


def view_of(shape, camera=None):
    """PixelGeometry of a picture: of the Pinhole `camera`, or of an assumed one with its axis in the middle."""
    height, width = shape[:2]
    if camera is not None:
        return PixelGeometry(camera.cx, camera.cy, camera.fx**-2, camera.fx / camera.fy, True)
    return PixelGeometry((width - 1) / 2, (height - 1) / 2, (NOMINAL_F * max(width, height)) ** -2)


def fit_outline(x, y, view, start, *, noise=0.25, rounds=6):
    """Robust fit to outline points (n,), pixels, from a first guess `start` (x, y, r) that may be a few per cent off.

    Points count fully near the curve and not at all beyond a limit that shrinks from round to round. Without a
    known camera kappa is chosen between 0 and 2.2 times the assumed one, by how well it fits and how likely it is.
    Returns: Outline, or None where no curve fits.
    """
    spread = 0.0 if view.sure else KAPPA_SPREAD
    view_numbers = (view.cx, view.cy, view.aspect, view.kappa, spread)
    found, cone, kappa = _robust(_floats(x), _floats(y), *view_numbers, *map(float, start), noise, rounds)
    return Outline(*found, cone, kappa, view) if found[2] > 0 else None


def _floats(values):
    return np.ascontiguousarray(values, dtype=np.float64)


@jit()
def _lift(square, kappa):
    return 2 * square / (np.sqrt(1 + kappa * square) + 1)


@jit()
def _distances(x, y, a, b, c, cx, cy, aspect, kappa):
    X, Y = x - cx, (y - cy) * aspect
    square = X * X + Y * Y
    root = np.sqrt(1 + kappa * square)
    slope = np.maximum(np.hypot(2 * X / root - a, 2 * Y / root - b), 1e-9)
    return (_lift(square, kappa) - a * X - b * Y - c) / slope


@jit()
def _radii(cos, sin, x, y, r, a, b, c, cx, cy, aspect, kappa):
    t = np.full(len(cos), r)
    for _ in range(3):  # Newton's method
        t -= _distances(x + t * cos, y + t * sin, a, b, c, cx, cy, aspect, kappa)
    return t


@jit()
def _solve(x, y, w, cx, cy, aspect, kappa):
    """Weighted linear least squares for the cone: (x, y, r), (a, b, c); r = 0 where it is degenerate."""
    nothing = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    X, Y, total = x - cx, (y - cy) * aspect, np.sum(w)
    L = _lift(X * X + Y * Y, kappa)
    mx, my, ml = np.sum(w * X) / total, np.sum(w * Y) / total, np.sum(w * L) / total
    X, Y, L = X - mx, Y - my, L - ml
    xx, xy, yy = np.sum(w * X * X), np.sum(w * X * Y), np.sum(w * Y * Y)
    xl, yl = np.sum(w * X * L), np.sum(w * Y * L)
    det = xx * yy - xy * xy
    if not det > 1e-9 * (xx + yy) ** 2:
        return nothing
    a, b = (xl * yy - yl * xy) / det, (yl * xx - xl * xy) / det
    c = ml - a * mx - b * my
    bottom = 1 + kappa * c / 2
    square = (a * a + b * b) / 4 + c + kappa * c * c / 4  # tan(alpha)^2 / kappa: the radius on the axis, squared
    if not (bottom > 0 and square > 0):
        return nothing
    # away from the axis the picture of the same cone is larger
    away = (a * a + b * b) / 4 / bottom**2
    narrow = (1 + kappa * square) / (1 + kappa * away) - kappa * square
    if not narrow > 0:
        return nothing
    return (cx + a / 2 / bottom, cy + b / 2 / bottom / aspect, sqrt(square) * narrow**-0.75), (a, b, c)


@jit()
def fit_circle(x, y):
    """The algebraic circle (x, y, r) through points x, y (n,): a camera far away; r = 0 on a line."""
    return _solve(x, y, np.ones(len(x)), 0.0, 0.0, 1.0, 0.0)[0]


@jit()
def _robust(x, y, cx, cy, aspect, nominal, spread, x0, y0, r0, noise, rounds):
    """Iterated reweighting: ((x, y, r), (a, b, c), kappa); r = 0 where no curve fits."""
    off = np.hypot(x - x0, y - y0) - r0
    found, cone, kappa = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), nominal
    scale = max(0.12 * r0, 2.0)
    for k in range(rounds):
        w = np.maximum(1 - (off / scale) ** 2, 0.0) ** 2
        if np.sum(w > 0) < 8:
            return (0.0, 0.0, 0.0), cone, kappa
        if k >= rounds - 2 and spread > 0 and r0 > _LARGE_ENOUGH:
            kappa = _likely_kappa(x, y, w, cx, cy, aspect, nominal, spread, noise)
        found, cone = _solve(x, y, w, cx, cy, aspect, kappa)
        if not 0.4 * r0 < found[2] < 2.5 * r0:
            return (0.0, 0.0, 0.0), cone, kappa
        off = _distances(x, y, *cone, cx, cy, aspect, kappa)
        scale = max(min(scale * 0.6, 4 * 1.4826 * np.median(np.abs(off[w > 0]))), 4 * noise)
    return found, cone, kappa


@jit()
def _likely_kappa(x, y, w, cx, cy, aspect, nominal, spread, noise):
    """kappa in 0..2.2 times the assumed one: a parabola through the misfit at three values, and the prior's."""
    misfit = np.empty(3)
    for k in range(3):
        found, cone = _solve(x, y, w, cx, cy, aspect, k * nominal)
        if found[2] == 0:
            return nominal
        misfit[k] = np.sum(w * _distances(x, y, *cone, cx, cy, aspect, k * nominal) ** 2)
    # neighbouring points share their errors: every fourth counts as independent
    m = misfit / (4 * max(misfit.min() / w.sum(), noise**2))
    curve, slope = (m[0] - 2 * m[1] + m[2]) / 2, (m[2] - m[0]) / 2  # misfit(1 + e) = m1 + slope e + curve e^2
    e = -slope / (2 * max(curve, 0.0) + 2 / spread**2)
    return nominal * min(max(1 + e, 0.0), 2.2)
