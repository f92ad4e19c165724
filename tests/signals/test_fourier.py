"""Fourier references: ends at rest, q, qd and qdd of one motion, limits kept for certain, and every refusal."""

import dataclasses
import pickle
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refused
from scipy.integrate import cumulative_simpson

from ir50p_lab.errors import UnreachableError
from ir50p_lab.modelling import IR50P, Arm
from ir50p_lab.signals import Fourier, at_rest, fourier
from ir50p_lab.signals.fourier import heights

MEAN = (0.0, 0.6, -1.0)


def drawn(seed, harmonics=5, size=0.15, **options):
    rng = np.random.default_rng(seed)
    a, b = rng.normal(0, size, (2, 3, harmonics)) / np.arange(1, harmonics + 1)
    return fourier(a, b, ends="adjust", **({"period": 10.0, "q0": MEAN} | options))


@settings(max_examples=60)
@given(st.integers(0, 10**6), st.integers(2, 9), st.floats(0.2, 300), st.integers(1, 11))
def test_rests_at_both_ends(seed, harmonics, period, periods):
    target = drawn(seed, harmonics, period=period, periods=periods)
    w = 2 * np.pi / period
    for t in (0.0, period * periods):
        near = target.sample([t - 1e-9 * period, t, t + 1e-9 * period])
        np.testing.assert_allclose(near[:, 0], [target.q_start] * 3, atol=1e-9)
        np.testing.assert_allclose(near[:, 1] / w, 0, atol=1e-6)
        np.testing.assert_allclose(near[:, 2] / w**2, 0, atol=1e-5)
    assert target.duration == pytest.approx(period * periods)
    np.testing.assert_array_equal(target(-1.0), [target.q_start, np.zeros(3), np.zeros(3)])
    np.testing.assert_array_equal(target(target.duration + 1), [target.q_start, np.zeros(3), np.zeros(3)])


@pytest.mark.parametrize("seed", range(5))
def test_integrals_of_the_acceleration_give_velocity_and_angle(seed):
    target = drawn(seed, periods=2)
    t = np.linspace(0, 22, 40001)
    rows = target.sample(t)
    v = cumulative_simpson(rows[:, 2], x=t, axis=0, initial=0)
    np.testing.assert_allclose(v, rows[:, 1], atol=1e-6)
    np.testing.assert_allclose(target.q_start + cumulative_simpson(v, x=t, axis=0, initial=0), rows[:, 0], atol=1e-5)


def test_it_is_the_series_of_the_thesis_from_k_1():
    """Second route: term by term, as (4.2) corrected is written."""
    a, b = at_rest(*np.random.default_rng(3).normal(0, 0.1, (2, 3, 4)))
    target, w = fourier(a, b, period=8.0, q0=MEAN), 2 * np.pi / 8
    for t in (0.5, 3.0, 7.9):
        for i in range(3):
            q = MEAN[i]
            for k in range(1, 5):
                q += a[i, k - 1] * np.sin(w * k * t) - b[i, k - 1] * np.cos(w * k * t)
            assert target(t)[0][i] == pytest.approx(q, abs=1e-13)


def test_adjusting_is_the_least_change():
    """Second route: the same least change by a general solver for each row."""
    a, b = np.random.default_rng(1).normal(size=(2, 3, 5))
    found = at_rest(a, b)
    k = np.arange(1.0, 6)
    for before, after, weight in ((a, found[0], k), (b, found[1], k**2)):
        np.testing.assert_allclose(after @ weight, 0, atol=1e-12)
        least = np.linalg.lstsq(weight[None], -(before @ weight)[None], rcond=None)[0].T
        np.testing.assert_allclose(after - before, least, atol=1e-12)
    again = at_rest(*found)
    np.testing.assert_allclose(again, found, atol=1e-14)


def test_a_record_of_whole_periods_has_no_leakage():
    target = drawn(4, periods=11)
    q = target.sample(np.arange(11000) * 0.01)[:, 0]
    size = np.abs(np.fft.rfft(q[:, 0])) / 5500
    size, lines = size[1:], 11 * np.arange(1, 6) - 1
    assert np.delete(size, lines).max() < 1e-12 < size[lines].min()
    assert isinstance(target, Fourier)
    assert pickle.loads(pickle.dumps(target)) == target and hash(target)


def test_moving_ends_are_refused():
    for size in (1e-6, 1e-2, 1.0):
        a, b = at_rest(*np.random.default_rng(2).normal(0, 0.1, (2, 3, 5)))
        fourier(a, b, period=10)
        for row, what in ((a, "velocity"), (b, "acceleration")):
            row[1, 2] += size
            refused(f"joint 2 does not end with zero {what}.*ends='adjust'", fourier, a, b, period=10)
            row[1, 2] -= size


@pytest.mark.parametrize(("joint", "over"), [(0, 1e-3), (1, 1e-1), (2, 1.0)])
@pytest.mark.parametrize("side", [-1, 1])
def test_joint_limits(over, joint, side):
    free = drawn(joint, size=0.05)
    q = free.sample(np.linspace(0, 10, 100001))[:, 0]
    low, high = np.full(3, -9.0), np.full(3, 9.0)
    edge = q[:, joint].max() if side > 0 else q[:, joint].min()
    arm = {True: dataclasses.replace(IR50P, q_min=low, q_max=np.where(np.arange(3) == joint, edge - over, high))}
    arm[False] = dataclasses.replace(IR50P, q_min=np.where(np.arange(3) == joint, edge + over, low), q_max=high)
    options = dict(size=0.05, margin=0.0, table=None, max_joint_speed=9)
    with pytest.raises(UnreachableError, match=f"joint {joint + 1} goes") as caught:
        drawn(joint, arm=arm[side > 0], **options)
    value, time = map(float, re.search(r"goes \w+ to (\S+) rad at (\S+) s", str(caught.value)).groups())
    assert value == pytest.approx(edge, abs=1e-3)
    assert free.sample([time])[0, 0, joint] == pytest.approx(value, abs=5e-3)  # the time is told to three digits
    wide = {True: {"q_max": np.where(np.arange(3) == joint, edge + 1e-3, high), "q_min": low}}
    wide[False] = {"q_min": np.where(np.arange(3) == joint, edge - 1e-3, low), "q_max": high}
    drawn(joint, arm=dataclasses.replace(IR50P, **wide[side > 0]), **options)


@settings(max_examples=40)
@given(st.integers(0, 10**6), st.integers(2, 9))
def test_what_is_accepted_stays_inside_between_the_points_of_the_check(seed, harmonics):
    arm = dataclasses.replace(IR50P, q_min=(-0.5, 0.1, -1.6), q_max=(0.5, 1.1, -0.4))
    try:
        target = drawn(seed, harmonics, arm=arm, margin=0.0)
    except UnreachableError:
        return
    rows = target.sample(np.random.default_rng(seed).uniform(0, 10, 20000))
    assert (rows[:, 0] <= arm.q_max).all() and (rows[:, 0] >= arm.q_min).all()
    assert (np.abs(rows[:, 1]) <= 0.5 * arm.actuators.no_load_speed).all()
    assert min(map(np.min, heights(arm.l, rows[:, 0]))) >= 0


def test_speed_and_table():
    drawn(0, arm=IR50P)
    for period in (3.0, 0.3, 0.03):
        refused(r"turns at .* rad/s.*longer period", drawn, 0, arm=IR50P, period=period, error=UnreachableError)
    for table in (0.35, 0.5, 5.0):
        refused(rf"mm under the table \(height {table:g} m\)", drawn, 0, arm=IR50P, table=table, error=UnreachableError)
    drawn(0, arm=IR50P, table=None)
    plain = Arm(l=IR50P.l, m=IR50P.m, lc=IR50P.lc)
    drawn(0, arm=plain, table=None)
    refused("limit is 2 rad/s", drawn, 0, arm=plain, table=None, period=0.5, error=UnreachableError)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"a": np.zeros(5)}, r"a has shape \(5,\)"),
        ({"a": np.zeros((3, 4))}, r"a has shape \(3, 4\), b \(3, 5\)"),
        ({"b": np.full((3, 5), np.nan)}, "b holds nan"),
        ({"b": "half"}, "b must hold numbers"),
        ({"period": 0}, "period = 0"),
        ({"period": np.inf}, "period = inf"),
        ({"q0": (0, 1)}, "q0 has shape"),
        ({"periods": 0}, "periods = 0"),
        ({"periods": 1.5}, "whole number"),
        ({"periods": True}, "periods = True"),
        ({"ends": "soft"}, "choose 'check' or 'adjust'"),
        ({"arm": "IR50P"}, "arm = .IR50P.: give an Arm"),
        ({"arm": IR50P, "margin": -1}, "margin = -1"),
        ({"arm": IR50P, "table": "low"}, "table = 'low'"),
        ({"arm": IR50P, "max_joint_speed": 0}, "max_joint_speed of joint 1"),
    ],
)
def test_bad_arguments(change, words):
    good = dict(a=np.zeros((3, 5)), b=np.zeros((3, 5)), period=10.0)
    refused(words, fourier, **good | change)
    refused("N >= 2", at_rest, np.ones((3, 1)), np.ones((3, 1)))
