"""Exercises of notebook 16: the distance of two hues on the circle, a radius in pixels."""

from ir50p_lab.course.exercises import Exercise, Function, Number
from ir50p_lab.vision import hue_distance

NOTEBOOK = "16_images_and_ball"

# image-4: the ball of 4.5.3 before a webcam.
_F, _BALL, _AWAY = 700.0, 0.030, 0.80  # pixels, m, m


EXERCISES = (
    Exercise(
        "image-2",
        "how far apart two hues are on the circle, 0 to 180 degrees, from a_deg and b_deg",
        Function(
            hue_distance,
            cases=[(350.0, 10.0), (10.0, 350.0), (90.0, 60.0), (359.5, 179.5), (0.0, 200.0)],
            unit="degrees",
            tolerance=1e-6,
        ),
        why="With it a range around red needs no second range at the other end.",
        slips={
            "On the circle 350 and 10 degrees are neighbours; a plain difference does not know that.": (
                lambda a_deg, b_deg: abs(a_deg - b_deg)
            ),
            "That goes round one way only: the shorter way is meant.": lambda a_deg, b_deg: (a_deg - b_deg) % 360,
            "A distance has no sign.": lambda a_deg, b_deg: (a_deg - b_deg + 180) % 360 - 180,
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
)
