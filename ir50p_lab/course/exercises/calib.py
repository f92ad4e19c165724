"""Exercises of notebook 17: a pixel, a lens, a wrong square, a ball that is not on the plane."""

import numpy as np

from ir50p_lab.course.exercises import Choice, Exercise, Function, Number

NOTEBOOK = "17_camera_calibration"

# calib-1: a point through a camera without distortion.
_K = np.array([[700.0, 0, 320], [0, 690, 240], [0, 0, 1]])
_POINT = np.array([-0.08, 0.06, 0.5])  # m, camera coordinates; not the point of the notebook's own example


def _pixel(point, K):
    return (K @ point)[:2] / point[2]


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


_LENSES = [
    (0.3, -0.2, -0.25, 0.1, 0.002, -0.001),
    (-0.4, 0.25, 0.1, -0.05, -0.003, 0.004),
    (0.1, 0.4, -0.3, 0.2, 0.01, 0.02),
]

# calib-4: a ball's centre read as if it lay on the table.
_LENS_HEIGHT, _AWAY, _RADIUS = 0.6, 0.5, 0.03  # m; _AWAY: of the ball's centre from the foot of the lens


def _shift(height, away, radius):
    return radius * away / (height - radius)


EXERCISES = (
    Exercise(
        "calib-1",
        "the pixel (x, y) of the point (-0.08, 0.06, 0.50) m in camera coordinates, for fx, fy = 700, 690 and "
        "cx, cy = 320, 240, without distortion",
        Number(_pixel(_POINT, _K), unit="px", tolerance=0.05, because="a tenth of a pixel is what a finder resolves"),
        why="Divide by the depth first: that is all of perspective; K only scales and shifts.",
        slips={
            "Those are w x and w y: divide by the third entry, the depth.": (_K @ _POINT)[:2],
            "That counts from the optical axis: (0, 0) is the picture's corner.": _pixel(_POINT, _K) - _K[:2, 2],
            "Those are y and x: a pixel is (column, row) here.": _pixel(_POINT, _K)[::-1],
            "Mirrored: the virtual image plane is in front of the lens.": _K[:2, 2] - (_pixel(_POINT, _K) - _K[:2, 2]),
        },
    ),
    Exercise(
        "calib-2",
        "distorted (x, y) of the normalised point (x, y) by k1, k2, p1, p2: a function of (x, y, k1, k2, p1, p2)",
        Function(_distort, cases=_LENSES, tolerance=1e-9),
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
        "calib-3",
        "what of a calibration is wrong if square=0.025 was given for squares of 24 mm",
        Choice(
            "distances",
            {
                "distances": "only the distances of the board from the camera",
                "focal length": "the focal lengths fx and fy, by 4 %",
                "distortion": "the distortion coefficients",
                "everything": "everything, the board must be measured before the camera",
            },
        ),
        why="Pixels know angles, not metres. The table plane will be 4 % wrong, though: measure the board with care.",
        slips={
            "A board twice as large, twice as far away, gives the same picture, and fx.": "focal length",
            "Distortion acts on x = X/Z: the unit of X and Z has cancelled.": "distortion",
            "Try it: calibrate with another square, and compare K, rms and the poses.": "everything",
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
