"""Figures of notebook 12, second part: what processing, delay, memory and a model bring, on recordings."""

import numpy as np

from ir50p_lab.bench import Recording, SimulatedBench
from ir50p_lab.course.draw.style import COLOURS, JOINT_LABELS, JOINTS, SETPOINT, new_figure, origin, subplots
from ir50p_lab.identification import RLS, fit, process, regressor, validate
from ir50p_lab.signals import LowPass


def learn(recording, *, rows="joint", columns="rigid", **steps):
    """An Estimate from a recording: `process` with these steps, then `fit` on the samples that are to be used."""
    motion = process(recording, **steps)
    Phi = regressor(motion.q, motion.qd, motion.qdd)
    return fit(Phi, motion.u, rows=rows, columns=columns, use=motion.use)


def as_the_thesis(arm, unit, motions, controller, seconds=(110, 60)):
    """Fit of the thesis' method on a simulated arm, (3,) %: trained on the first motion, validated on the second."""
    method, runs = {"derivatives": "causal", "cutoff_hz": 3.0}, []
    for motion, length in zip(motions, seconds, strict=True):
        bench = SimulatedBench(arm, unit=unit, q0=motion.q_start, record_to=False).open()
        runs.append(bench.follow(controller, motion, length))
    return validate(learn(runs[0], rows="shared", columns="thesis", **method), runs[1], **method).fit


def curved(recording, exponent):
    """A Recording as if counts were not proportional to volts: |u|/255 to the power of `exponent`, the sign kept."""
    u = 255 * np.sign(recording.u) * (np.abs(recording.u) / 255) ** exponent
    return Recording.from_arrays(recording.t, recording.q, u=u)


def bend(validation):
    """What u |u|/255 explains of the residuals beside a line, (3,) counts at 255: large for a curved driver."""
    found = []
    for u, residual in zip(validation.predicted.T, validation.residuals.T, strict=True):
        straight = np.column_stack([np.ones_like(u), u])
        curve = u * np.abs(u) / 255
        curve -= straight @ np.linalg.lstsq(straight, curve)[0]
        found.append(255 * (curve @ residual) / (curve @ curve))
    return np.array(found)


class OnlineSignals:
    """Regressor and command in step with each other, sample by sample, for a recursive estimate at the bench.

    Angles and commands pass the same causal low pass of second order, so that both are late by the same; velocity and
    acceleration are central differences, one sample later. The nonlinear columns see filtered angles, which is exact
    only for slow motion.

    At 100 Hz, with a cut-off of 2 Hz. A command acts two samples after its measurement. Below 0.05 rad/s a joint may
    stand: its row is then 0 = 0.
    """

    def __init__(self):
        self._filter = LowPass(2.0, 100, order=2)
        self._sent, self._past = [np.zeros(3)] * 3, []

    def step(self, q, u):
        """q (3,) rad of this sample, and u (3,) that is sent now. Returns Phi (3, 20) and y (3,), first zeros."""
        self._sent = [*self._sent[1:], np.array(u, dtype=float)]
        held = 0.5 * (self._sent[0] + self._sent[1])  # acts around this sample: held from one to the next
        self._past = [*self._past[-2:], self._filter.step(np.concatenate([q, held]))]
        if len(self._past) < 3:
            return np.zeros((3, 20)), np.zeros(3)
        before, here, after = self._past
        qd, qdd = (after - before)[:3] / 0.02, (after - 2 * here + before)[:3] / 0.01**2
        use = np.abs(qd) > 0.05
        return regressor(here[:3], qd, qdd) * use[:, None], here[3:] * use


def _fits_by_joint(ax, fits, names, **line):
    """Fits (n, 3) in %, from top to bottom, one name for each."""
    y = np.arange(len(names))[::-1]
    ax.set_prop_cycle(color=JOINTS, marker=["o", "s", "^"])
    ax.plot(fits, y, ms=7, label=JOINT_LABELS, **line)
    ax.set_yticks(y, names)
    ax.set_xlabel("fit on raw PWM of the validation run [%]")
    ax.legend(fontsize=8, loc="lower left")


def ablation_figure(names, fits, best=None):
    """Fits of the three joints, line by line of a table. Returns: LabFigure.

    Args: names: n texts; fits: (n, 3) %; best: (3,) %, what no theta passes, drawn dotted.
    """
    figure, ax = subplots(9.6, 1.3 + 0.36 * len(names))
    _fits_by_joint(ax, fits, names, lw=0.8)
    for value, colour in zip(() if best is None else best, JOINTS, strict=False):
        ax.axvline(value, color=colour, ls=":", lw=1.2)
    ax.set(xlim=(min(50, np.min(fits) - 3), 101), title="Most is won by better signals; dotted: true parameters")
    return figure


def estimators_figure(found, fits, truth=None):
    """Fits of several estimates, and their theta1 of joint 1 with three standard errors. Returns: LabFigure.

    Args: found: {name: Estimate}; fits: (n, 3) % on the validation run; truth: the parameter's value, drawn dashed.
    """
    figure, left, right = subplots(9.6, 1.3 + 0.32 * len(found), cols=2, width_ratios=(1.2, 1))
    _fits_by_joint(left, np.maximum(fits, 50), list(found), ls="")
    left.set(xlim=(49, 101), title="What each cure does for the fit")
    values = [one.theta[0, 0] for one in found.values()]
    errors = [3 * one.stderr[0, 0] for one in found.values()]
    right.errorbar(values, left.get_yticks(), xerr=errors, fmt="o", color=JOINTS[0], capsize=3)
    if truth is not None:
        right.axvline(truth, **SETPOINT)
    right.set_yticks(left.get_yticks(), [""] * len(found))
    right.set_ylim(left.get_ylim())
    right.set(
        xlabel="theta1 of joint 1, ± 3 standard errors [PWM, SI]", title="No error bar knows a bias; dashed: true"
    )
    return figure


def whiteness_figure(tests):
    """Autocorrelation of the residuals of joint 2 for several models. Returns: LabFigure.

    Args: tests: {name: Whiteness}, of residuals 10 ms apart.
    """
    figure, ax = subplots(9.0, 3.2)
    for (name, test), colour in zip(tests.items(), ("orange", "blue", "green"), strict=False):
        lags = 10 * np.r_[0, test.lags]
        ax.plot(lags, np.r_[1, test.correlation[:, 1]], ".-", ms=4, color=COLOURS[colour], label=name)
    ax.axhspan(-test.bound, test.bound, color=COLOURS["grey"], alpha=0.4, lw=0)
    ax.set(xlabel="time between two residuals [ms]", ylabel="their correlation [1]", ylim=(-0.5, 1.05))
    ax.set_title("Joint 2: grey, as white noise would be; what is above, a model could still learn")
    ax.legend(fontsize=8)
    return figure


class CutoffView:
    """Acceleration of joint 1 by two filters, and the fit of the model over their cut-off. Attributes: figure, fits.

    Args: train, valid: Recordings; cutoffs_hz: of the curves; delay: s; span: (s, s) of valid that is drawn.
    fits: {"causal" or "zero-phase": (m, 3) %}.
    """

    def __init__(self, train, valid, cutoffs_hz, *, delay, span):
        self._valid, self._f, self._span = valid.between(span[0] - 2, span[1] + 2), np.asarray(cutoffs_hz), span
        late = {"causal": 0.0, "zero-phase": delay}
        self.fits = {kind: np.array([self._fit(train, valid, kind, f, late[kind]) for f in self._f]) for kind in late}
        self.figure, left, right = subplots(9.6, 3.8, cols=2)
        self._lines = {
            "causal": left.plot([], [], color=COLOURS["orange"], lw=0.8)[0],
            "zero-phase": left.plot([], [], color=COLOURS["blue"], lw=1.8)[0],
        }
        left.set(xlim=span, ylim=(-5, 5), xlabel=f"t [s]  -  {origin(valid)}")
        left.set(ylabel="acceleration of joint 1 [rad/s²]", title="Orange: causal; blue: zero-phase")
        # a legend would be drawn anew at every step of the slider
        for kind, style in (("causal", "--"), ("zero-phase", "-")):
            right.set_prop_cycle(color=JOINTS)
            right.semilogx(self._f, self.fits[kind], style)
        for k, (label, colour) in enumerate(zip(JOINT_LABELS, JOINTS, strict=True)):
            right.text(0.03, 0.18 - 0.07 * k, label, color=colour, fontsize=9, transform=right.transAxes)
        self._mark = right.axvline(self._f[0], color=COLOURS["dark"], lw=1)
        right.set(xlabel="cut-off [Hz]", ylabel="fit [%]", ylim=(0, 100), title="Dashed: causal, line: zero-phase")
        right.set_xticks([0.5, 1, 2, 5, 10, 20], ["0.5", "1", "2", "5", "10", "20"])
        right.minorticks_off()

    @staticmethod
    def _fit(train, valid, kind, cutoff, delay):
        steps = {"derivatives": kind, "cutoff_hz": cutoff, "delay": delay}
        return validate(learn(train, slow=0.05, trim=1.0, **steps), valid, **steps).fit

    def update(self, cutoff):
        """Draw both accelerations for this cut-off, Hz. Returns the fits in words."""
        said = []
        for kind, line in self._lines.items():
            motion = process(self._valid, derivatives=kind, cutoff_hz=cutoff, trim=1.0)
            shown = (motion.t >= self._span[0]) & (motion.t <= self._span[1])
            line.set_data(motion.t[shown], motion.qdd[shown, 0].clip(-5.5, 5.5))
            values = [np.interp(np.log(cutoff), np.log(self._f), column) for column in self.fits[kind].T]
            said.append(f"{kind}: fit " + " / ".join(f"{x:.0f}" for x in values) + " %")
        self._mark.set_xdata([cutoff, cutoff])
        return "; ".join(said)


def delay_figure(found, true=None):
    """What is left of u over the delay that was assumed, for each joint, one picture per recording.

    Args: found: {name: DelayEstimate}; true: s, drawn dashed. Returns: LabFigure.
    """
    figure = new_figure(9.6, 3.2, cols=len(found))
    for ax, (name, estimate) in zip(figure.axes, found.items(), strict=True):
        ax.plot(1000 * estimate.delays, estimate.rms / estimate.rms.min(axis=0), label=JOINT_LABELS)
        if true is not None:
            ax.axvline(1000 * true, **SETPOINT)
        ax.set(xlabel="delay assumed [ms]", ylim=(0.99, 1.2))
        ax.set_title(f"{name}: {1000 * estimate.delay:.0f} ± {1000 * estimate.stderr:.0f} ms")
    figure.axes[0].set_ylabel("what is left of u, over its least [1]")
    figure.axes[0].legend(fontsize=8)
    return figure


def validation_figure(naive, best, span):
    """Measured and predicted commands of the three joints (Figure 4.11), two models. Returns: LabFigure.

    Args: naive, best: Validation; span: (s, s) that is drawn.
    """
    figure = new_figure(9.6, 5.4, rows=3, sharex=True)
    for joint, ax in enumerate(figure.axes):
        ax.plot(best.t, best.measured[:, joint], ".", ms=2.5, color=COLOURS["grey"], label="measured")
        ax.plot(naive.t, naive.predicted[:, joint], color=COLOURS["orange"], lw=0.9, label="as the thesis")
        ax.plot(best.t, best.predicted[:, joint], color=COLOURS["blue"], lw=1.8, label="this notebook")
        ax.set(xlim=span, ylim=(-275, 275), ylabel="u [PWM]")
        ax.set_title(f"joint {joint + 1}: fit {naive.fit[joint]:.0f} % and {best.fit[joint]:.0f} %", fontsize=10)
    figure.axes[0].legend(fontsize=8, ncols=3, loc="lower left")
    figure.axes[2].set_xlabel("t [s]")
    return figure


class ForgettingView:
    """theta4 of joint 3, followed by RLS while the arm gets a payload half way, for any memory. Attributes: figure.

    Args: parts: two Motions, without and with the payload; levels: its value by least squares on each part.
    """

    def __init__(self, parts, levels):
        Phi, y, every = [], [], 5
        for part in parts:
            use = part.use[::every]
            Phi.append(regressor(part.q[::every], part.qd[::every], part.qdd[::every]) * use[:, :, None])
            y.append(part.u[::every] * use)
        self._rate = parts[0].rate_hz / every
        first, second = (len(one) / self._rate for one in y)
        self._Phi, self._y = np.concatenate(Phi), np.concatenate(y)
        self._ends = np.arange(10, len(self._y), 10)  # a point of the curve for ten samples
        self._t = self._ends / self._rate
        self.figure, ax = subplots(9.0, 3.4)
        ax.hlines(levels, [0, first], [first, first + second], color=COLOURS["dark"], ls="--", lw=1.2)
        (self._line,) = ax.plot([], [], color=JOINTS[2])
        low, high = min(levels), max(levels)
        ax.set(xlim=(0, first + second), ylim=(low - 0.6 * (high - low), high + 0.6 * (high - low)))
        ax.set(xlabel="time of motion [s]", ylabel="theta4 of joint 3 [PWM, SI]")
        ax.set_title("Dashed: least squares before and after the payload")

    def run(self, memory):
        """theta4 at the times drawn, (n,), with a memory of so many seconds (inf: nothing is forgotten)."""
        filtered = RLS(forgetting=1 - 1 / (memory * self._rate))
        parts = ((self._Phi[k - 10 : k], self._y[k - 10 : k]) for k in self._ends)
        return np.array([filtered.run(*part, history=False)[2, 3] for part in parts])

    def update(self, memory):
        """Draw for this memory, s. Returns the forgetting factor in words."""
        self._line.set_data(self._t, self.run(memory))
        return f"forgetting factor {1 - 1 / (memory * self._rate):.4f} at {self._rate:.0f} samples a second"
