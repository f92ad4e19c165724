"""Numbers of notebook 16: a radius in pixels."""

from ir50p_lab.course.checking.number import Number

# image-4: the ball of 4.5.3 before a webcam.
_F, _BALL, _AWAY = 700.0, 0.030, 0.80  # pixels, m, m


NUMBERS = (
    Number(
        "image-4",
        "16_images_and_ball",
        "the radius of a 30 mm ball (radius) at 0.80 m before a camera with f = 700 px",
        _F * _BALL / _AWAY,
        unit="px",
        tolerance=0.1,
        why="So the radii to search for follow from the camera and the work area: they need no trial.",
        mistakes={
            "That is the diameter: the mistake of 4.5.1 again.": 2 * _F * _BALL / _AWAY,
            "That is for a ball at 1 m: divide by the distance.": _F * _BALL,
            "A ball further away looks smaller: divide by the distance.": _F * _AWAY * _BALL,
            "That mixes mm and m.": _F * _BALL / _AWAY * 1000,
        },
    ),
)
