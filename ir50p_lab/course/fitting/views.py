"""Figures of notebook 12, first part: why feedback biases, and what a motion lets one see."""

import numpy as np

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.course.draw.style import COLOURS, JOINTS, SETPOINT, new_figure, subplots
from ir50p_lab.identification import load_excitations, optimise_excitation, regressor
from ir50p_lab.identification.parameters import ACTS_ON, NAMES, ONLY_THESIS
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals.fourier import series

NOISE_PWM, INDEPENDENT = 8.0, 1100  # assumed: what is left of u, and how many independent samples 110 s hold
_WATCHED = (  # joint, parameter, what it is, and its curve
    (0, "theta1", "inertia of joint 1", JOINTS[0], "-"),
    (1, "theta9", "inertia of joint 2", JOINTS[1], "-"),
    (2, "j3", "inertia of joint 3", JOINTS[2], "-"),
    (1, "theta3", "gravity of joint 2", COLOURS["grey"], "--"),
)


def two_copies(arm, controller, reference, seconds=8):
    """A run of one simulated copy of the arm; its commands sent blindly to another copy; the other copy controlled.

    Returns: three Recordings.
    """
    q0, runs = reference(0.0)[0], []
    for seed in (0, 1):
        with SimulatedBench(arm, seed=seed, q0=q0, record_to=False) as bench:
            runs.append(bench.follow(controller, reference, seconds))
    with SimulatedBench(arm, seed=1, q0=q0, record_to=False) as bench:
        for k, _ in enumerate(bench.run(seconds)):
            bench.drive(runs[0].u[k])  # nobody looks at the angles
        return runs[0], bench.recording, runs[1]


class FeedbackLoop:
    """The steady speed of a joint under a P controller and a load that nobody measures.

        y = b u + v,    u = K (r - y)    so    u = K (r - v)/(1 + b K)

    Every load v comes back through the controller: u and v are correlated. Least squares of y on u finds

        (b sigma_r^2 - sigma_v^2/K)/(sigma_r^2 + sigma_v^2),

    which is b where the set point r moves much, and -1/K, the controller's own slope, where it rests.

    Args: b: rad/s per PWM count; K: PWM counts per rad/s.
    """

    def __init__(self, b, K):
        self.b, self.K = float(b), float(K)
        shapes = np.random.default_rng(0).normal(size=(2, 250))
        shapes -= shapes.mean(axis=1, keepdims=True)
        shapes[1] -= shapes[0] * (shapes[0] @ shapes[1]) / (shapes[0] @ shapes[0])  # r and v: exactly uncorrelated
        self._r, self._v = shapes / shapes.std(axis=1, keepdims=True)

    def run(self, excitation):
        """r, u, y, (n,) each, with a set point of this rms and a load of 0.1 (rad/s)."""
        r, v = excitation * self._r, 0.1 * self._v
        u = self.K * (r - v) / (1 + self.b * self.K)
        return r, u, self.b * u + v


class FeedbackView:
    """The cloud (u, y) of a FeedbackLoop with the line of least squares. Attributes: figure."""

    def __init__(self, loop, largest):
        self.loop, self.figure = loop, new_figure(7.2, 4.0)
        ax = self.figure.axes[0]
        _, u, y = loop.run(largest)
        self._ends = 1.05 * np.abs(u).max() * np.array([-1, 1])
        (self._cloud,) = ax.plot([], [], ".", ms=4, color=COLOURS["grey"])
        ax.plot(self._ends, loop.b * self._ends, **SETPOINT)
        ax.plot(self._ends, -self._ends / loop.K, ":", color=COLOURS["green"])
        (self._line,) = ax.plot([], [], color=COLOURS["orange"], lw=2.5)
        height = 1.1 * np.abs(y).max()
        ax.set(xlim=self._ends, ylim=(-height, height), xlabel="command u [PWM]", ylabel="speed y [rad/s]")
        ax.set_title("Orange: least squares; little excitation: it finds the controller", fontsize=11)
        # texts, for a legend would be drawn anew at every step of the slider
        left = 0.97 * self._ends[0]
        ax.text(left, 0.85 * height, "dashed: the plant, slope b", color=COLOURS["dark"], fontsize=9)
        ax.text(left, 0.70 * height, "dotted: the controller, slope -1/K", color=COLOURS["green"], fontsize=9)

    def update(self, excitation):
        """Draw for a set point of this rms (rad/s). Returns the slopes in words."""
        r, u, y = self.loop.run(excitation)
        slope = (u @ y) / (u @ u)
        self._cloud.set_data(u, y)
        self._line.set_data(self._ends, slope * self._ends)
        by_instrument = f"; with r as instrument {(r @ y) / (r @ u):.4f}" if excitation > 0 else ""
        return f"least squares {slope:.4f}, true b = {self.loop.b:.4f} rad/s per count{by_instrument}"


def kept_motion(arm, number=0):
    """A Fourier motion of 110 s to identify from (number 0), or another one to validate with (1 to 20).

    An optimiser ends elsewhere on another processor, so the IR50P has its motions in data/excitation_ir50p.json. For
    another arm they are optimised here, briefly.
    """
    if arm == IR50P:
        return load_excitations()[f"validation {number}" if number else "training"]
    speed = 0.8 * arm.actuators.no_load_speed
    # room at the limits and over the table: the thesis' PID lags and sags
    options = {"margin": 0.2, "table": 0.1, "standing": 6, "tries": 1000, "seed": number, "progress": False}
    return optimise_excitation(arm, harmonics=3, max_joint_speed=speed, **options).reference


def relative_errors(arm, motion, frequency_hz, samples=300):
    """Standard errors to be expected, in % of the value, and the commands, when a motion is run at another speed.

    Assumed: 8 PWM counts of noise and 1100 independent samples. Args: arm: Arm with motors; motion: Fourier;
    frequency_hz: of its first harmonic. Returns: (4,) % for the parameters of `_WATCHED`; u (samples, 3) PWM counts.
    """
    period = 1 / frequency_hz
    t = period * (np.arange(samples) + 0.5) / samples
    rows = series(motion.a, motion.b, motion.q0, period, t)
    Phi, theta = regressor(rows[:, 0], rows[:, 1], rows[:, 2]), arm.theta_pwm
    percent = []
    for joint, name, *_ in _WATCHED:
        columns = [k for k in ACTS_ON[joint] if NAMES[k] not in ONLY_THESIS]
        inverse = np.linalg.pinv(Phi[:, joint, columns])  # lengths of its rows: sqrt of the diagonal of (A^T A)^-1
        k = NAMES.index(name)
        error = NOISE_PWM * np.linalg.norm(inverse[columns.index(k)]) * np.sqrt(samples / INDEPENDENT)
        percent.append(100 * error / abs(theta[joint, k]))
    return np.array(percent), np.einsum("nij,ij->ni", Phi, theta)


class FrequencyView:
    """Commands that a motion needs, and how sure it makes the parameters, over its frequency from 0.02 to 0.3 Hz.

    Args: arm: Arm with motors; motion: Fourier. Attributes: figure.
    """

    def __init__(self, arm, motion):
        self._arm, self._motion = arm, motion
        self.figure, left, right = subplots(9.6, 3.8, cols=2)
        for level in (-255, 255):
            left.axhline(level, **SETPOINT)
        self._u = left.plot((np.arange(300) + 0.5) / 300, np.zeros((300, 3)), lw=1.3)
        left.set(xlim=(0, 1), ylim=(-450, 450), xlabel="part of the period [1]", ylabel="command needed [PWM]")
        left.set_title("Dashed: all the motors have")
        f = np.geomspace(0.02, 0.3, 40)
        errors = np.array([relative_errors(arm, motion, x)[0] for x in f])
        for k, (_, name, what, colour, line) in enumerate(_WATCHED):
            right.loglog(f, errors[:, k], line, color=colour)
            place = {"xy": (0.97, 0.94 - 0.07 * k), "xycoords": "axes fraction", "ha": "right"}
            right.annotate(f"{what}: {name}", color=colour, fontsize=8, **place)
        self._mark = right.axvline(f[0], color=COLOURS["dark"], lw=1)
        right.set(xlabel="lowest frequency of the motion [Hz]", ylabel="standard error [% of the value]")
        right.set_xticks([0.02, 0.03, 0.05, 0.1, 0.2, 0.3], ["0.02", "0.03", "0.05", "0.1", "0.2", "0.3"])
        right.minorticks_off()
        right.set_title("Twice as fast: inertia four times as sure")

    def update(self, frequency):
        """Draw for this frequency, Hz. Returns what to mind, in words."""
        percent, u = relative_errors(self._arm, self._motion, frequency)
        for line, values in zip(self._u, u.T, strict=True):
            line.set_ydata(values)
        self._mark.set_xdata([frequency, frequency])
        inertia = ", ".join(f"{x:.1f}" for x in percent[:3])
        most = np.abs(u).max()
        end = "within reach" if most <= 255 else "out of reach: it would be cut off"
        return f"inertia known to {inertia} %; gravity to {percent[3]:.1f} %; largest command {most:.0f}: {end}"
