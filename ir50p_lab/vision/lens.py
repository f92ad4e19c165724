"""The thin lens (3.4): where the picture is sharp, and how wide a point is blurred elsewhere."""

import numpy as np

from ir50p_lab.errors import InputError


def image_distance(alpha, f):
    """beta of 1/alpha + 1/beta = 1/f    (3.4); alpha: distance of the object, f: focal length, both m.

    Negative for an object inside the focal length (a magnifying glass: no picture behind the lens), infinite at it.
    Raises InputError unless alpha and f are positive.
    """
    alpha, f = np.asarray(alpha, dtype=float), float(f)
    if not (alpha > 0).all() or not f > 0:
        raise InputError("alpha and f are distances in m: give positive numbers")
    with np.errstate(divide="ignore"):
        return alpha * f / (alpha - f)


def blur_diameter(alpha, focused_at, f, aperture):
    """Diameter, m on the sensor, of the disc that a point at `alpha` makes when the lens is focused at `focused_at`.

    The sensor stands at beta0 = image_distance(focused_at); the rays through an opening of diameter `aperture` meet at
    beta, so on the sensor they fill a disc of aperture |beta0 - beta| / beta. All in m, f the focal length; alpha one
    distance or an array of them. Raises InputError unless alpha and focused_at lie beyond f, and aperture > 0.
    """
    beta, beta0 = image_distance(alpha, f), image_distance(focused_at, f)
    if not (np.asarray(alpha) > f).all() or not focused_at > f or not aperture > 0:
        raise InputError("object and focus lie beyond the focal length, and the aperture is positive; all in m")
    return aperture * np.abs(beta0 - beta) / beta


def rays_on_sensor(alpha, focused_at, f, aperture, n=9):
    """Heights (n,) m at which n rays from a point on the axis meet the sensor: traced through the lens.

    A ray that passes the lens at height h leaves it with its slope changed by -h/f. alpha, focused_at, f and aperture
    as of `blur_diameter`.
    """
    h = np.linspace(-aperture / 2, aperture / 2, n)
    slope = h / alpha - h / f
    return h + slope * image_distance(focused_at, f)
