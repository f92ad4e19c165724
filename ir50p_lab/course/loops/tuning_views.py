"""Pictures for tuning: one joint over time."""

import numpy as np

from ir50p_lab.course import my_robot
from ir50p_lab.course.draw.style import COLOURS, SETPOINT, subplots
from ir50p_lab.course.draw.widgets import live, slider

_RUNS = ({"color": COLOURS["blue"]}, {"color": COLOURS["orange"], "linewidth": 1.2}, {"color": COLOURS["green"]})


def three_columns(panel):
    """Arrange the sliders of a panel of `live` in three columns, one per joint. Returns the panel."""
    grid = panel.children[0]
    grid.layout.grid_template_columns = "max-content " * 3
    for control in panel.controls.values():
        control.layout.width = "190px"
    return panel


def one_joint(*runs, labels, joint, unit="PWM"):
    """Draw angle and command of one joint (1, 2, 3) in several runs; the first's target is dashed.

    Returns: LabFigure.
    """
    figure, above, below = subplots(9.0, 4.0, rows=2, sharex=True)
    reference = np.asarray(runs[0].reference)
    reference = reference[:, 0] if reference.ndim == 3 else reference
    above.plot(runs[0].t, reference[:, joint - 1], drawstyle="steps-post", label="target", **SETPOINT)
    for run, label, style in zip(runs, labels, _RUNS, strict=False):
        above.plot(run.t, run.q[:, joint - 1], label=label, **style)
        below.plot(run.t, run.u[:, joint - 1], drawstyle="steps-post", label=label, **style)
    above.set(ylabel=f"angle of joint {joint} [rad]")
    below.set(xlabel="time [s]", ylabel=f"command [{unit}]")
    above.legend(fontsize=8, loc="best")
    return figure


def tuning_panel(run_of, *, joint, **gains):
    """Return a LivePanel of `one_joint` under sliders: for each position of them a run with those gains.

    Args: run_of: f(**gains) -> SimulationResult; it runs the student's own PID. joint: 1, 2, 3. gains: name=(least,
    most, step, start).
    """
    figure = one_joint(run_of(**{name: start for name, (*_, start) in gains.items()}), labels=["now"], joint=joint)
    above, below = figure.axes

    def update(**now):
        run = run_of(**now)
        angle, push = run.q[:, joint - 1], run.u[:, joint - 1]
        above.lines[1].set_ydata(angle)
        below.lines[0].set_ydata(push)
        for ax in (above, below):
            ax.relim()
            ax.autoscale_view()
        past = np.max(-run.error[:, joint - 1])
        left = np.mean(run.error[-100:, joint - 1])
        moved = {"yours": "your PID", "on loan": "a PID on loan"}.get(my_robot.whose("PID"), "the course's PID")
        said = f"{moved}: {1000 * max(past, 0):.0f} mrad past its target, {1000 * left:+.0f} mrad short in the end"
        return f"{said}, trembles by {np.std(push[-100:]):.0f} counts (std)"

    return live(figure, update, **{name: slider(*row, label=f"K{name[1:]}") for name, row in gains.items()})


def speed_step(t, speed, fitted=None):
    """Draw a measured answer of the speed (n,) rad/s to a jump at 1 s, and what was fitted to it.

    Returns: LabFigure.
    """
    figure, ax = subplots(8.0, 3.0)
    ax.plot(t, speed, ".", color=COLOURS["grey"], label="measured speed of joint 1")
    if fitted is not None:
        ax.plot(t, fitted, color=COLOURS["blue"], label="fitted: gain, time constant, dead time")
    ax.axvline(1.0, label="the counts jump", **SETPOINT)
    ax.set(xlim=(0.9, 1.8), xlabel="time [s]", ylabel="speed [rad/s]")
    ax.legend(fontsize=8, loc="lower right")
    return figure
