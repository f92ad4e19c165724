"""A set point that a hand moves: limited speed and acceleration, no overshoot, whatever the hand does."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ir50p_lab.bench.live_loop import _Target
from ir50p_lab.bench.set_point import SetPoint
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold, sinusoid

ANGLES = st.floats(-2.0, 2.0)


def motion(target, times, orders=()):
    orders = dict(orders)
    rows = []
    for k, t in enumerate(times):
        if k in orders:
            target.move_to(orders[k])
        rows.append(np.array(target(t)))
    return np.array(rows)


def test_it_rests_until_told():
    rows = motion(SetPoint([0.1, 0.2, 0.3]), np.arange(5) * 0.01)
    assert (rows[:, 0] == [0.1, 0.2, 0.3]).all() and not rows[:, 1:].any()


def test_it_arrives_exactly_and_as_fast_as_the_limits_allow():
    target = SetPoint([0, 0, 0])
    rows = motion(target, np.arange(400) * 0.01, {0: [1.0, -0.2, 0.01]})
    assert (rows[-1, 0] == [1.0, -0.2, 0.01]).all() and not rows[-1, 1:].any()
    arrived = np.argmax(rows[:, 0, 0] == 1.0) * 0.01
    assert arrived == pytest.approx(1.0 / 0.8 + 0.8 / 3.0, abs=0.03)  # the trapezoid's time


@settings(max_examples=25)
@given(st.dictionaries(st.integers(0, 200), st.tuples(ANGLES, ANGLES, ANGLES), min_size=1, max_size=8))
def test_never_too_fast_never_beyond(orders):
    rows = motion(SetPoint([0, 0, 0]), np.arange(1200) * 0.01, orders)
    q, qd, qdd = rows[:, 0], rows[:, 1], rows[:, 2]
    assert np.abs(qd).max() <= 0.8 + 1e-9 and np.abs(qdd).max() <= 3.0 + 1e-9
    np.testing.assert_allclose(np.diff(q, axis=0) / 0.01, qd[1:], atol=1e-9)
    np.testing.assert_array_equal(q[-1], orders[max(orders)])
    after = q[max(orders) + 56 :]  # a joint that was moving away, or too fast to stop in time, has come back by then
    way = np.sign(q[-1] - after[0])
    assert (np.diff(after, axis=0) * way >= -1e-12).all()  # straight to the goal: no overshoot


def test_late_cycles_do_not_make_it_jump():
    target = SetPoint([0, 0, 0])
    target.move_to([2, 0, 0])
    motion(target, np.arange(100) * 0.01)
    before = target(1.0)[0][0]
    assert 0 < target(60.0)[0][0] - before <= 0.25 * 0.8 + 1e-9


def test_it_takes_over_a_motion():
    target = SetPoint([0.5, 0, 0], qd=[0.6, 0, 0])
    rows = motion(target, np.arange(200) * 0.01)
    assert rows[:, 0, 0].max() > 0.5 and rows[-1, 0, 0] == 0.5  # brakes, comes back
    with pytest.raises(InputError):
        target.move_to([1, 2])
    with pytest.raises(InputError):
        target.move_to([np.inf, 0, 0])


def test_a_target_is_led_in_from_the_pose_and_ends_on_the_reference():
    swing = sinusoid(0.3, 2.0, offset=0.5, phase=np.pi / 2)
    here = np.array([0.0, 0.1, 0.2])
    standing = SimpleNamespace(arm=IR50P, last=SimpleNamespace(q=here))
    target = _Target(standing, swing)
    times = 7.0 + np.arange(400) * 0.01
    rows = np.array([target(t) for t in times])
    np.testing.assert_allclose(rows[0, 0], here)
    arrived = np.argmax((rows[:, 0] == swing(0.0)[0]).all(axis=1))
    assert 0 < arrived < 200 and np.abs(rows[:arrived, 1]).max() == pytest.approx(0.8)
    assert not target.leading
    np.testing.assert_allclose(rows[arrived + 1 :], swing.sample(times[: -arrived - 1] - 7.0), atol=1e-9)
    there = _Target(standing, hold([0.0, 0.1, 0.203]))
    assert [there(t)[0][2] for t in (0.0, 1.0)] == [0.2, 0.203]
