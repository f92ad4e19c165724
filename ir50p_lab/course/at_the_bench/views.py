"""Figures of notebooks 10 and 11: what filters make of a recording, and what a replay sends for it."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, origin, subplots
from ir50p_lab.signals import difference_velocity, kalman_velocity, low_pass_lag, noise_and_lag


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
