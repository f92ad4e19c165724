"""References: q, qd and qdd belong together (by differences and by integration), limits are kept, ends are exact."""

import dataclasses
import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ir50p_lab.errors import InputError
from ir50p_lab.signals import Reference, hold, quintic, sinusoid, steps, through, trapezoid

A, B, C = (0.1, -0.4, 0.7), (1.2, 0.6, -0.3), (0.0, 0.2, 0.2)
SMOOTH = {
    "hold": hold(A),
    "quintic": quintic(A, B, duration=1.7),
    "through": through([A, B, B, C], durations=[1.0, 0.3, 0.8]),
    "trapezoid": trapezoid(A, B, v_max=(1.0, 0.8, 2.0), a_max=(3.0, 5.0, 2.5)),
    "triangle": trapezoid(A, B, v_max=50, a_max=2),
    "sinusoid": sinusoid((0.5, 0.2, 1), (1, 2, 3), offset=A, phase=(0, 1, math.pi / 2)),
}
ALL = SMOOTH | {"steps": steps([0, 1, 2.5], [A, B, C])}


@pytest.mark.parametrize("target", ALL.values(), ids=ALL)
def test_one_time_and_many_times_agree_to_the_last_bit(target):
    t = np.r_[-1.0, np.linspace(0, 4, 81), 0.4, 2.5, 50.0, 0.3]
    rows = target.sample(t)
    assert rows.shape == (len(t), 3, 3) and rows.dtype == float
    for row, time in zip(rows, t, strict=True):
        one = target(time)
        assert len(one) == 3 and all(part.shape == (3,) for part in one)
        np.testing.assert_array_equal(row, one)
    assert target.sample([]).shape == (0, 3, 3)


@pytest.mark.parametrize("target", SMOOTH.values(), ids=SMOOTH)
def test_velocity_and_acceleration_are_derivatives(target):
    t, h = np.linspace(-0.5, 4, 2003), 1e-5
    behind, here, ahead = (target.sample(t + shift) for shift in (-h, 0, h))
    slope = (ahead - behind) / (2 * h)
    np.testing.assert_allclose(slope[:, 0], here[:, 1], atol=3e-5)
    jump = np.abs(ahead[:, 2] - behind[:, 2]).max(axis=1) > 0.01  # a trapezoid's acceleration jumps
    assert jump.sum() <= 6
    np.testing.assert_allclose(slope[~jump, 1], here[~jump, 2], atol=1e-4)


@pytest.mark.parametrize("duration", [0.001, 1.0, 3600.0])
def test_quintic_rests_at_both_ends_and_has_the_peaks_it_names(duration):
    target = quintic(A, B, duration=duration)
    way = np.subtract(B, A)
    for t, q in ((-1.0, A), (0.0, A), (duration, B), (duration + 9, B), (1e9, B)):
        np.testing.assert_array_equal(target(t), [q, (0, 0, 0), (0, 0, 0)])
    rows = target.sample(duration * np.linspace(0, 1, 20001))
    np.testing.assert_allclose(np.abs(rows[:, 1]).max(axis=0), 15 / 8 * np.abs(way) / duration, rtol=1e-6)
    np.testing.assert_allclose(np.abs(rows[:, 2]).max(axis=0), 10 / 3**0.5 * np.abs(way) / duration**2, rtol=1e-6)
    np.testing.assert_allclose(target(duration / 2)[0], np.add(A, B) / 2, rtol=1e-9)
    assert target.duration == duration


def test_through_passes_its_points_and_pauses():
    target = SMOOTH["through"]
    for t, point in zip((0.0, 1.0, 1.3, 2.1), (A, B, B, C), strict=True):
        np.testing.assert_allclose(target(t), [point, (0, 0, 0), (0, 0, 0)], atol=1e-12)
    np.testing.assert_array_equal(target(1.13), [B, (0, 0, 0), (0, 0, 0)])
    assert through([A, B], durations=2) == quintic(A, B, duration=2)


poses = st.tuples(*[st.floats(-3, 3)] * 3)
limits = st.tuples(*[st.floats(0.05, 20)] * 3)


@settings(max_examples=150, deadline=None)
@given(q0=poses, q1=poses, v_max=limits, a_max=limits)
def test_trapezoid_keeps_every_limit_and_arrives(q0, q1, v_max, a_max):
    target = trapezoid(q0, q1, v_max=v_max, a_max=a_max)
    rows = target.sample(np.linspace(-0.1, target.duration + 0.1, 400))
    assert (np.abs(rows[:, 1]) <= np.array(v_max) * (1 + 1e-12)).all()
    assert (np.abs(rows[:, 2]) <= np.array(a_max) * (1 + 1e-12)).all()
    np.testing.assert_array_equal(rows[0], [q0, (0, 0, 0), (0, 0, 0)])
    np.testing.assert_array_equal(rows[-1], [q1, (0, 0, 0), (0, 0, 0)])
    assert (rows[:, 0] <= np.maximum(q0, q1) + 1e-12).all() and (rows[:, 0] >= np.minimum(q0, q1) - 1e-12).all()
    # arriving is not a jump: just before the end the joint is almost there, and slow
    before = target.sample([target.duration * (1 - 1e-6)])[0, 0]
    assert (np.abs(before - q1) <= np.array(a_max) * (1e-6 * target.duration) ** 2 / 2 * 1.01 + 1e-14).all()


@pytest.mark.parametrize("distance, T", [(2.0, 2.0 / 1.0 + 1.0 / 4.0), (0.25, 0.5), (0.01, 0.1), (1e-6, 1e-3)])
def test_trapezoid_time_by_hand(distance, T):
    target = trapezoid((0, 0, 0), (distance, -distance, 0), v_max=1.0, a_max=4.0)
    assert target.duration == pytest.approx(T, rel=1e-12)
    assert np.abs(target.sample(np.linspace(0, T, 1001))[:, 1]).max() == pytest.approx(min(1.0, 4.0 * T / 2), rel=1e-2)


def alone(joint, v_max, a_max):
    """The motion from A to B of one joint, the others at rest."""
    goal = np.where(np.arange(3) == joint, B, A)
    return trapezoid(A, goal, v_max=v_max, a_max=a_max)


def test_synchronised_joints_arrive_together_on_a_straight_line():
    kwargs = dict(v_max=(1.0, 0.8, 2.0), a_max=(3.0, 5.0, 2.5))
    together = trapezoid(A, B, **kwargs)
    apart = [alone(j, kwargs["v_max"][j], kwargs["a_max"][j]).duration for j in range(3)]
    assert len(set(apart)) == 3 and together.duration >= max(apart)
    share = (together.sample(np.linspace(0, 3, 301))[:, 0] - A) / np.subtract(B, A)
    np.testing.assert_allclose(share, share[:, :1] * np.ones(3), atol=1e-12)
    # it is the quickest: one of the limits is touched in velocity or in acceleration
    rows = np.abs(together.sample(np.linspace(0, together.duration, 2001)))
    assert (rows[:, 1].max(axis=0) / kwargs["v_max"]).max() == pytest.approx(1, abs=1e-9)
    assert (rows[:, 2].max(axis=0) / kwargs["a_max"]).max() == pytest.approx(1, abs=1e-9)
    # where one joint sets both limits, the slowest joint alone sets the time
    same = dict(v_max=1.0, a_max=2.0)
    assert trapezoid(A, B, **same).duration == max(alone(j, 1.0, 2.0).duration for j in range(3))


def test_standing_still_is_no_error():
    still = trapezoid(A, A, v_max=1, a_max=1)
    assert still.duration == 0 and not still.sample([0, 1.0])[:, 1:].any()
    assert not quintic(A, A, duration=1).sample([0, 0.5])[:, 1:].any()
    one_joint = trapezoid((0, 0, 0), (0, 1, 1e-200), v_max=1, a_max=1)
    assert one_joint.duration == 2.0


def test_steps_jump_at_their_time():
    target = ALL["steps"]
    for t, q in ((-3, A), (0, A), (0.999, A), (1.0, B), (2.499, B), (2.5, C), (99, C)):
        np.testing.assert_array_equal(target(t), [q, (0, 0, 0), (0, 0, 0)])
    assert target.duration == 2.5 and hold(A).duration == 0


def test_sinusoid_begins_at_rest_with_phase_of_a_quarter_turn():
    target = sinusoid(0.3, 2.0, offset=(1, 0, 0), phase=math.pi / 2)
    q, qd, _ = target(0.0)
    np.testing.assert_allclose(q, (1.3, 0.3, 0.3))
    np.testing.assert_allclose(qd, 0, atol=1e-15)
    assert target.duration == math.inf
    np.testing.assert_allclose(target(math.pi)[0], q, atol=1e-12)


@pytest.mark.parametrize("target", ALL.values(), ids=ALL)
def test_references_are_frozen_values(target):
    assert isinstance(target, Reference)
    with pytest.raises(dataclasses.FrozenInstanceError):
        target.duration = 1.0
    assert pickle.loads(pickle.dumps(target)) == target and hash(target) == hash(pickle.loads(pickle.dumps(target)))
    q, _, _ = target(0.7)
    q += 1.0  # the answer belongs to the caller
    assert not np.array_equal(target(0.7)[0], q)


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: hold([0, 0]), "shape (2,)"),
        (lambda: hold([0, math.nan, 0]), "nan at index 1"),
        (lambda: hold("up"), "numbers in rad"),
        (lambda: steps([0, 1], [A]), "do not fit"),
        (lambda: steps([], np.empty((0, 3))), "do not fit"),
        (lambda: steps([0, 0], [A, B]), "times = [0.0, 0.0] s: let them increase"),
        (lambda: steps([1, 2], [A, B]), "from 0 (or earlier)"),
        (lambda: steps([[0, 1]], [A, B]), "shape (1, 2)"),
        (lambda: quintic(A, B, duration=0), "duration = 0 s: give one finite number > 0"),
        (lambda: quintic(A, [B, C], duration=1), "q1 has shape (2, 3)"),
        (lambda: through([A], durations=1), "at least two poses"),
        (lambda: through([A, B, C], durations=[1]), "1 durations for 2 pieces"),
        (lambda: through([A, B, C], durations=[1, 0]), "durations[1]"),
        (lambda: trapezoid(A, B, v_max=0, a_max=1), "v_max of joint 1"),
        (lambda: trapezoid(A, B, v_max=1, a_max=(1, -2, 1)), "a_max of joint 2 = -2.0 rad/s^2"),
        (lambda: trapezoid(A, B, v_max=1, a_max=math.inf), "finite"),
        (lambda: trapezoid(A, B, v_max=(1, 1), a_max=1), "v_max has shape (2,)"),
        (lambda: sinusoid(math.nan, 1), "amplitude"),
        (lambda: sinusoid(1, (1, 2)), "omega has shape (2,)"),
        (lambda: hold(A)(math.nan), "t = nan"),
        (lambda: hold(A)([0.0, 1.0]), "target.sample(t)"),
        (lambda: hold(A).sample(1.0), "shape ()"),
        (lambda: hold(A).sample([0, math.nan]), "nan at index 1"),
    ],
)
def test_bad_input_gets_a_sentence(make, words):
    with pytest.raises(InputError) as caught:
        make()
    assert words in str(caught.value)
