"""Figures of notebook 06: a step and its rates, energies, errors, a motion and its bill."""

from types import SimpleNamespace

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, JOINT_LABELS, SETPOINT, subplots
from ir50p_lab.course.draw.traces import STAMP


def motion(t, x, last=None):
    """Return a run of `integrate`, x (n, 6) over t (n,), up to a row, in the form that `LiveArm` plays."""
    return SimpleNamespace(t=t[:last], q=x[:last, :3], simulated=True)


def one_step():
    """Draw one step along a curve: by the rate at its start, and by the rate halfway. Returns: LabFigure."""
    figure, ax = subplots(7.5, 3.6)
    t = np.linspace(-0.15, 1.25, 100)
    ax.plot(t, np.exp(t), color=COLOURS["grey"], label="the curve, which nobody knows")
    ax.plot([0, 1], [1, 2], "o-", label="by the rate at the start: too low")
    ax.plot([0.25, 0.75], [1.125, 1.875], color=COLOURS["dark"], linewidth=3, label="the rate halfway, asked there")
    ax.plot([0, 1], [1, 2.5], "o-", color=COLOURS["orange"], label="by the rate halfway")
    ax.set(xlabel="time, in steps [1]", ylabel="x [1]", title="One step: which rate?")
    ax.legend(fontsize=9)
    return figure


def orders(steps, errors):
    """Draw errors (n,) of each method, {method: mm}, over steps (n,) s on logarithmic axes. Returns: LabFigure."""
    figure, ax = subplots(7.5, 3.6, note=STAMP)
    for name, error in errors.items():
        slope = np.polyfit(np.log(steps), np.log(error), 1)[0]
        ax.loglog(1000 * steps, error, "o-", label=f"{name}: slope {slope:.2f}")
    ax.set_xticks(1000 * steps, [f"{1000 * step:g}" for step in steps])
    ax.minorticks_off()
    ax.set(xlabel="step [ms]", ylabel="error of the tip [mm]", title="Half the step: how much less error?")
    ax.legend()
    return figure


def bill_panel():
    """What a motion asks of the motors: its figure, and update(seconds, shares (n, 3) of each motor's most)."""
    figure, ax = subplots(9.0, 3.4)
    lines = [ax.plot([], [], label=label)[0] for label in JOINT_LABELS]
    for level in (-1, 1):
        ax.axhline(level, **SETPOINT)
    ax.set(xlim=(0, 4), ylim=(-1.5, 1.5), xlabel=f"time [s]  -  {STAMP}", ylabel="share of most [1]", title=" ")
    ax.legend(loc="upper right", ncols=3, fontsize=9)

    def update(seconds, shares):
        for line, share in zip(lines, shares.T, strict=True):
            line.set_data(np.linspace(0, seconds, len(share)), share)
        ax.set_title(f"In {seconds:.2f} s: up to {100 * np.max(np.abs(shares)):.0f} % of what a motor can give")

    return figure, update


def honey(M):
    """Return four brakes, N m s/rad, each twice the one before: steps of 10 ms are too long for the last.

    M: (3, 3) kg m^2. The rates are the eigenvalues of M^-1 b; a step of dt is stable below 2.785 / rate.
    """
    limit = 2.785 / 0.01 / np.max(np.linalg.eigvals(np.linalg.solve(M, np.eye(3))).real)
    digit = 10.0 ** np.floor(np.log10(limit))
    return np.ceil(limit / digit) * digit * np.array([0.125, 0.25, 0.5, 1])
