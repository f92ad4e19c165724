"""Figures of notebook 10: what a bench measured, and what a simulation says where it is asked; each says which."""

from dataclasses import replace

import numpy as np

from ir50p_lab.bench import UNIT, SimulatedArm
from ir50p_lab.course.draw.arm3d import ArmView, SideView
from ir50p_lab.course.draw.style import COLOURS, JOINT_LABELS, JOINTS, SETPOINT, new_figure, origin, subplots
from ir50p_lab.course.draw.traces import Row, Traces
from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.signals import (
    alias,
    difference_velocity,
    kalman_velocity,
    low_pass_lag,
    low_pass_response,
    noise_and_lag,
)


def let_go_figure(arm, recording):
    """The arm from the side at the first and last sample of a run, and its angles over time. Returns: LabFigure.

    Args: arm: Arm; recording: Recording of a run without drive.
    """
    figure, side, angles = subplots(9.0, 3.8, cols=2, width_ratios=(1, 1.15), note=origin(recording))
    heading = recording.q[0, 0]
    for sample, colour, label in ((0, "blue", "first sample"), (-1, "orange", "last sample")):
        view = SideView(side, arm, colour=COLOURS[colour], label=label)
        view.update(recording.q[sample], heading=heading)
    side.legend(loc="upper left", fontsize=8, frameon=False)
    fallen = forward_kinematics(arm, recording.q[0])[2] - forward_kinematics(arm, recording.q[-1])[2]
    side.set_title(f"Nobody drives: the tip falls {100 * fallen:.0f} cm" if fallen > 0.02 else "It stays")
    angles.plot(recording.t, recording.q, label=JOINT_LABELS)
    angles.set(xlabel="t [s]", ylabel="angle [rad]", title="What the potentiometers say")
    angles.legend(fontsize=8)
    return figure


def breakaway_figure(recording):
    """A ramp of PWM counts at joint 1 and the angle that answers, up to the moment it moves. Returns: LabFigure."""
    figure, above, below = subplots(9.0, 3.6, rows=2, sharex=True, note=origin(recording))
    above.plot(recording.t, recording.u[:, 0], color=COLOURS["orange"], drawstyle="steps-post")
    below.plot(recording.t, recording.q[:, 0], ".", ms=3, color=COLOURS["grey"])
    for ax in figure.axes:
        ax.axvline(recording.t[-1], **SETPOINT)
    above.set(ylabel="command [PWM]", title=f"Joint 1 stays put until about {recording.u[-1, 0]:.0f} counts")
    below.set(ylabel="angle [rad]", xlabel="t [s]")
    return figure


def residual_figure(calibration):
    """What the calibration line leaves, in counts, over the angle, joint by joint. Returns: LabFigure.

    Args: calibration: JointCalibration with points.
    """
    figure = new_figure(9.6, 3.0, cols=3)
    for joint, (ax, residual) in enumerate(zip(figure.axes, calibration.residuals, strict=True)):
        q = np.array(calibration.points[joint][0])
        counts = residual * calibration.slope[joint]
        x, bow = np.polynomial.Polynomial.fit(q, counts, 2).linspace()
        ax.axhline(0, **SETPOINT)
        ax.plot(x, bow, color=COLOURS["orange"], linewidth=1.5)
        ax.plot(q, counts, "o", ms=4, color=COLOURS["grey"])
        ax.set(xlabel="angle [rad]", ylim=(-2.2, 2.2), title=f"joint {joint + 1}: bowed by {np.ptp(bow):.1f} counts")
    figure.axes[0].set_ylabel("angle read - line [counts]")
    return figure


def shannon_figure(rate_hz, cutoffs_hz, f_hz):
    """Low-pass responses up to half the rate (Figure 4.3), and a fast sine that its samples make slow.

    Args: rate_hz: samples per s; cutoffs_hz: legal ones, Hz; f_hz: of the sine, Hz. Returns: LabFigure.
    """
    figure, gain, sine = subplots(9.6, 3.4, cols=2)
    f = np.geomspace(rate_hz / 2000, 0.499 * rate_hz, 400)
    for cutoff in cutoffs_hz:
        gain.semilogx(f, np.abs(low_pass_response(cutoff, rate_hz, f)), label=f"{cutoff:g} Hz")
    gain.axvspan(rate_hz / 2, 400, color=COLOURS["light"])
    gain.text(rate_hz / 2 * 1.08, 0.06, "not in\nthe samples", fontsize=8)
    gain.plot([300], [np.sqrt(0.5)], "X", ms=9, color=COLOURS["orange"], label="printed: 300 Hz")
    gain.set(xlim=(0.2, 400), ylim=(0, 1.05), xlabel="frequency [Hz]", ylabel="gain [1]")
    gain.set_title(f"Samples end at {rate_hz / 2:g} Hz")
    gain.legend(fontsize=8, loc="lower left")
    t, k = np.linspace(0, 0.2, 4001), np.arange(0, 0.2 + 1e-9, 1 / rate_hz)
    sine.plot(t, np.sin(2 * np.pi * f_hz * t), color=COLOURS["light"], linewidth=0.8)
    sine.plot(k, np.sin(2 * np.pi * f_hz * k), "o-", ms=4, color=COLOURS["blue"], linewidth=1)
    sine.set(xlabel="t [s]", ylabel="signal [counts]")
    sine.set_title(f"{f_hz:g} Hz, sampled at {rate_hz:g} Hz: looks like {alias(f_hz, rate_hz):g} Hz")
    return figure


class FilterView:
    """Raw and filtered angle of joint 1 (Figure 4.4); beside it the velocity filters, noise against lag.

    Args:
        recording: Recording, sampled evenly; rest, moving: (s, s) where the joint stands, and where it goes and comes.

    Attributes: figure, for `live`; curve: list of NoiseAndLag, low passes from 0.8 to 30 Hz; kalman: three filters, for
    joints that are accelerated by 3, 10 and 30 rad/s^2.
    """

    def __init__(self, recording, *, rest, moving):
        t, self._q, self._rate = recording.t, recording.q[:, 0], round(1 / recording.period, 6)
        self._where = {"rest": (t > rest[0]) & (t < rest[1]), "motion": (t > moving[0]) & (t < moving[1])}
        # found once: a slider asks for the lag behind it at every step
        self._truth = difference_velocity(self._q, self._rate, cutoff_hz=3.0, order=2, kind="zero-phase")
        noise = max(float(self._q[self._where["rest"]].std()), 1e-4)
        kalman = (kalman_velocity(self._q, self._rate, noise=noise, change=change) for change in (3, 10, 30))
        self.kalman = [noise_and_lag(qd, self._truth, self._rate, **self._where) for qd in kalman]
        self.curve = [self._low_pass(cutoff) for cutoff in np.geomspace(0.8, 30, 12)]
        self.figure, angle, plane = subplots(9.6, 3.8, cols=2, width_ratios=(1.3, 1))
        self._t = t
        span = (moving[0] + 0.5, moving[0] + 2.5)  # the way there, and the turn
        q = self._q[(t >= span[0]) & (t <= span[1])]
        angle.plot(t, self._q, ".", ms=4, color=COLOURS["grey"])
        (self._line,) = angle.plot([], [], color=COLOURS["blue"])
        room = 0.08 * np.ptp(q)
        angle.set(xlim=span, ylim=(q.min() - room, q.max() + room), ylabel="angle of joint 1 [rad]")
        angle.set(xlabel=f"t [s]  -  {origin(recording)}", title="Dots: measured, line: filtered")
        for found, style, colour in ((self.curve, "-", "blue"), (self.kalman, "s", "orange")):
            x, y = [1e3 * one.lag for one in found], [one.noise for one in found]
            plane.loglog(x, y, style, color=COLOURS[colour])
        # texts, for a legend would be drawn anew at every step of the slider
        plane.text(
            1e3 * 1.12 * self.curve[-1].lag, self.curve[-1].noise, "low pass", color=COLOURS["blue"], va="center"
        )
        plane.text(0.88 * x[-1], y[-1], "Kalman", color=COLOURS["orange"], va="center", ha="right")
        (self._ring,) = plane.plot([], [], "o", ms=10, mfc="none", mec=COLOURS["blue"], mew=2.5)
        plane.set(xlabel="lag [ms]", ylabel="noise of the velocity [rad/s]", title="Less noise costs lag")
        plane.set_xticks([5, 10, 20, 50, 100, 200], ["5", "10", "20", "50", "100", "200"])
        plane.set_yticks([0.02, 0.05, 0.1, 0.2, 0.5, 1], ["0.02", "0.05", "0.1", "0.2", "0.5", "1"])
        plane.minorticks_off()

    def _low_pass(self, cutoff):
        qd = difference_velocity(self._q, self._rate, cutoff_hz=cutoff)
        return noise_and_lag(qd, self._truth, self._rate, **self._where)

    def update(self, filtered, cutoff):
        """Draw the filtered angle (n,) rad, mark the velocity filter of this cut-off (Hz). Returns it in words."""
        found = self._low_pass(cutoff)
        self._line.set_data(self._t, filtered)
        self._ring.set_data([1e3 * found.lag], [found.noise])
        late, lag = 1e3 * low_pass_lag(cutoff, self._rate), 1e3 * found.lag
        return f"angle: {late:.0f} ms late; velocity: {lag:.0f} ms late, {found.noise:.3f} rad/s rms at rest"


def stop_figure(goal, as_printed, let_go, held):
    """What three rules to stop do: joint 1 on the left, the last seconds of joint 2 on the right (Figure 4.7).

    Args: goal: (3,) rad; as_printed, let_go, held: Recordings of the same motion. Returns: LabFigure.
    """
    figure = new_figure(9.6, 4.4, rows=2, cols=2, sharex=True, note=origin(held))
    runs = (
        ((held, "blue", "|e|, command held"), (as_printed, "orange", "e < 0.01, as printed")),
        ((let_go, "orange", "|e|, let go"), (held, "blue", "|e|, command held")),
    )
    titles = "Joint 1: as printed it never starts", "Joint 2: let go, it drops and is caught"
    for joint, title in enumerate(titles):
        above, below = figure.axes[joint], figure.axes[2 + joint]
        above.axhline(goal[joint], **SETPOINT)
        for run, colour, label in runs[joint]:
            above.plot(run.t, run.q[:, joint], color=COLOURS[colour], lw=1.4, label=label)
            below.plot(run.t, run.u[:, joint], color=COLOURS[colour], lw=1, drawstyle="steps-post")
        above.set_title(title)
        above.legend(fontsize=8)
        below.set(xlabel="t [s]", ylim=(-275, 275))
    figure.axes[1].set(ylim=(goal[1] - 0.12, goal[1] + 0.12), xlim=(held.t[-1] - 5, held.t[-1]))
    figure.axes[0].set_ylabel("angle [rad]")
    figure.axes[2].set_ylabel("command [PWM]")
    return figure


def path_figure(arm, path, done, before):
    """The arm on a path in 3-D, wanted and done, and the tip over time (Figures 4.5, 4.9).

    Args: arm: Arm; path: CartesianPath; done, before: PathError; the second in thin lines only. Returns: LabFigure.
    """
    figure, space, over_time = subplots(9.6, 4.4, projection=["3d", None], cols=2, width_ratios=(1.2, 1))
    view = ArmView(space, arm, thickness=7)
    view.update(path.sample(np.array([path.duration]))[0, 0])
    view.trail(done.tip)
    space.plot(*done.wanted.T, color=COLOURS["dark"], linestyle="--", linewidth=1.2, zorder=28)
    space.set_title(f"Dashed: wanted; green: done, {done.rms_mm:.0f} mm rms")
    for axis, name in enumerate("xyz"):
        over_time.plot(before.t, before.tip[:, axis], color=JOINTS[axis], lw=0.8, alpha=0.7)
        over_time.plot(done.t, done.tip[:, axis], color=JOINTS[axis], lw=2, label=name)
        over_time.plot(done.t, done.wanted[:, axis], **SETPOINT)
    over_time.set(xlabel="t [s]", ylabel="position of the tip [m]")
    over_time.set_title(f"Thin: Tables 4.1-4.3, {before.rms_mm:.0f} mm rms")
    over_time.legend(fontsize=8, loc="center right")
    return figure


def one_joint(seconds, *, target, title):
    """Angle and command of joint 1 of a simulated run: Traces; `update(t, q, u)` draws (n,) s, rad, PWM counts."""
    angle = Row("angle of joint 1 [rad]", (-0.05 * target, 1.25 * target), levels=(target,))
    return Traces("time [s]", (0, seconds), angle, Row("command [PWM]", (-275, 275)), title=title)


def replay_figure(recording, replayed):
    """What was sent to joint 1 then, and what other gains would send for the same angles. Returns: LabFigure.

    Args: recording: Recording, with u; replayed: Recording of a ReplayBench.
    """
    figure, above, below = subplots(9.0, 3.8, rows=2, sharex=True, note=f"recorded: {origin(recording)}")
    above.plot(recording.t, recording.q[:, 0], color=COLOURS["dark"])
    above.set(ylabel="angle [rad]", title="Joint 1: the angles are past, the commands are new")
    for run, colour, label in ((replayed, "orange", "would be sent now"), (recording, "blue", "sent then")):
        below.plot(run.t, run.u[:, 0], color=COLOURS[colour], drawstyle="steps-post", lw=1, label=label)
    below.set(xlabel="t [s]", ylabel="command [PWM counts]", ylim=(-275, 275))
    below.legend(fontsize=8)
    return figure


def calibrate_by_hand(arm, points=61):
    """The calibration experiment on a simulated arm: a hand moves it through its travel, a protractor gives the angle.

    The protractor is read to half a degree, the counts are means of 16; the table is taken away, so that the whole
    travel is free. Returns: angles read (points, 3) rad, counts (points, 3), true slopes of this unit (3,) counts/rad.
    """
    held = SimulatedArm(arm, replace(UNIT, table=-9.0), seed=0)
    low, high = np.clip([arm.q_min, arm.q_max], -np.pi, np.pi)
    angles, counts = [], []
    for pose in np.linspace(0.97 * low, 0.97 * high, points):
        held.place(pose)
        counts.append(np.mean([held.counts() for _ in range(16)], axis=0))
        angles.append(np.radians(np.rint(2 * np.degrees(pose)) / 2))
    return np.array(angles), np.array(counts), held.nominal.slope * np.array(held.unit.pot_slope)
