"""Unstable loops whose numbers stay finite are warned of, calm ones are not: a warning that cries wolf is not read."""

import warnings

import numpy as np
import pytest

from ir50p_lab.controllers import PID, ContinuousPID
from ir50p_lab.errors import UnstableLoopWarning
from ir50p_lab.modelling import IR50P, THESIS_A, THESIS_RODS
from ir50p_lab.signals import sinusoid
from ir50p_lab.simulation import simulate

SET_POINT = (np.pi / 2, np.pi / 2, -np.pi / 3)
SMOOTH = IR50P.without_friction()
PWM = {"kp": (289, 225, 270), "kd": (40, 30, 30), "limit_pwm": 255}
THESIS = {"kp": (25, 200, 200), "kd": (10, 40, 40)}


class Late:
    """A controller that hears of every angle some samples late."""

    def __init__(self, pid, samples):
        self.pid, self.unit, self.samples, self.heard = pid, pid.unit, samples, []

    def step(self, t, q, reference):
        self.heard = [*self.heard[-self.samples :], q]
        return self.pid.step(t, self.heard[0], reference)


def late(kp, samples=3):
    return Late(PID((kp, 225, 270), kd=(0.1 * kp, 30, 30), limit_pwm=255), samples)


UNSTABLE = {  # arm, controller, options: each grows when it is not limited
    "held too long": (THESIS_RODS, lambda: PID(**THESIS, limit=330, filter_hz=np.inf), {"duration": 5}),
    "too much kd": (SMOOTH, lambda: PID(**PWM | {"kd": 3200}), {"duration": 6}),
    "too much ki": (SMOOTH, lambda: PID(**PWM, ki=5000), {"duration": 20}),
    "late, with friction": (IR50P, lambda: late(8000), {}),
    "a limit that nobody knows": (SMOOTH.theta_pwm, lambda: late(6000), {}),
}
STABLE = {
    "thesis in continuous time": (THESIS_A, lambda: ContinuousPID(**THESIS), {}),
    "the tables' gains, sampled fast enough": (
        THESIS_A, lambda: PID(**THESIS, limit=330, period=0.001, filter_hz=np.inf), {"period": 0.001, "duration": 1.5},
    ),
    "no damping: a swing that stays": (THESIS_A, lambda: ContinuousPID(200), {"reference": (0, 0.8, 0.3)}),
    "windup": (IR50P, lambda: PID(**PWM, ki=200, anti_windup=False), {"duration": 6}),
    "late but within limits": (SMOOTH, lambda: late(3000), {}),
    "against its stop": (IR50P, lambda: PID(**PWM), {"reference": (3.0, 0, 0), "stops": True}),
    "too weak for a fast sine": (
        SMOOTH, lambda: PID(**PWM | {"kp": 2000}), {"reference": sinusoid(amplitude=(1, 1, 1), omega=(6, 6, 6))},
    ),
    "far away and moving on": (IR50P, lambda: PID(**PWM), {"reference": (8, 0, 0), "duration": 4}),
    "a short run": (SMOOTH, lambda: late(8000), {"duration": 0.3}),
}  # fmt: skip


def run(arm, controller, options):
    options = dict(options)
    return simulate(arm, controller(), options.pop("reference", SET_POINT), **options)


@pytest.mark.parametrize("case", UNSTABLE)
def test_unstable_loops_are_warned_of(case):
    with pytest.warns(UnstableLoopWarning, match="from limit to limit") as caught:
        result = run(*UNSTABLE[case])
    assert result.unstable and result.unstable in str(caught[0].message)
    assert caught[0].filename == __file__  # it points at the call
    last = 3 * len(result.t) // 4
    assert np.abs(result.qd[last:]).max() > 0.1  # it does not come to rest


@pytest.mark.parametrize("case", STABLE)
def test_calm_loops_are_left_in_peace(case):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert run(*STABLE[case]).unstable == ""


def test_an_arm_that_runs_away_is_warned_of():
    class Wrong:
        """The sign slip: it pushes away."""

        def step(self, t, q, reference):
            return np.clip(-5 * (reference[0] - q), -3, 3)

    with pytest.warns(UnstableLoopWarning, match="error of joint 1"):
        simulate(SMOOTH, Wrong(), (0.1, 0, 0), duration=8)


def test_without_a_reference_or_a_controller_nobody_asked_it_to_stay():
    class Push:
        def step(self, t, q, reference):
            return (3.0, 0, 0)

    away = simulate(SMOOTH, Push(), duration=10)
    assert abs(away.q[-1, 0]) > 4 * np.pi and away.unstable == ""
    spun = simulate(THESIS_A, qd0=(8.0, 0, 0), duration=10)
    assert abs(spun.q[-1, 0]) > 4 * np.pi and spun.unstable == ""
