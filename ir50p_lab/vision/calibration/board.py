"""The boards with which a camera is calibrated: what is printed on them, in metres."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import CalibrationError
from ir50p_lab.inputs import number


@dataclass(frozen=True)
class Checkerboard:
    """A checkerboard with pattern = (columns, rows) inner corners and squares of `square` m.

    The board's frame has its origin in the first inner corner, x along the columns, y along the rows, z into the board
    (away from a camera that sees it upright). If columns + rows is odd, the first corner is the one whose outer
    square is dark, as in a 9x6 board, so that the frame is the same in every picture. Otherwise a board looks the same
    after half a turn, and the frame is the one nearer to the top left of the picture.

    A wrong square size changes nothing but the scale of the distances: K and the distortion stay the same.
    Raises CalibrationError for a pattern below 3x3, InputError for a size that is not positive.
    """

    pattern: tuple = (9, 6)
    square: float = 0.025

    def __post_init__(self):
        object.__setattr__(self, "pattern", check_pattern(self.pattern))
        object.__setattr__(self, "square", number("square", self.square, "> 0", unit="m", hint="a positive length"))

    @property
    def points(self):
        """The inner corners, (columns * rows, 3) m, row by row."""
        columns, rows = self.pattern
        grid = np.mgrid[0:columns, 0:rows].T.reshape(-1, 2) * self.square
        return np.column_stack([grid, np.zeros(len(grid))])

    def __str__(self):
        return f"checkerboard with {self.pattern[0]}x{self.pattern[1]} inner corners, {1000 * self.square:g} mm squares"


def check_pattern(pattern):
    """Return (columns, rows) as ints. Raises CalibrationError for what cannot be a board."""
    try:
        columns, rows = (int(n) for n in pattern)
        whole = (columns, rows) == tuple(pattern)
    except (TypeError, ValueError):
        whole, columns, rows = False, 0, 0
    if not whole or min(columns, rows) < 3:
        raise CalibrationError(
            f"pattern = {pattern!r}: give (columns, rows) of inner corners (where four squares meet), at least 3x3; a "
            "board of 10x7 squares has (9, 6)"
        )
    return columns, rows
