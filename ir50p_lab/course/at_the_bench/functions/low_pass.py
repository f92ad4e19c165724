"""low_pass: a signal without its fast part, sample by sample."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of


def low_pass(x, cutoff_hz, rate_hz):
    """Return the signal x (n,) after a first-order low pass that knows only the past and begins at x[0]; (n,)."""
    share = 1 - np.exp(-2 * np.pi * cutoff_hz / rate_hz)
    y = np.zeros(len(x))
    y[0] = x[0]
    for k in range(1, len(x)):
        y[k] = y[k - 1] + share * (x[k] - y[k - 1])
    return y


def _signals():
    rng = np.random.default_rng(102)
    noise = 0.5 + rng.normal(0, 0.2, 30)
    jump = np.array([0.2, 0.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2])
    wave = 0.3 + np.sin(0.4 * np.arange(25))
    return [
        (noise, 3.0, 100.0),
        (jump, 3.0, 100.0),
        (wave, 5.0, 50.0),
        (noise, 300.0, 100.0),  # the thesis's cut-off
        (jump, 50.0, 100.0),  # at half the rate
        (wave, 200.0, 1000.0),
        (np.array([0.4, 0.9]), 5.0, 100.0),  # the last one and the new one
        (np.array([512, 515, 510, 511, 514]), 10.0, 100.0),  # counts
        (jump, 0.5, 10.0),
    ]


_SAYS = sentences("low_pass", __file__)


def _symptom(case, returned, expected):
    x, y = np.asarray(case[0], dtype=float), np.asarray(returned)
    if y.shape != x.shape:
        return ""
    if y[0] != x[0]:
        return _SAYS["start"]
    if len(x) > 2 and 2 * case[1] < case[2] and np.allclose(y[:-1], expected[:-1]):
        return _SAYS["last"]
    if x[0] == x[1] and y[1] != x[0]:
        return _SAYS["restless"]
    gap, step = x[1:] - y[:-1], np.diff(y)
    shares = step[np.abs(gap) > 1e-6] / gap[np.abs(gap) > 1e-6]
    if len(shares) > 1 and np.ptp(shares) < 1e-6:
        closed, asked = (f"{share:.3g}" for share in (shares[0], 1 - np.exp(-2 * np.pi * case[1] / case[2])))
        return _SAYS["share"].format(closed, asked) if closed != asked else ""
    return ""


TASK = task_of(low_pass, cases=_signals, symptom=_symptom)
