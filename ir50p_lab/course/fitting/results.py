"""Figures of notebook 13: what each step of signal processing brings, and whether residuals are white."""

import numpy as np

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


def whiteness_figure(tests):
    """Draw the autocorrelation of the residuals of joint 2 for several models. Returns: LabFigure.

    Args: tests: {name: Whiteness}, of residuals 10 ms apart.
    """
    figure, ax = subplots(9.0, 3.2)
    for (name, test), colour in zip(tests.items(), ("orange", "blue"), strict=False):
        lags = 10 * np.r_[0, test.lags]
        ax.plot(lags, np.r_[1, test.correlation[:, 1]], ".-", ms=4, color=COLOURS[colour], label=name)
    ax.axhspan(-test.bound, test.bound, color=COLOURS["grey"], alpha=0.4, lw=0)
    ax.set(xlabel="time between two residuals [ms]", ylabel="their correlation [1]", ylim=(-0.5, 1.05))
    ax.set_title("Joint 2: grey, as white noise would be; a model could still learn what is above")
    ax.legend(fontsize=8)
    return figure
