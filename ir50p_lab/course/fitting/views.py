"""Why an arm is recorded in closed loop, what that costs, and the motions that are kept with the course."""

from functools import lru_cache

import numpy as np

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.identification import load_excitations, optimise_excitation
from ir50p_lab.modelling import IR50P


def two_copies(arm, controller, reference, seconds=8):
    """Run a simulated copy of the arm, send its commands blindly to another copy, and control the other copy as well.

    Returns: three Recordings, in this order.
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

    Every load v comes back through the controller, so u and v are correlated. Least squares of y on u finds

        (b sigma_r^2 - sigma_v^2/K)/(sigma_r^2 + sigma_v^2),

    which is b if the set point r moves much, and -1/K, the controller's own slope, if it rests.

    Args: b: rad/s per PWM count; K: PWM counts per rad/s.
    """

    def __init__(self, b, K):
        self.b, self.K = float(b), float(K)
        shapes = np.random.default_rng(0).normal(size=(2, 250))
        shapes -= shapes.mean(axis=1, keepdims=True)
        shapes[1] -= shapes[0] * (shapes[0] @ shapes[1]) / (shapes[0] @ shapes[0])  # r and v: exactly uncorrelated
        self._r, self._v = shapes / shapes.std(axis=1, keepdims=True)

    def run(self, excitation):
        """Return r, u, y, (n,) each, for a set point of the rms `excitation` and a load of 0.1 (rad/s)."""
        r, v = excitation * self._r, 0.1 * self._v
        u = self.K * (r - v) / (1 + self.b * self.K)
        return r, u, self.b * u + v


@lru_cache(maxsize=20)
def kept_motion(arm, number=0):
    """Return a Fourier motion of 110 s: for identification (number 0), or another one for validation (1 to 20).

    An optimiser ends up elsewhere on another processor, so the IR50P has its motions in data/excitation_ir50p.json. For
    another arm they are optimised here, briefly.
    """
    if arm == IR50P:
        return load_excitations()[f"validation {number}" if number else "training"]
    speed = 0.8 * arm.actuators.no_load_speed
    # room at the limits and over the table: the thesis's PID lags and sags
    options = {"margin": 0.2, "table": 0.1, "standing": 6, "tries": 1000, "seed": number, "progress": False}
    return optimise_excitation(arm, harmonics=3, max_joint_speed=speed, **options).reference
