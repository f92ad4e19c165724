"""The function of 18 that stays in its notebook: the course's, and what it is tried on."""

import numpy as np

from ir50p_lab.course.checking.task import notebook_tasks


def nearest(lens, on_line, hand):
    """Return the point (3,) nearest to the hand on the line through the lens and another point."""
    along = (on_line - lens) / np.linalg.norm(on_line - lens)
    return lens + (hand - lens) @ along * along


def _points():
    return [tuple(row) for row in np.random.default_rng(181).uniform(-1, 1, (5, 3, 3))]


TASKS = notebook_tasks(__file__, nearest=(nearest, _points, "a place on the line, three numbers", {"unit": "m"}))
