"""Figures of notebook 13: what each step of signal processing brings, and whether residuals are white."""

import numpy as np
from matplotlib.mlab import detrend_mean

from ir50p_lab.course.draw.style import COLOURS, JOINT_LABELS, JOINTS, subplots


def ablation_figure(names, fits):
    """Draw fits of the three joints, (n, 3) %, from top to bottom, with one name for each line. Returns: LabFigure."""
    figure, ax = subplots(9.6, 1.3 + 0.36 * len(names))
    y = np.arange(len(names))[::-1]
    ax.set_prop_cycle(color=JOINTS, marker=["o", "s", "^"])
    ax.plot(fits, y, ms=7, lw=0.8, label=JOINT_LABELS)
    ax.set_yticks(y, names)
    ax.set(xlim=(min(50, np.min(fits) - 3), 101), xlabel="fit of the other motion [%]", title="From top to bottom")
    ax.legend(fontsize=8, loc="lower left")
    return figure


def whiteness_figure(residuals):
    """Draw the autocorrelation of the residuals of joint 2 for several models. Returns: LabFigure.

    Grey: 2.58/sqrt(n), within which 99 in 100 lie if the residuals are white. Args: residuals: {name: (n, 3)}, 10 ms
    apart.
    """
    figure, ax = subplots(9.0, 3.2)
    for name, left in residuals.items():
        ax.acorr(left[:, 1], detrend=detrend_mean, maxlags=50, usevlines=False, linestyle="-", marker=".", label=name)
    ax.axhspan(*np.array([-2.58, 2.58]) / np.sqrt(len(left)), color=COLOURS["grey"], alpha=0.3, lw=0, label="white")
    ax.set(xlim=(0, 50), xlabel="time between two residuals [samples of 10 ms]", ylabel="their correlation [1]")
    ax.set_title("Joint 2: outside the grey band, something is left to learn")
    ax.legend(fontsize=8)
    return figure
