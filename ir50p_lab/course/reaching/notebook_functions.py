"""The function of 18 that stays in its notebook: the course's, what it is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.task import Mistake, notebook_tasks


def nearest(lens, on_line, hand):
    """The point (3,) of the line through the lens and another point of it that is nearest to the hand."""
    along = (on_line - lens) / np.linalg.norm(on_line - lens)
    return lens + ((hand - lens) @ along) * along


# ------------------------------------------------------------------------------------------------------ tried on
def _lines():
    return [tuple(row) for row in np.random.default_rng(181).uniform(-1, 1, (5, 3, 3))]


# ----------------------------------------------------------------------------------------------- typical mistakes
def _not_one_long(lens, on_line, hand):
    along = on_line - lens
    return lens + ((hand - lens) @ along) * along


def _from_the_base(lens, on_line, hand):
    along = (on_line - lens) / np.linalg.norm(on_line - lens)
    return (hand @ along) * along


def _without_lens(lens, on_line, hand):
    return nearest(lens, on_line, hand) - lens


def _how_far(lens, on_line, hand):
    return (hand - lens) @ (on_line - lens) / np.linalg.norm(on_line - lens)


def _same_distance(lens, on_line, hand):
    along = (on_line - lens) / np.linalg.norm(on_line - lens)
    return lens + np.linalg.norm(hand - lens) * along


_LONG = "the place is not on the line, or not the nearest: is the arrow along the line 1 long?"
_BASE = "it is the nearest point of a line through the base, not through the lens"
_LENS = "it is counted from the lens: a place counts from the base"
_FAR = "that is how far along the line it is, one number: where is that?"
_SAME = "it is as far from the lens as the hand is, and that is not the nearest point"

TASKS = notebook_tasks(
    __file__,
    nearest=(nearest, _lines, "a place on the line, three numbers", {
        "mistakes": (Mistake(_not_one_long, _LONG), Mistake(_from_the_base, _BASE), Mistake(_without_lens, _LENS),
                     Mistake(_how_far, _FAR), Mistake(_same_distance, _SAME)), "unit": "m"}),
)  # fmt: skip
