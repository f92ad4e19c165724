"""Notebook 10: the hand that holds a simulated arm at a protractor, and what a line makes of its readings."""

from dataclasses import replace
from itertools import count

import numpy as np

from ir50p_lab.bench import UNIT, SimulatedArm, connect
from ir50p_lab.course.draw.style import COLOURS, JOINT_LABELS, SETPOINT, subplots

_HANDS = count()  # a hand that reads again reads with other errors
_RULER = np.random.default_rng(0)


def moved_by_hand(arm, poses):
    """Hold a simulated arm near each of the poses (n, 3) rad, within some degrees, with its table taken away.

    Read again, it scatters anew.
    Returns: angles (n, 3) rad as a protractor shows them, to half a degree; counts (n, 3), means of half a second.
    """
    held, angles, counts = SimulatedArm(arm, replace(UNIT, table=-9.0)), [], []
    held.noise(4000 * next(_HANDS))
    for pose in poses:
        q = np.clip(pose + np.radians(2 * held.noise(1)[0]), arm.q_min, arm.q_max)
        held.place(q)
        angles.append(np.radians(np.rint(2 * np.degrees(q)) / 2))
        counts.append(np.mean([held.counts() for _ in range(50)], axis=0))
    return np.array(angles), np.array(counts)


def by_ruler(tip):
    """Return where a simulated ruler sees a tip (3,) m: in whole mm, and 1 mm (rms) off in each direction."""
    return np.round(tip + _RULER.normal(0, 0.001, 3), 3)


def counts_by_hand():
    """Return counts (3,), the mean of half a second without drive, while your hand carries the arm."""
    bench = connect(record_to=False)
    rows = [sample.counts for sample in bench.run(seconds=0.5, record=False)]
    bench.abort()  # a `with` would end in the rest pose: the arm would move under your hand
    return np.mean(rows, axis=0)


def error_bands(x, fit, at):
    """Draw lines from the uncertainty of a fit (slope, offset, covariance): with its diagonal, and with all of it.

    Args: x: (n,) counts, of the readings; at: counts at which the lines are used. Returns: LabFigure.
    """
    figure, *axes = subplots(9.0, 3.2, cols=2)
    ends = np.array([min(0, *x), max(x)])
    for ax, spread, title in zip(axes, (np.diag(np.diag(fit[2])), fit[2]), ("independent", "together"), strict=True):
        for slope, offset in np.random.default_rng(1).multivariate_normal((0, 0), spread, 40):
            ax.plot(ends, 1000 * (slope * ends + offset), color=COLOURS["grey"], lw=0.6)
        ax.axvline(at, **SETPOINT)
        ax.set(xlabel="counts", ylim=(-60, 60), title=f"slope and offset: {title}")
    axes[0].set_ylabel("off the fit [mrad]")
    return figure


def residuals(angles, left):
    """Plot residuals (n, 3) mrad over angles (n, 3) rad, each with a parabola that shows a bow. Returns: LabFigure."""
    figure, *axes = subplots(9.0, 2.9, cols=3)
    for ax, q, rest, label in zip(axes, angles.T, left.T, JOINT_LABELS, strict=True):
        ax.axhline(0, **SETPOINT)
        ax.plot(q, rest, "o", ms=4, color=COLOURS["grey"])
        ax.plot(*np.polynomial.Polynomial.fit(q, rest, 2).linspace(), color=COLOURS["orange"])
        ax.set(xlabel="angle [rad]", ylim=(-20, 20), title=label)
    axes[0].set_ylabel("protractor - line [mrad]")
    return figure
