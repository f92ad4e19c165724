"""hue_mask: which pixels have a colour."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of, text_of


def hue_of(rgb):
    """Return the hue (...,), rad, of colours (..., 3): an angle on the ring, 0 at red."""
    r, g, b = np.moveaxis(np.asarray(rgb, dtype=float), -1, 0)
    return np.arctan2(np.sqrt(3) * (g - b), 2 * r - g - b)


def saturation_of(rgb):
    """Return how far colours (..., 3) are from grey (...,): 0 to 1; black counts as grey."""
    most, least = np.max(rgb, axis=-1).astype(float), np.min(rgb, axis=-1)
    return (most - least) / np.maximum(most, 1e-9)


def hue_mask(rgb, hue, tolerance):
    """Return True (h, w) where the hue is within tolerance of `hue`, rad, and the pixel no grey    (3.1.3), (3.1)."""
    rgb = np.asarray(rgb, dtype=float)
    r, g, b = np.moveaxis(rgb, -1, 0)
    most = rgb.max(axis=-1)
    least = rgb.min(axis=-1)
    angle = np.arctan2(np.sqrt(3) * (g - b), 2 * r - g - b)
    apart = np.abs(angle - hue) % (2 * np.pi)
    near = np.minimum(apart, 2 * np.pi - apart) <= tolerance
    coloured = (most - least >= 0.2 * most) & (most > 0)
    return near & coloured


_ODD = np.array([(0, 0, 0), (255, 255, 255), (120, 119, 119), (20, 20, 20), (119, 119, 120), (200, 180, 182)])
_REDS = np.array([(60, 12, 14), (250, 40, 44), (250, 44, 40)])  # dark; a little on either side of the seam
_ASKED = ((0.0, 0.3), (2.1, 0.4), (3.1, 0.5), (-3.0, 0.5), (-1.5, 0.3), (-0.2, 0.4), (1.0, 1.2), (0.0, 0.0873))


def _pictures():
    rng, cases = np.random.default_rng(161), []
    for k, (hue, tolerance) in enumerate(_ASKED):
        pixels = np.concatenate([_REDS, rng.integers(0, 256, (400, 3))])
        pixels = pixels[[_is_clear(one, hue, tolerance) for one in pixels]]
        inside = hue_mask(pixels, hue, tolerance)
        chosen = np.concatenate([pixels[inside][:7], pixels[~inside][:5], _ODD])
        picture = rng.permutation(chosen).reshape((3, 6, 3) if k % 2 else (2, 9, 3))
        cases.append((picture.astype(np.uint8) if k % 4 < 2 else picture / 255, hue, tolerance))
    return cases


def _is_clear(pixel, hue, tolerance):
    """Tell whether neither rounding nor another reading of hue (six straight pieces) changes the answer at a pixel."""
    most, least = max(pixel), min(pixel)
    if most == least:
        return True
    apart = abs(np.angle(np.exp(1j * (hue_of(pixel) - hue))))
    return abs((most - least) / most - 0.2) > 0.03 and abs(apart - tolerance) > 0.035


_SAYS = sentences("hue_mask", __file__)


def _symptom(case, returned, expected):
    mask = np.asarray(returned).astype(bool)
    if mask.shape != expected.shape or (mask == expected).all():
        return ""
    row, column = np.argwhere(mask != expected)[0]
    pixel = case[0][row, column] * (1 if case[0].dtype == np.uint8 else 255)
    return _SAYS["lost" if expected[row, column] else "taken"].format(*pixel.round().astype(int), *case[1:])


TASK = task_of(hue_mask, cases=_pictures, symptom=_symptom, given=text_of(hue_of, saturation_of) + "\n\n\n")
