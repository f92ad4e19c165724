"""Number of notebook 12: what a clamped joint hides."""

from ir50p_lab.course.checking.number import Number

NUMBERS = (
    Number(
        "ident-2",
        "12_identification",
        "how many of the 18 parameters of the rigid arm, or groups of them, all three joints together tell while "
        "joint 1 is clamped",
        13,
        tolerance=0.4,
        because="it is a whole number",
        why="Three have no effect, and two pairs act as one each: theta2 with theta9, theta5 with theta10.",
        mistakes={
            "That is with joint 1 free; clamped, its velocity and acceleration are zero.": 18,
            "Three columns vanish, right; but of those left some have become the same: compare them.": 15,
            "The offset Tf1 needs no motion: joint 1 still shows what it pushes with.": 14,
            "theta7 and theta8 belong to no rigid body; the question is about the other 18.": 20,
        },
        hint="Put 0 for speed, acceleration and direction of joint 1 into your regressor, for many random states.",
    ),
)
