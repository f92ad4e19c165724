"""Figures of notebooks 10 and 11 say where what they show is from."""

import numpy as np

from ir50p_lab.bench import Recording
from ir50p_lab.course.draw.style import origin


def test_origin():
    t, q = [0, 1], np.zeros((2, 3))
    assert origin(Recording.from_arrays(t, q)) == "origin unknown"
    assert origin(Recording.from_arrays(t, q, header={"simulated": "true"})) == "simulated arm"
    assert origin(Recording.from_arrays(t, q, header={"simulated": "false"})) == "the real arm"
