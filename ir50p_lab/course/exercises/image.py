"""Exercises of notebook 16: scales of hue, distance on the circle, a kernel, a radius in pixels, the lens law."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number
from ir50p_lab.vision import KERNEL_3_2, hue_distance, hue_in, image_distance

NOTEBOOK = "16_images_and_ball"

# image-1: a red a little towards magenta.
_HUE = 350.0  # degrees

# image-3: one white pixel in a black picture.
_WHITE = 255.0
_SMOOTH = _WHITE * float(KERNEL_3_2[2, 2])

# image-4: the ball of 4.5.3 before a webcam.
_F, _BALL, _AWAY = 700.0, 0.030, 0.80  # pixels, m, m

# image-5: a webcam's lens, an object close before it.
_LENS, _NEAR = 0.004, 0.05  # m


def _circle(a_deg, b_deg):
    return hue_distance(a_deg, b_deg)


def _line(a_deg, b_deg):
    return np.abs(np.subtract(a_deg, b_deg))


def _one_way(a_deg, b_deg):
    return np.subtract(a_deg, b_deg) % 360


def _signed(a_deg, b_deg):
    return (np.subtract(a_deg, b_deg) + 180) % 360 - 180


EXERCISES = (
    Exercise(
        "image-1",
        "the hue 350 degrees in OpenCV's scale for bytes",
        Number(hue_in("OpenCV", _HUE), tolerance=0.5, because="OpenCV's hues are whole numbers"),
        why="Both ends of that scale, 0 and 179, are red.",
        slips={
            "That spreads 360 degrees over a whole byte; OpenCV halves degrees.": float(hue_in("8 bit", _HUE)),
            "That is MATLAB's scale, which ends at 1.": float(hue_in("MATLAB", _HUE)),
            "Those are degrees: they do not fit into a byte.": _HUE,
            "Negative hues do not exist in a byte; halve the angle itself.": _HUE - 360,
        },
    ),
    Exercise(
        "image-2",
        "how far apart two hues are on the circle, 0 to 180 degrees, from a_deg and b_deg",
        Function(
            _circle,
            cases=[(350.0, 10.0), (10.0, 350.0), (90.0, 60.0), (359.5, 179.5), (0.0, 200.0)],
            unit="degrees",
            tolerance=1e-6,
        ),
        why="With it a range around red needs no second range at the other end.",
        slips={
            "On the circle 350 and 10 degrees are neighbours; a plain difference does not know that.": _line,
            "That goes round one way only: the shorter way is meant.": _one_way,
            "A distance has no sign.": _signed,
        },
    ),
    Exercise(
        "image-3",
        "what (3.2) makes of one white pixel, 255, in a black picture, at that pixel",
        Number(_SMOOTH, tolerance=0.6, because="grey levels are whole numbers"),
        why="Noise of single pixels falls to a tenth, an edge keeps its place.",
        slips={
            "That is the plain mean of 25 pixels; the kernel weighs the middle more.": _WHITE / 25,
            "The weights are divided by their sum.": _WHITE * 15,
            "That is what arrives at the corner of the 5 x 5 pixels.": _WHITE * 2 / 159,
            "25 is the number of weights, not their sum.": _WHITE * 15 / 25,
        },
    ),
    Exercise(
        "image-4",
        "the radius of a 30 mm ball (radius) at 0.80 m before a camera with f = 700 px",
        Number(_F * _BALL / _AWAY, unit="px", tolerance=0.1),
        why="So the radii to search for follow from the camera and the work area: they need no trial.",
        slips={
            "That is the diameter: the mistake of 4.5.1 again.": 2 * _F * _BALL / _AWAY,
            "That is for a ball at 1 m: divide by the distance.": _F * _BALL,
            "A ball further away looks smaller: divide by the distance.": _F * _AWAY * _BALL,
            "That mixes mm and m.": _F * _BALL / _AWAY * 1000,
        },
    ),
    Exercise(
        "image-5",
        "how far behind a lens with f = 4 mm the sharp picture of an object at 50 mm lies",
        Number(float(image_distance(_NEAR, _LENS)), unit="m", tolerance=2e-5, because="0.01 mm is enough here"),
        why="A third of a millimetre more than for a far object: that is all a focus ring moves.",
        slips={
            "1/beta = 1/f - 1/alpha: there is a minus when it is solved.": 1 / (1 / _LENS + 1 / _NEAR),
            "That is 1/beta.": 1 / _LENS - 1 / _NEAR,
            "That is for an object far away.": _LENS,
            "The law adds inverses, not distances.": _NEAR - _LENS,
        },
    ),
)
