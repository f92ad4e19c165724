"""Whether a recording of a joint can be believed: what is meaningless is refused, all else is a warning."""

import math

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.columns import quantum_of, sampling_period

FEWEST = 40  # samples, ten for each of four parameters
_TURNS = 6 * math.pi  # rad: further than joints go, and a third of a radian in degrees
_SLOW_CLOCK = 0.15  # s: nobody samples a joint so slowly, many write milliseconds
_SPIKE = 0.05  # of the range, and 12 times the bends around it: one sample this far from both neighbours is an outlier
_LEAST = 3  # quanta, of an outlier: fewer are the flicker of a coarse signal


class Warnings(list):
    """Sentences; `refuse` raises IdentificationError, with them, unless `anyway`: then it adds its sentence too."""

    def __init__(self, anyway=False, who=""):
        self.anyway, self.who = anyway, who

    def add(self, sentence):
        """Another warning."""
        self.append(self.who + sentence)

    def refuse(self, sentence):
        """What makes the numbers meaningless."""
        if not self.anyway:
            raise IdentificationError(" Also: ".join([f"{self.who}{sentence} (anyway=True goes on)", *self]))
        self.add(f"gone on anyway: {sentence}")


def check_signals(warned, t, q, u):
    """What is wrong with q (n,) and u (n,) at the times t (n,) before any model."""
    if len(t) < FEWEST:
        warned.refuse(f"{len(t)} samples are too short a record; record {FEWEST} or more, over several reversals")
    for name, x in (("q", q), ("u", u)):
        if np.ptp(x) <= 1e-12 * np.abs(x).max():
            raise IdentificationError(f"{warned.who}{name} is constant at {x[0]:.6g}: check sensor, or drive harder")
        check_outliers(warned, name, t, x)
    step = np.abs(np.diff(q))
    for turn in (2 * math.pi, 360.0):
        if (jump := (np.abs(step - turn) < 0.1 * turn) & (step > 15 * np.median(step))).any():
            warned.refuse(
                f"a whole turn was wrapped at t = {t[1:][jump][0]:.6g} s: use np.unwrap(q, period={turn:.6g})"
            )
    share = 100 * np.isin(u, (u.min(), u.max())).mean()
    if share > 5 and len(np.unique(u)) > 16:  # fewer levels are switched, not clipped
        warned.add(f"u is at its largest or smallest value in {share:.0f} %: if clipped, record a wider range")
    if np.ptp(q) > _TURNS:
        warned.add(f"q spans {np.ptp(q):.4g} rad: is it in degrees? Use np.radians(q)")
    if (period := sampling_period(t)) > _SLOW_CLOCK:
        warned.add(f"one sample every {period:.4g} s: is t in ms or microseconds? Give seconds")


def check_outliers(warned, name, t, x, remedy="leave these samples out"):
    """A warning of samples of x (n,) that are far from both neighbours, which agree. Returns their indices.

    Lost counts, bad bytes; not torque ripple, where all neighbours are far from each other.
    """
    from scipy.ndimage import median_filter

    low, high = np.quantile(x, (0.02, 0.98))
    off = np.abs(x[1:-1] - (x[:-2] + x[2:]) / 2)
    around = np.maximum(median_filter(off, 41, mode="nearest"), np.median(off)) if len(off) else off
    far = off > np.maximum(max(_SPIKE * (high - low), _LEAST * quantum_of(x)), 12 * around)
    places = np.flatnonzero(far & (np.abs(x[2:] - x[:-2]) < 0.4 * off)) + 1
    if len(places):
        k = places[0]
        warned.add(f"{name} has {len(places)} outlier(s), the first at t = {t[k]:.6g} s, {x[k]:.4g}: {remedy}")
    return places
