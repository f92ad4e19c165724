"""A number exercise: a question whose answer is a number, a vector or a matrix.

A subject's own are data in its `numbers.py`, found there by their names:

    NUMBERS = (
        Number("dyn-6", "04_inertia", "the gear ratio N with which ...", N, tolerance=0.5, why=..., mistakes=...),
    )

Rules for authors (`tests/course/test_numbers_of_rooms.py` tries every one, and asks for another route to it):
- `right` comes from the package and from constants of the file (IR50P, not load_arm()): no variable of the student's,
  no other arm, may move it. The notebook states the same constants.
- At least three mistakes, sign and unit included (those are known: `_COMMON`), none equal to another or to the right
  answer. Their sentences say what is wrong and where to look, never the answer.
- At most two a notebook, in its order.
"""

from dataclasses import dataclass

import numpy as np

_COMMON = {  # mistakes that are known without being told, of any unit ("") and of one
    "": {"The size is right, the sign is not: which direction counts as positive?": np.negative},
    "rad": {"That is in degrees; inside the package every angle is in radians.": np.rad2deg},
    "m": {"That is in millimetres, not in metres.": lambda right: 1000 * right},
}


@dataclass(frozen=True, eq=False)
class Number:
    """A question whose answer is a number or an array of numbers, compared entry by entry.

    name: "pose-3". notebook: the name of its file, without the ending.
    task: the question in one line, without a full stop. right: number or array.
    tolerance: largest absolute difference of an entry that still counts as right; because: why that much.
    why: one line, shown for a right answer.
    mistakes: {what to say: a typical wrong answer, or a function of the right one (np.negative)}.
    unit: of the numbers, "rad", "m", "N m"; "" for none or several.
    hint: shown for a wrong answer that is not a known mistake.
    """

    name: str
    notebook: str
    task: str
    right: float | np.ndarray
    tolerance: float
    why: str
    mistakes: dict
    unit: str = ""
    because: str = "it allows for rounding"
    hint: str = ""

    def __post_init__(self):
        """Hold the right answer as an array of floats."""
        object.__setattr__(self, "right", np.array(self.right, dtype=float))

    @property
    def wanted(self):
        """What is wanted, in words, without the answer."""
        return shape_in_words(self.right.shape) + f" in {self.unit}" * bool(self.unit)

    @property
    def every_mistake(self):
        """All mistakes, {what to say: wrong answer}: its own, then the common ones."""
        mistakes = self.mistakes | _COMMON[""] | _COMMON.get(self.unit, {})
        return {message: wrong(self.right) if callable(wrong) else wrong for message, wrong in mistakes.items()}

    def near(self, found, target, tolerance):
        """Return for each entry whether it is within the tolerance of that of the target."""
        return np.abs(np.subtract(found, target)) <= tolerance


def shape_in_words(shape):
    """Return what an array of this shape is called: 'a number', '3 numbers', 'a 4 x 4 matrix'."""
    if len(shape) < 2:
        return f"{shape[0]} number{'s' * (shape[0] != 1)}" if shape else "a number"
    return f"a {' x '.join(map(str, shape))} {'matrix' if len(shape) == 2 else 'array'}"
