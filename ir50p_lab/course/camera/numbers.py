"""Numbers of notebook 17: a ball that is not on the plane."""

from ir50p_lab.course.checking.number import Number

# calib-4: a ball's centre read as if it lay on the table.
_LENS_HEIGHT, _AWAY, _RADIUS = 0.6, 0.5, 0.03  # m; _AWAY: of the ball's centre from the foot of the lens


def _shift(height, away, radius):
    return radius * away / (height - radius)


NUMBERS = (
    Number(
        "calib-4",
        "17_camera_calibration",
        "how far beyond its true place a ball of radius 30 mm is read if its centre is taken to lie on the table: lens "
        "0.6 m above the table, ball 0.5 m from the point below the lens",
        _shift(_LENS_HEIGHT, _AWAY, _RADIUS),
        unit="m",
        tolerance=3e-4,
        because="a third of a millimetre will do",
        why="The shift grows with the distance from the camera's foot: no constant offset can repair it.",
        mistakes={
            "The radius is right only if the line of sight falls at 45 degrees: similar triangles.": _RADIUS,
            "That is the shift of the top of the ball: its centre is one radius above the table.": (
                _shift(_LENS_HEIGHT, _AWAY, 2 * _RADIUS)
            ),
            "Nearly: the line falls from the lens to the *ball*, over a height of 0.6 m less its radius.": (
                _RADIUS * _AWAY / _LENS_HEIGHT
            ),
            "Upside down: a flatter line of sight must miss by more.": _RADIUS * (_LENS_HEIGHT - _RADIUS) / _AWAY,
        },
    ),
)
