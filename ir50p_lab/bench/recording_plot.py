"""A recording in numbers and in a picture."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import RecordingError


@dataclass(frozen=True)
class JointSummary:
    """How one joint did in a run; angles in rad, u in PWM counts; NaN where the recording has no reference or u.

    joint: 1, 2, 3; start, final: angle first, and mean of the last second; target: last reference;
    error: target - final; overshoot: how far the angle went beyond the last reference, seen from the start;
    swing: largest minus smallest angle in the last 5 s (or the last half of a short run): hunting shows here;
    rms_error: of reference - q over the run; saturated: share of the run with |u| = 255; u_std: PWM counts.
    """

    joint: int
    start: float
    final: float
    target: float
    error: float
    overshoot: float
    swing: float
    rms_error: float
    saturated: float
    u_std: float


def summarise(recording):
    """List of three JointSummary of a Recording; RecordingError if it has no sample."""
    if not len(recording):
        raise RecordingError("the recording has no sample: run the bench first")
    t, q, u, r = recording.t, recording.q, recording.u, recording.reference
    last = t > t[-1] - min(1.0, 0.5 * (t[-1] - t[0])) - 1e-9
    late = t > t[-1] - min(5.0, 0.5 * (t[-1] - t[0])) - 1e-9
    found = []
    for j in range(3):
        y, target = q[:, j], _last_known(r[:, j])
        final = float(y[last].mean())
        way = target - y[0]
        error = r[:, j] - y
        known = np.isfinite(error)
        found.append(
            JointSummary(
                joint=j + 1,
                start=float(y[0]),
                final=final,
                target=target,
                error=target - final,
                overshoot=max(0.0, float(((y - target) * np.sign(way)).max())) if abs(way) > 0 else math.nan,
                swing=float(np.ptp(y[late])),
                rms_error=float(np.sqrt(np.mean(error[known] ** 2))) if known.any() else math.nan,
                saturated=float(np.mean(np.abs(u[:, j]) >= 255)) if np.isfinite(u[:, j]).any() else math.nan,
                u_std=float(np.nanstd(u[:, j])) if np.isfinite(u[:, j]).any() else math.nan,
            )
        )
    return found


def _last_known(values):
    known = values[np.isfinite(values)]
    return float(known[-1]) if len(known) else math.nan


def plot(recording):
    """Angles and PWM of a Recording, one column per joint; RecordingError if it has no sample."""
    import matplotlib

    from ir50p_lab.lab_figure import COLOURS, LabFigure, figure_style

    colours, dark, grey = [COLOURS[name] for name in ("blue", "orange", "green")], COLOURS["dark"], "#666666"
    joints = recording.metrics()
    with matplotlib.rc_context(figure_style()):
        figure = LabFigure(figsize=(9.0, 4.8), layout="constrained")
        axes = figure.subplots(2, 3, sharex=True, sharey="row", height_ratios=(3, 2))
    t, known = recording.t, np.isfinite(recording.reference).any()
    for j, (above, below) in enumerate(axes.T):
        above.plot(t, recording.q[:, j], color=colours[j], linewidth=1.4, label="angle")
        if known:
            above.step(t, recording.reference[:, j], where="post", color=dark, ls="--", lw=1.2, label="set point")
        below.step(t, recording.u[:, j], where="post", color=colours[j], linewidth=0.8)
        for when, _ in recording.events:
            below.axvline(when, color=grey, ls=":", lw=1.0, label="event")
        above.set_title(_finding(joints[j]), fontsize=10.5, color=dark)
        below.set(ylim=(-275, 275), yticks=(-255, 0, 255), xlabel="t [s]")
    axes[0, 0].set_ylabel("angle [rad]")
    axes[1, 0].set_ylabel("u [PWM counts]")
    if known:
        axes[0, 0].legend(fontsize=9)
    if recording.events:
        axes[1, 0].legend(handles=axes[1, 0].get_lines()[1:2], fontsize=9)
    figure.suptitle(_origin(recording), fontsize=10, color=grey, parse_math=False)
    return figure


def _finding(joint):
    if math.isnan(joint.error):
        return f"joint {joint.joint}"
    return f"joint {joint.joint} ends {1000 * abs(joint.error):.0f} mrad off"


def _origin(recording):
    head = recording.header
    parts = [head.get("bench", "recording of unknown origin")]
    if recording.simulated:
        parts.append("simulated, not measured")
    parts += [head["date"][:16].replace("T", " ")] if "date" in head else []
    return "   |   ".join(parts)
