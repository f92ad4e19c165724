"""A simulated arm with something wrong at one joint, to stand behind a simulated bench or an emulated board."""

import numpy as np


class FaultyArm:
    """A SimulatedArm with one fault.

    fault at `joint` (0 to 2): "motor" or "pot": its two wires swapped; "stuck": its potentiometer is not coupled;
    "floating": its wire is torn; "broken": it reads 0; "unpowered": no current; "noisy"; "gap": the track ends in the
    middle of the travel; "bridges", "channels": those of `joint` and its neighbour swapped; None: all is well.
    """

    def __init__(self, plant, joint=0, fault=None, seed=0):
        self._plant, self._joint, self._fault = plant, joint, fault
        self._neighbour = (joint + 1) % 3
        self._rng, self._first = np.random.default_rng(seed), plant.counts()[joint]

    def __getattr__(self, name):
        return getattr(self._plant, name)

    def advance(self, pwm, seconds):
        pwm, j, k = np.array(pwm, dtype=float), self._joint, self._neighbour
        if self._fault == "motor":
            pwm[j] *= -1
        elif self._fault == "unpowered":
            pwm[j] = 0.0
        elif self._fault == "bridges":
            pwm[[j, k]] = pwm[[k, j]]
        self._plant.advance(pwm, seconds)

    def counts(self):
        counts, j, k = self._plant.counts(), self._joint, self._neighbour
        if self._fault == "channels":
            counts[[j, k]] = counts[[k, j]]
        wrong = {
            "pot": 1023 - counts[j],
            "stuck": np.rint(self._rng.normal(self._first, 0.5)),
            "floating": float(self._rng.integers(20, 1000)),
            "broken": 0.0,
            "noisy": np.rint(counts[j] + self._rng.normal(0, 25)),
            "gap": counts[j] if counts[j] < 500 else counts[j] - 450,
        }
        counts[j] = np.clip(wrong.get(self._fault, counts[j]), 0, 1023)
        return counts
