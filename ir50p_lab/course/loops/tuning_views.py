"""Pictures for tuning: one joint over time, root loci."""

from itertools import pairwise

import numpy as np

from ir50p_lab.course import my_robot
from ir50p_lab.course.draw.drawings import drawing
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
    """Angle above, command below, of one joint (1, 2, 3) in several runs; the first's target dashed: LabFigure."""
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
    """The picture of `one_joint` under sliders: each place of them is a run with those gains. Returns: LivePanel.

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


def ruler():
    """The four figures of a step, drawn on a made-up one: SVG."""
    return drawing("ruler")


def speed_step(t, speed, fitted=None):
    """A measured answer of the speed (n,) rad/s to a jump at 1 s, and what was fitted to it: LabFigure."""
    figure, ax = subplots(8.0, 3.0)
    ax.plot(t, speed, ".", color=COLOURS["grey"], label="measured speed of joint 1")
    if fitted is not None:
        ax.plot(t, fitted, color=COLOURS["blue"], label="fitted: gain, time constant, dead time")
    ax.axvline(1.0, label="the counts jump", **SETPOINT)
    ax.set(xlim=(0.9, 1.8), xlabel="time [s]", ylabel="speed [rad/s]")
    ax.legend(fontsize=8, loc="lower right")
    return figure


class LocusView:
    """Root loci of the same loop in continuous time (s plane) and sampled (z plane, with the unit circle).

    Args: gains (n,), increasing; continuous, sampled: poles (n, k) for each gain (rad/s, and 1); zeros: of each of the
    two loops, where the paths end.

    Attributes: figure. `update(gain)` marks the poles of the nearest gain.
    """

    def __init__(self, gains, continuous, sampled, *, zeros):
        self.figure, left, right = subplots(9.6, 4.2, cols=2)
        self._gains, self._loci = gains, (continuous, sampled)
        turn = np.linspace(0, 2 * np.pi, 181)
        right.plot(np.cos(turn), np.sin(turn), **SETPOINT)
        right.set(xlim=(-1.6, 1.4), ylim=(-1.5, 1.5), aspect="equal", title="Sampled: beyond the circle it grows")
        right.set(xlabel="Re z [1]", ylabel="Im z [1]")
        left.axvline(0, **SETPOINT)
        left.set(title="Continuous: the poles never cross to the right", xlabel="Re s [1/s]", ylabel="Im s [1/s]")
        self._marks = []
        for ax, loci, ends in zip((left, right), self._loci, zeros, strict=True):
            path = _joined(loci)
            labels = ["path of the poles", *[None] * (path.shape[1] - 1)]
            ax.plot(path.real, path.imag, color=COLOURS["grey"], linewidth=1, label=labels)
            ax.plot(loci[0].real, loci[0].imag, "x", color=COLOURS["dark"], label="poles at the least gain")
            ax.plot(np.real(ends), np.imag(ends), "o", color=COLOURS["dark"], mfc="none", label="zeros")
            self._marks += ax.plot([], [], "o", color=COLOURS["orange"], ms=7, label="poles at this gain")
        left.legend(fontsize=8, loc="upper left")
        size = 1.1 * np.percentile(np.abs(self._loci[0]), 90)
        left.set(xlim=(-size, 0.25 * size), ylim=(-0.625 * size, 0.625 * size))

    def update(self, gain):
        """Mark the closed-loop poles of the gain nearest to `gain`."""
        k = int(np.argmin(np.abs(self._gains - gain)))
        for mark, loci in zip(self._marks, self._loci, strict=True):
            mark.set_data(loci[k].real, loci[k].imag)


def _joined(loci):
    """Loci (n, k) with the places where two branches meet between two gains: without them the paths have corners."""
    rows = [loci[0]]
    for here, there in pairwise(loci):
        met = (here.imag == 0) != (there.imag == 0)
        if met.sum() == 2:
            place = (here[met].real.mean() + there[met].real.mean()) / 2
            rows.append(np.where(met, place, (here + there) / 2))
        rows.append(there)
    return np.array(rows)
