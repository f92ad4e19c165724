"""Notebooks 14 and 15: the map of robustness, the thesis's PID and model, and how late a joint is."""

import numpy as np
from matplotlib.colors import LogNorm

from ir50p_lab.controllers import PID
from ir50p_lab.course.draw.style import JOINTS, colour_map, subplots
from ir50p_lab.course.fitting.model_views import simulated
from ir50p_lab.course.fitting.views import kept_motion
from ir50p_lab.identification import fit, process, regressor


def thesis_pid():
    """Return the PID of Tables 4.1-4.3 behind a 3 Hz filter on the angles, in PWM counts."""
    gains = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30)}
    return PID(**gains, limit_pwm=255, position_filter_hz=3.0, filter_hz=np.inf)


def training_run(arm, *, seed=0):
    """Return a recording to identify from: the first motion of notebook 13, the thesis's PID, simulated."""
    return simulated(arm, thesis_pid(), kept_motion(arm), 110.0, seed=seed)


def naive_model(recording):
    """Return an Estimate made as in the thesis: causal 3 Hz, differences, one theta for all, least squares (4.4)."""
    motion = process(recording, derivatives="causal", cutoff_hz=3.0)
    return fit(regressor(motion.q, motion.qd, motion.qdd), motion.u, rows="shared", columns="thesis")


def lateness(t, angle, reference, *, joint):
    """Return how many seconds later than the reference a joint moves (negative: ahead): the shift that fits best.

    Args: t (n,) s, angle (n,) rad of the joint; reference; joint: 0, 1, 2. The first 3 s do not count.
    """
    later, here = np.arange(-0.2, 0.2, 0.002), (t > 3) & (t < t[-1] - 0.5)
    misses = [np.mean((angle[here] - reference.sample(t[here] - d)[:, 0, joint]) ** 2) for d in later]
    return later[np.argmin(misses)]


class RobustnessView:
    """Left: the largest RMS error over model scale and loop speed; right: the errors of one choice, joint by joint.

    Args: scales (m,): model over arm; speeds (n,): sqrt(Kp), rad/s; run: function (scale, speed) -> SimulationResult.
    Attributes: figure; rms (m, n) mrad, the largest of the three joints. `update(scale, speed)` draws one choice.
    """

    def __init__(self, scales, speeds, run, *, duration, error_max):
        self._run = run
        self.rms = np.array([[1e3 * run(s, w).rms_error.max() for w in speeds] for s in scales])
        self.figure, left, right = subplots(9.6, 3.8, cols=2, width_ratios=(1.25, 1))
        norm = LogNorm(max(self.rms.min(), 1e-3 * self.rms.max()), self.rms.max())
        self._mark = colour_map(left, speeds, scales, self.rms, norm, "largest RMS error [mrad]")
        left.set(xlabel="speed of the loop, sqrt(Kp) [rad/s]", ylabel="model / arm [1]")
        left.set_title("Fast loops hide wrong models")
        self._lines = [right.plot([], [], color=c)[0] for c in JOINTS]
        right.set(xlim=(0, duration), ylim=(-error_max, error_max))
        right.set(xlabel="time [s]  -  simulated", ylabel="q - q_ref [mrad]", title="Joints: blue, orange, green")

    def update(self, scale, speed):
        """Draw one choice. Returns the three RMS errors in words."""
        run = self._run(scale, speed)
        self._mark.set_data([speed], [scale])
        for j, line in enumerate(self._lines):
            line.set_data(run.t, -1e3 * run.error[:, j])
        return "RMS error: " + " / ".join(f"{x:.3g}" for x in 1e3 * run.rms_error) + " mrad"
