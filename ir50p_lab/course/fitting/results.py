"""Figures of notebook 13: what each step of signal processing brings, and whether residuals are white."""

import numpy as np
from tqdm.auto import tqdm

from ir50p_lab.course.draw.style import COLOURS, JOINT_LABELS, JOINTS, origin, subplots
from ir50p_lab.identification import fit, process, regressor, validate


def ablation_figure(names, fits):
    """Draw fits of the three joints, (n, 3) %, from top to bottom, with one name for each line. Returns: LabFigure."""
    figure, ax = subplots(9.6, 1.3 + 0.36 * len(names))
    y = np.arange(len(names))[::-1]
    ax.set_prop_cycle(color=JOINTS, marker=["o", "s", "^"])
    ax.plot(fits, y, ms=7, lw=0.8, label=JOINT_LABELS)
    ax.set_yticks(y, names)
    ax.set(xlim=(min(50, np.min(fits) - 3), 101), xlabel="fit of the other motion [%]", title="From top to bottom")
    ax.legend(fontsize=8, loc="lower left")
    return figure


def whiteness_figure(tests):
    """Draw the autocorrelation of the residuals of joint 2 for several models. Returns: LabFigure.

    Args: tests: {name: Whiteness}, of residuals 10 ms apart.
    """
    figure, ax = subplots(9.0, 3.2)
    for (name, test), colour in zip(tests.items(), ("orange", "blue"), strict=False):
        lags = 10 * np.r_[0, test.lags]
        ax.plot(lags, np.r_[1, test.correlation[:, 1]], ".-", ms=4, color=COLOURS[colour], label=name)
    ax.axhspan(-test.bound, test.bound, color=COLOURS["grey"], alpha=0.4, lw=0)
    ax.set(xlabel="time between two residuals [ms]", ylabel="their correlation [1]", ylim=(-0.5, 1.05))
    ax.set_title("Joint 2: grey, as white noise would be; a model could still learn what is above")
    ax.legend(fontsize=8)
    return figure


class CutoffView:
    """The acceleration of joint 1 by two filters, and the fit of the model over their cut-off.

    Attributes: figure, fits.

    Args: train, valid: Recordings; cutoffs_hz: of the curves; delay: s; span: (s, s) of valid that is drawn.
    fits: {"causal" or "zero-phase": (m, 3) %}.
    """

    def __init__(self, train, valid, cutoffs_hz, *, delay, span):
        self._valid, self._f, self._span = valid.between(span[0] - 2, span[1] + 2), np.asarray(cutoffs_hz), span
        late = {"causal": 0.0, "zero-phase": delay}
        self.fits = {
            kind: np.array([self._fit(train, valid, kind, f, late[kind]) for f in tqdm(self._f, kind, leave=False)])
            for kind in late
        }
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
        motion = process(train, slow=0.05, trim=1.0, **steps)
        learnt = fit(regressor(motion.q, motion.qd, motion.qdd), motion.u, use=motion.use)
        return validate(learnt, valid, **steps).fit

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
