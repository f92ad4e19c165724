"""Closed loops, each compiled as a whole: sampled controllers (zero-order hold) and the continuous PID."""

import numpy as np

from ir50p_lab.controllers.law import law_step
from ir50p_lab.jit import jit
from ir50p_lab.simulation.integrators import acceleration, advance
from ir50p_lab.simulation.plant import LIMIT


@jit(nogil=True)
def sampled_loop(theta, n, p, s, t, r, x, late, h, steps, q, qd, u):
    """Run the loop of a computer: measure, compute, hold for `steps` steps of h seconds. Fills q, qd, u (n, 3).

    theta, n: the plant; p, s: the controller; t: (n,) s; r: reference (n, 3, 3); x: state (6,), which is changed. Each
    command acts `late` periods after its sample; before the first command acts, the command is zero.
    """
    measured, command, acting = np.empty(3), np.empty(3), np.zeros(3)
    for k in range(t.size):
        for i in range(3):
            measured[i] = x[i]
            q[k, i], qd[k, i] = x[i], x[3 + i]
        law_step(p, s, t[k], measured, r[k], command)
        for i in range(3):
            u[k, i] = min(max(command[i], -n[LIMIT + i]), n[LIMIT + i])
            acting[i] = u[k - late, i] if k >= late else 0.0
        if k + 1 < t.size:
            advance(theta, n, x, acting, h, steps)


@jit()
def _continuous_rate(theta, n, p, r, x, rate, u):
    """Rates of (q, qd, int e) (9,) and the command of the continuous PID p = (kp, ki, kd, limit) at reference r."""
    for i in range(3):
        e = r[0, i] - x[i]
        command = p[i] * e + p[3 + i] * x[6 + i] + p[6 + i] * (r[1, i] - x[3 + i])
        u[i] = min(max(command, -p[9 + i]), p[9 + i])
        wound = abs(command) > p[9 + i] and command * e > 0.0
        rate[i], rate[6 + i] = x[3 + i], 0.0 if wound else e
    A, B, C = acceleration(theta, n, x[1], x[2], x[3], x[4], x[5], u[0], u[1], u[2])
    rate[3], rate[4], rate[5] = A, B, C


@jit()
def continuous_loop(theta, n, p, r, x, h, steps, q, qd, u):
    """Run the continuous PID by Runge-Kutta; r (2 steps (n-1) + 1, 3, 3) is the reference at every half step.

    theta, n: the plant; p: the controller's parameters (12,); x: (q, qd, int e) (9,), which is changed; h: step, s.
    Fills q, qd, u (n, 3).
    """
    k1, k2, k3, k4 = np.empty(9), np.empty(9), np.empty(9), np.empty(9)
    command = np.empty(3)
    place = 0
    for k in range(q.shape[0]):
        _continuous_rate(theta, n, p, r[place], x, k1, command)
        for i in range(3):
            q[k, i], qd[k, i], u[k, i] = x[i], x[3 + i], command[i]
        if k + 1 == q.shape[0]:
            break
        for _ in range(steps):
            _continuous_rate(theta, n, p, r[place], x, k1, command)
            _continuous_rate(theta, n, p, r[place + 1], x + 0.5 * h * k1, k2, command)
            _continuous_rate(theta, n, p, r[place + 1], x + 0.5 * h * k2, k3, command)
            _continuous_rate(theta, n, p, r[place + 2], x + h * k3, k4, command)
            for i in range(9):
                x[i] += h / 6.0 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i])
            place += 2
