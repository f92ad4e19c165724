"""Exercises of notebook 17: a lens, a ball that is not on the plane."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Function, Number

NOTEBOOK = "17_camera_calibration"


# calib-2: the lens, k1, k2, p1, p2.
def _distort(x, y, k1, k2, p1, p2):
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2**2
    return np.array(
        [x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y]
    )


def _with_r(x, y, k1, k2, p1, p2):
    r = np.hypot(x, y)
    radial = 1 + k1 * r + k2 * r**2
    return _distort(x, y, 0, 0, p1, p2) + np.array([x, y]) * (radial - 1)


# calib-4: a ball's centre read as if it lay on the table.
_LENS_HEIGHT, _AWAY, _RADIUS = 0.6, 0.5, 0.03  # m; _AWAY: of the ball's centre from the foot of the lens


def _shift(height, away, radius):
    return radius * away / (height - radius)


EXERCISES = (
    Exercise(
        "calib-2",
        "distorted (x, y) of the normalised point (x, y) by k1, k2, p1, p2: a function of (x, y, k1, k2, p1, p2)",
        Function(
            _distort,
            cases=[
                (0.3, -0.2, -0.25, 0.1, 0.002, -0.001),
                (-0.4, 0.25, 0.1, -0.05, -0.003, 0.004),
                (0.1, 0.4, -0.3, 0.2, 0.01, 0.02),
            ],
            tolerance=1e-9,
        ),
        why="These are the formulas the thesis names and leaves out; k3 r^6 would be the next radial term.",
        slips={
            "The radial terms hold r^2 and r^4, even powers: with r itself the lens would have a cusp.": _with_r,
            "p1 and p2 are swapped: p2 goes with r^2 + 2 x^2 in x.": (
                lambda x, y, k1, k2, p1, p2: _distort(x, y, k1, k2, p2, p1)
            ),
            "The radial part is right; the tangential one, of a tilted lens, is missing.": (
                lambda x, y, k1, k2, p1, p2: _distort(x, y, k1, k2, 0, 0)
            ),
            "That is how far the point moves: add where it was.": (
                lambda x, y, k1, k2, p1, p2: _distort(x, y, k1, k2, p1, p2) - np.array([x, y])
            ),
        },
    ),
    Exercise(
        "calib-4",
        "how far beyond its true place a ball of radius 30 mm is read if its centre is taken to lie on the table: lens "
        "0.6 m above the table, ball 0.5 m from the point below the lens",
        Number(
            _shift(_LENS_HEIGHT, _AWAY, _RADIUS), unit="m", tolerance=3e-4, because="a third of a millimetre will do"
        ),
        why="The shift grows with the distance from the camera's foot: no constant offset can repair it.",
        slips={
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
