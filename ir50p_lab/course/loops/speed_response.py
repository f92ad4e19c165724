"""The speed of joint 1 when its counts jump, from which section 4 of 09 reads a small model. Simulated."""

import numpy as np

from ir50p_lab.controllers import PID
from ir50p_lab.simulation import simulate

_START, _JUMP, _END = -1.6, 1.0, 2.0  # rad; s: the joint stays between its stops
_SETTLED = 80  # samples after which the joint has reached its speed before the jump
_WIRE, _NOISE = 3, 0.01  # delay of the measured speed, samples; its noise, rad/s


class _OneJump:
    """Counts by hand for joint 1; the others hold their place."""

    unit = "PWM"

    def __init__(self, before, after):
        self.before, self.after = before, after
        self.others = PID((289, 225, 270), ki=50, kd=(40, 30, 30), limit_pwm=255)

    def step(self, t, q, reference):
        counts = self.before if t < _JUMP - 0.005 else self.after
        return [counts, *self.others.step(t, q, reference)[1:]]


def speed_jump(arm, before, after, *, seed):
    """Let joint 1 jump from `before` to `after` counts at 1 s: t (n,) s, counts (n,) and measured speed (n,) rad/s."""
    run = simulate(arm, _OneJump(before, after), q0=[_START, 0, 0], duration=_END)
    heard = np.concatenate([np.zeros(_WIRE), run.qd[:-_WIRE, 0]])
    noise = np.random.default_rng(seed).normal(0, _NOISE, len(heard))
    return run.t[_SETTLED:], run.u[_SETTLED:, 0], (heard + noise)[_SETTLED:]
