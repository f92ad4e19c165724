"""Figure 4.8 and Tables 4.1-4.3 on three simulated units with a weak shoulder: what comes out as in the thesis, what not.

The thesis: joint 1 has no steady-state error but oscillates, because of its high Kp; a lower Kp leaves a big error, by
friction; joints 2 and 3 are good but for a small error; what wobble they show is noise. It filters q before the PID
(4.1.3) with a cut-off that cannot be 300 Hz; here it is 3 Hz, first order (one of four tried that fits Table 4.4).

As in the thesis: joint 1 goes over its set point, comes back by sticking and slipping, and is right in the mean; with
Kp1 = 100 and Ki1 = 0 it stays 0.29 rad away; Kp alone makes it go over, the more the higher it is; joints 2 and 3 end
within 35 mrad.

Not as in the thesis, or not known from it:
- Joint 1 does not swing for ever. It goes over once by 7 %, sticks there for seconds, slips back, and then hunts in
  hundreds of slips of about a milliradian, stuck half of the time. Thirty seconds are too short for the integral to
  bring it over again: breakaway is 36 counts, and 50 counts per rad and second fill slowly.
- Ki1 makes joint 1 go over more than Kp1 does (from 4 to 7 %), and dominates once Kp1 is low (Kp1 = 100 with Ki1 = 50
  ends at the end stop); the thesis blames Kp alone.
- The assumed end stop at 100 deg is only 11 % beyond the set point, and cuts every larger swing off.
- Joint 3 goes over by 14 % and takes 15 s to come back (gravity and integral); the thesis does not mention it.
- Joint 2 does not settle within 30 s: it still creeps up, with some 25 mrad to go.
- The friction, delay and motors behind all this were chosen so that it comes out like this: plausible, not evidence.
"""

import numpy as np
import pytest

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P, IR50P_WEAK_SHOULDER
from ir50p_lab.signals import hold

SET_POINT = np.array([np.pi / 2, np.pi / 2, -np.pi / 3])
SEEDS = range(3)


def run(arm, seed, kp1=289, ki1=50, **filters):
    """30 s from the zero pose; returns times, measured error (set point - q), true angles and velocities."""
    bench = SimulatedBench(arm, seed=seed, record_to=False).open()
    filters = filters or {"position_filter_hz": 3, "filter_hz": np.inf}
    pid = PID(kp=(kp1, 225, 270), ki=(ki1, 10, 50), kd=(40, 30, 30), limit_pwm=255, **filters)
    recording = bench.follow(pid, hold(SET_POINT), 30)
    return recording.t, SET_POINT - recording.q, bench.truth.q, bench.truth.qd


def overshoot(q):
    """Per cent of the step, (3,)."""
    return 100 * ((q - SET_POINT) / SET_POINT).max(axis=0)


@pytest.fixture(scope="module", params=SEEDS)
def tables(request):
    """Tables 4.1-4.3 on one unit."""
    return run(IR50P_WEAK_SHOULDER, request.param)


def test_joint_1_goes_over_and_hunts_without_mean_error(tables):
    t, error, q, qd = tables
    assert 5.5 < overshoot(q)[0] < 9  # 7.1 in the trials this unit was chosen by
    assert abs(error[t >= 25, 0].mean()) < 0.004
    late = t >= 15
    assert 0.014 < np.ptp(q[late, 0]) < 0.04  # hunting; 0.014 to 0.033 in the trials
    moving = np.abs(qd[t > 2, 0]) > 1e-3
    assert (np.diff(moving.astype(int)) == 1).sum() > 100  # slips
    assert 0.3 < (qd[t > 2, 0] == 0).mean() < 0.7  # and sticks between them
    assert (error[late, 0] > 0).any() and (error[late, 0] < 0).any()


def test_joints_2_and_3_settle_with_small_errors(tables):
    t, error, q, _ = tables
    end = error[t >= 25].mean(axis=0)
    assert 0.02 < end[1] < 0.035
    assert abs(end[2]) < 0.008
    assert overshoot(q)[1] < 1.5  # none but for the error of its potentiometer


@pytest.mark.parametrize("seed", SEEDS)
def test_a_lower_gain_leaves_a_large_error_by_friction(seed):
    t, error, q, _ = run(IR50P_WEAK_SHOULDER, seed, kp1=100, ki1=0)
    assert 0.25 < error[t >= 25, 0].mean() < 0.31  # 0.285 in the trials: breakaway over Kp, and the offset
    assert np.ptp(q[t >= 10, 0]) < 1e-3  # and there it sticks


@pytest.mark.parametrize("seed", SEEDS)
def test_the_default_unit_does_not_go_over(seed):
    _, error, q, _ = run(IR50P, seed)
    assert overshoot(q)[0] < 1.5
    assert abs(error[-500:, 0].mean()) < 0.015
