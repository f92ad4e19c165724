"""Curves over one common time axis."""

from ir50p_lab.course.draw.style import SETPOINT, subplots

STAMP = "simulated, not measured"


def curves(t, lines, labels, ylabel, targets=()):
    """Draw lines (k, n) over time (n,) s, each with its label. targets: dashed levels. Returns: LabFigure."""
    figure, ax = subplots(8.6, 3.2)
    for target in targets:
        ax.axhline(target, **SETPOINT)
    for values, label in zip(lines, labels, strict=True):
        ax.plot(t, values, label=label, alpha=0.35 if label == "raw" else 1)
    ax.set(xlabel="time [s]", ylabel=ylabel)
    ax.legend()
    return figure
