"""A recording in numbers and in a picture."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import RecordingError


@dataclass(frozen=True)
class JointSummary:
    """How one joint did in a run; angles in rad, u in PWM counts; NaN where the recording has no reference or u.

    joint: 1, 2, 3; start, final: angle first, and mean of the last second; error: last reference - final;
    overshoot: how far the angle went beyond the last reference, seen from the start; swing: largest minus smallest
    angle in the last 5 s (or the last half of a short run): hunting shows here; u_std: of the command, PWM counts.
    """

    joint: int
    start: float
    final: float
    error: float
    overshoot: float
    swing: float
    u_std: float


def summarise(recording):
    """List of three JointSummary of a Recording; RecordingError if it has no sample."""
    if not len(recording):
        raise RecordingError("the recording has no sample: run the bench first")
    t, q, r = recording.t, recording.q, recording.reference
    final = q[t > t[-1] - min(1.0, 0.5 * (t[-1] - t[0])) - 1e-9].mean(axis=0)
    swing = np.ptp(q[t > t[-1] - min(5.0, 0.5 * (t[-1] - t[0])) - 1e-9], axis=0)
    known = r[np.isfinite(r).all(axis=1)]
    target = known[-1] if len(known) else np.full(3, np.nan)
    way = target - q[0]
    beyond = np.maximum(0.0, ((q - target) * np.sign(way)).max(axis=0))
    overshoot = np.where(way == 0.0, np.nan, beyond)
    columns = (q[0], final, target - final, overshoot, swing, recording.u.std(axis=0))
    return [JointSummary(joint, *row) for joint, row in enumerate(np.transpose(columns).tolist(), 1)]


def plot(recording):
    """Angles and PWM of a Recording, one column per joint; RecordingError if it has no sample."""
    import matplotlib

    from ir50p_lab.lab_figure import LabFigure, figure_style

    dark, grey = "#333333", "#666666"
    joints = recording.metrics()
    with matplotlib.rc_context(figure_style()):
        figure = LabFigure(figsize=(9.0, 4.8), layout="constrained")
        colours = matplotlib.rcParams["axes.prop_cycle"].by_key()["color"]
        axes = figure.subplots(2, 3, sharex=True, sharey="row", height_ratios=(3, 2))
    t, known = recording.t, np.isfinite(recording.reference).any()
    for j, (above, below) in enumerate(axes.T):
        above.plot(t, recording.q[:, j], color=colours[j], linewidth=1.4, label="angle")
        if known:
            above.step(t, recording.reference[:, j], where="post", color=dark, ls="--", lw=1.2, label="set point")
        below.step(t, recording.u[:, j], where="post", color=colours[j], linewidth=0.8)
        for when, _ in recording.events:
            below.axvline(when, color=grey, ls=":", lw=1.0, label="event")
        off = joints[j].error
        said = f"joint {j + 1}" + ("" if math.isnan(off) else f" ends {1000 * abs(off):.0f} mrad off")
        above.set_title(said, fontsize=10.5, color=dark)
        below.set(ylim=(-275, 275), yticks=(-255, 0, 255), xlabel="t [s]")
    axes[0, 0].set_ylabel("angle [rad]")
    axes[1, 0].set_ylabel("u [PWM counts]")
    if known:
        axes[0, 0].legend(fontsize=9)
    if recording.events:
        axes[1, 0].legend(handles=axes[1, 0].get_lines()[1:2], fontsize=9)
    figure.suptitle(_origin(recording), fontsize=10, color=grey, parse_math=False)
    return figure


def _origin(recording):
    head = recording.header
    parts = [head.get("bench", "recording of unknown origin")]
    if recording.simulated:
        parts.append("simulated, not measured")
    parts += [head["date"][:16].replace("T", " ")] if "date" in head else []
    return "   |   ".join(parts)
