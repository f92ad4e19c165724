"""A controller is tried on the simulated arm before a real one: the same object comes back, or the error says why."""

import numpy as np
import pytest
import solutions

from ir50p_lab.course import RehearsalError, rehearse

TARGET = np.array([0.3, 0.8, -0.8])


def test_a_good_controller_comes_back_reset():
    pid = solutions.load().PID(kp=(600, 900, 700), ki=(300, 400, 300), kd=(40, 60, 50))
    assert rehearse(pid, TARGET, show=False) is pid
    assert (pid.integral == 0).all()


def test_a_wrong_sign_does_not_go_to_an_arm():
    pid = solutions.load().PID(kp=(-600, -900, -700))
    with pytest.raises(RehearsalError, match=r"joint \d would stand at .* rad"):
        rehearse(pid, TARGET, show=False)
