"""Processing: against motions whose derivatives are known, the thesis' way step by step, gaps, uneven times, delay."""

from types import SimpleNamespace

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.identification import causal_derivatives, central_derivatives, process
from ir50p_lab.signals import at_rest, fourier, low_pass

A, B = at_rest(*np.random.default_rng(1).normal(0, 0.1, (2, 3, 5)))
TARGET = fourier(A, B, period=10.0, q0=(0, 0.6, -1), periods=3)


def recorded(rate=100.0, seconds=30.0, *, keep=None, jitter=0.0, seed=0):
    t = np.arange(round(seconds * rate)) / rate
    t = t + jitter / rate * np.random.default_rng(seed).uniform(-1, 1, len(t))
    if keep is not None:
        t = t[keep(t)]
    rows = TARGET.sample(t)
    u = 3 * rows[:, 2] + 2 * rows[:, 1] + rows[:, 0]
    return SimpleNamespace(t=t, q=rows[:, 0], u=u)


def test_causal_is_the_thesis_way_sample_by_sample():
    """Second route: the filter and the differences as a loop has them."""
    q = recorded().q
    last, last_v, rows = None, np.zeros(3), []
    for x in low_pass(q, 3.0, 100.0):
        v = np.zeros(3) if last is None else (x - last) * 100
        rows.append([x, v, (v - last_v) * 100])
        last, last_v = x, v
    for found, expected in zip(causal_derivatives(q, 100.0, cutoff_hz=3.0), np.swapaxes(rows, 0, 1), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-9)


def test_causal_comes_as_late_as_it_says():
    t = np.arange(3000) / 100
    for cutoff in (2.0, 3.0, 8.0):
        q, qd, qdd = causal_derivatives(np.sin(0.6 * t), 100.0, cutoff_hz=cutoff)
        w, late = 0.6, 1 / (2 * np.pi * cutoff)
        for x, amplitude, phase, extra in ((q, 1, 0, 0), (qd, w, 1, 0.005), (qdd, w * w, 2, 0.01)):
            expected = amplitude * np.sin(w * (t - late - extra) + phase * np.pi / 2)
            assert np.abs(x - expected)[1000:].max() < 0.01 * amplitude


@pytest.mark.parametrize("rate", [50.0, 1000.0])
@pytest.mark.parametrize("cutoff", [None, 3.0])
def test_central_differences_find_the_motion(rate, cutoff):
    t = np.arange(int(30 * rate)) / rate
    rows = TARGET.sample(t)
    middle = slice(int(2 * rate), int(-2 * rate))
    for found, expected in zip(
        central_derivatives(rows[:, 0], rate, cutoff_hz=cutoff), np.swapaxes(rows, 0, 1), strict=True
    ):
        error = np.abs(found - expected)[middle].max(axis=0) / np.abs(expected).max(axis=0)
        assert error.max() < (2e-3 if rate > 60 else 5e-3)


@pytest.mark.parametrize("rate, cutoff, filter_u", [(40.0, None, True), (100.0, 4.0, False), (500.0, 4.0, True)])
def test_a_linear_law_survives_processing(rate, cutoff, filter_u):
    """u = 3 qdd + 2 qd + q holds before, so it holds after: at any rate, with filtered u."""
    motion = process(recorded(rate), cutoff_hz=cutoff, filter_u=filter_u, held=False)
    predicted = 3 * motion.qdd + 2 * motion.qd + motion.q
    assert np.abs(motion.u - predicted).max() < 0.01 * np.ptp(motion.u) * (100 / rate if rate < 100 else 1)
    assert motion.rate_hz == pytest.approx(rate) and motion.use.all()
    np.testing.assert_allclose(np.diff(motion.t), 1 / rate, rtol=1e-6)


@pytest.mark.parametrize("size", [0.005, 0.4])
def test_uneven_times_are_interpolated(size):
    motion = process(recorded(jitter=size), cutoff_hz=3.0, held=False)
    rows = TARGET.sample(motion.t)
    assert np.abs(motion.qd - rows[:, 1]).max() < 0.01 * np.ptp(rows[:, 1])
    assert np.abs(motion.qdd - rows[:, 2]).max() < 0.01 * np.ptp(rows[:, 2])


@pytest.mark.parametrize("gap", [0.1, 10.0])
def test_gaps_split_the_record(gap):
    record = recorded(keep=lambda t: (t < 9) | (t > 9 + gap))
    motion = process(record, cutoff_hz=3.0, held=False)
    assert set(motion.segment) == {0, 1}
    rows = TARGET.sample(motion.t)
    assert np.abs(motion.qd - rows[:, 1]).max() < 0.02 * np.ptp(rows[:, 1])
    assert not ((motion.t > 8.9) & (motion.t < 9 + gap + 0.1)).any()


@pytest.mark.parametrize("delay", [0, 2, 7])
@pytest.mark.parametrize("held", [False, True])
def test_u_is_taken_when_it_acts(delay, held):
    """A mass under a held force, exactly: second differences see the mean of two commands, `delay` samples ago."""
    n, T = 400, 0.01
    u = np.random.default_rng(0).normal(size=n + 10).cumsum()
    acting, q, v = u[10 - delay : n + 10 - delay], np.zeros(n), 0.0
    for k in range(n - 1):
        q[k + 1] = q[k] + v * T + acting[k] * T * T / 2
        v += acting[k] * T
    t = np.arange(n) * T
    motion = process(t, q, u[10:], cutoff_hz=None, delay=delay * T, held=held)
    error = np.abs(motion.u - motion.qdd)[delay + 1 :].max()
    assert error < 1e-6 if held else error > 0.1


def test_slow_samples_are_marked():
    motion = process(recorded(), slow=0.2, cutoff_hz=3.0)
    np.testing.assert_array_equal(motion.use, np.abs(motion.qd) >= 0.2)


def test_dates_are_times_and_masked_samples_are_left_out():
    record = recorded(seconds=5)
    dates = np.datetime64("2024-01-01") + np.round(1e6 * record.t).astype("timedelta64[us]")
    np.testing.assert_allclose(process(dates, record.q, record.u).qdd, process(record).qdd, atol=1e-6)
    refused("0 of 9 samples are not masked", process, *[np.ma.masked_all(9)] * 3)


def test_arrays_of_one_joint():
    record = recorded()
    one, all_ = process(record.t, record.q[:, 1], record.u[:, 1]), process(record)
    assert one.q.shape == (len(one), 1)
    for name in ("q", "qd", "qdd", "u"):
        np.testing.assert_allclose(getattr(one, name)[:, 0], getattr(all_, name)[:, 1], atol=1e-9)
    refused("neither both nor a part", process, record, record.q, record.u)
    refused("shape", process, record.t[1:], record.q, record.u)


@pytest.mark.parametrize("column, index", [("t", "500"), ("q", r"\(500, 0\)"), ("u", r"\(500, 0\)")])
def test_nan_is_refused_with_its_place(column, index):
    record = recorded()
    getattr(record, column)[500] = np.nan
    refused(f"{column} holds nan at index {index}", process, record)


@pytest.mark.parametrize(
    "options, words",
    [
        ({"derivatives": "both"}, "choose"),
        ({"derivatives": "causal", "cutoff_hz": None}, "cutoff_hz = None"),
        ({"cutoff_hz": 60}, "cutoff_hz = 60"),
        ({"delay": -0.01}, "delay = -0.01"),
        ({"delay": None}, "delay = None"),
        ({"held": "yes"}, "held = 'yes'"),
        ({"slow": -1}, "slow = -1"),
        ({"slow": (0, 1)}, "slow = "),
        ({"trim": np.nan}, "trim = nan"),
    ],
)
def test_bad_arguments(options, words):
    refused(words.replace(".", r"\."), process, recorded(seconds=5), **options)
