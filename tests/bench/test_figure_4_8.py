"""Figure 4.8 and Tables 4.1-4.3 on three simulated units with a weak shoulder: joint 1 goes over and hunts.

The thesis: joint 1 has no steady-state error but oscillates, because of its high Kp; a lower Kp leaves a big error, by
friction; joints 2 and 3 are good but for a small error; what wobble they show is noise. It filters q before the PID
(4.1.3) with a cut-off that cannot be 300 Hz; here it is 3 Hz, first order (one of four tried that fits Table 4.4).

As in the thesis joint 1 goes over its set point, comes back by sticking and slipping, and is right in the mean. Unlike
there it does not swing for ever: it goes over once by 7 %, sticks for seconds, slips back, and then hunts in hundreds of
slips of about a milliradian, stuck half of the time. Friction, delay and motors behind this were chosen so that it comes
out like this: plausible, not evidence.
"""

import numpy as np
import pytest

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P, IR50P_WEAK_SHOULDER
from ir50p_lab.signals import hold

SET_POINT = np.array([np.pi / 2, np.pi / 2, -np.pi / 3])
SEEDS = range(3)


def run(arm, seed):
    """30 s from the zero pose; returns times, measured error (set point - q), true angles and velocities."""
    bench = SimulatedBench(arm, seed=seed, record_to=False).open()
    filters = {"position_filter_hz": 3, "filter_hz": np.inf}
    pid = PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255, **filters)
    recording = bench.follow(pid, hold(SET_POINT), 30)
    return recording.t, SET_POINT - recording.q, bench.truth.q, bench.truth.qd


def overshoot(q):
    """Per cent of the step, (3,)."""
    return 100 * ((q - SET_POINT) / SET_POINT).max(axis=0)


@pytest.mark.parametrize("seed", SEEDS)
def test_joint_1_goes_over_and_hunts_without_mean_error(seed):
    t, error, q, qd = run(IR50P_WEAK_SHOULDER, seed)
    assert 5.5 < overshoot(q)[0] < 9  # 7.1 in the trials this unit was chosen by
    assert abs(error[t >= 25, 0].mean()) < 0.004
    late = t >= 15
    assert 0.014 < np.ptp(q[late, 0]) < 0.04  # hunting; 0.014 to 0.033 in the trials
    moving = np.abs(qd[t > 2, 0]) > 1e-3
    assert (np.diff(moving.astype(int)) == 1).sum() > 100  # slips
    assert 0.3 < (qd[t > 2, 0] == 0).mean() < 0.7  # and sticks between them
    assert (error[late, 0] > 0).any() and (error[late, 0] < 0).any()


@pytest.mark.parametrize("seed", SEEDS)
def test_the_default_unit_does_not_go_over(seed):
    _, error, q, _ = run(IR50P, seed)
    assert overshoot(q)[0] < 1.5
    assert abs(error[-500:, 0].mean()) < 0.015
