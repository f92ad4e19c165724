"""Figures of notebooks 10 and 11: they draw what was recorded, and say where it is from."""

import numpy as np
import pytest

from ir50p_lab.bench import Recording, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course.at_the_bench import views
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import through

TABLES = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30), "limit_pwm": 255}


def texts(figure):
    return " ".join([*(t.get_text() for t in figure.texts), *(ax.get_title() for ax in figure.axes)])


@pytest.fixture(scope="module")
def motion():
    bench = SimulatedBench(IR50P, record_to=False).open()
    return bench.follow(PID(**TABLES), through([(0, 0, 0), (0, 0, 0), (0.8, 0, 0), (0, 0, 0)], durations=2), 7)


def test_origin():
    t, q = [0, 1], np.zeros((2, 3))
    assert views.origin(Recording.from_arrays(t, q)) == "origin unknown"
    assert views.origin(Recording.from_arrays(t, q, header={"simulated": "true"})) == "simulated arm"
    assert views.origin(Recording.from_arrays(t, q, header={"simulated": "false"})) == "the real arm"
