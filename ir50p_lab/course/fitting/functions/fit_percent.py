"""fit_percent: how much of what was measured a prediction tells."""

import numpy as np

from ir50p_lab.course.checking.task import task_of


def fit_percent(measured, predicted):
    """Return 100 if predicted (n,) is what was measured (n,), 0 if it is no better than the mean; below 0 is worse."""
    missed = np.sum((measured - predicted) ** 2)
    spread = np.sum((measured - np.mean(measured)) ** 2)
    return 100 * (1 - np.sqrt(missed / spread))


def _runs():
    rng = np.random.default_rng(131)
    cases = []
    for n, offset, bias, noise in ((8, 0, 0, 0.3), (40, 90, 3, 2.0), (300, -50, 0, 8.0), (20, 5, 9, 1.0)):
        measured = offset + 10 * np.cumsum(rng.normal(size=n))
        cases.append((measured, measured + bias + rng.normal(0, noise, n)))
    wave = 90 + 40 * np.sin(0.3 * np.arange(60))
    mean, upside_down = np.full(60, wave.mean()), 2 * wave.mean() - wave
    whole = np.array([1, 4, 2, 8]), np.array([1, 3, 3, 7])
    return [*cases, (wave, mean), (wave, wave), (wave, upside_down), (wave, 2 * wave), whole]


TASK = task_of(fit_percent, cases=_runs, unit="%", tolerance=1e-7)
