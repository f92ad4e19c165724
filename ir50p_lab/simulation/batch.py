"""Many gain sets at once: the sampled PID loop in lock step over lanes, so that one instruction serves several arms.

Only figures of merit come out, no trajectories; `simulate` gives those for a case worth a look. Smooth motion only.
"""

import math

import numpy as np

from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.simulation.plant import FV, GRAVITY, LIMIT, TF

LANES = 64  # enough independent work to fill the vector registers and hide the latency of every operation
METRICS = ("rms_error", "overshoot", "settling_time", "end_error", "peak_command")
_BAND = 0.02


@jit()
def _accelerations(theta, n, x, u, out):
    """Accelerations (3, W) of all lanes at states x (6, W) under u (3, W), for in-line arms (M12 = M13 = 0).

    A loop of its own without branches or stores that could alias: the compiler turns it into vector instructions.
    """
    for w in range(x.shape[1]):
        a, b, c = x[3, w], x[4, w], x[5, w]
        s2, c2 = cf.sincos(x[1, w])
        s3, c3 = cf.sincos(x[2, w])
        c23, s23 = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
        h1, h2, h3 = cf.coriolis_torques(theta, c2, s2, s3, c23, s23, a, b, c)
        g2, g3 = cf.gravity_torques(theta, n[GRAVITY], c2, c23)
        M11, _, _, _, M22, M23, _, M32, M33 = cf.mass_terms(theta, c2, c3, c23)
        r1 = u[0, w] - h1 - n[FV] * a - n[TF]
        r2 = u[1, w] - h2 - g2 - n[FV + 1] * b - n[TF + 1]
        r3 = u[2, w] - h3 - g3 - n[FV + 2] * c - n[TF + 2]
        once = 1.0 / (M22 * M33 - M23 * M32)
        out[0, w] = r1 / M11
        out[1, w] = (r2 * M33 - M23 * r3) * once
        out[2, w] = (M22 * r3 - r2 * M32) * once


@jit()
def _combine(x, y, k, dx, h, stage):
    """After a Runge-Kutta stage: add its rates (y's velocities, k) to dx, and put the next stage's state into y."""
    weight = 1.0 if stage == 0 or stage == 3 else 2.0
    ahead = 0.5 * h if stage < 2 else h
    for i in range(3):
        for w in range(x.shape[1]):
            v = y[3 + i, w]
            dx[i, w] += weight * v
            dx[3 + i, w] += weight * k[i, w]
            y[i, w] = x[i, w] + ahead * v
            y[3 + i, w] = x[3 + i, w] + ahead * k[i, w]


@jit(nogil=True)
def pid_batch(theta, n, kp, ki, kd, limit, period, filter_rate, r, x0, h, steps, out):
    """Run W = kp.shape[1] sampled PIDs; kp, ki, kd (3, W); r (samples, 3, 3); x0 (6,); out (5, 3, W) as METRICS.

    The law is that of `pid_step` (derivative on the measurement, anti-windup), written over lanes.
    """
    W = kp.shape[1]
    samples = r.shape[0]
    x, y, k = np.empty((6, W)), np.empty((6, W)), np.empty((3, W))
    dx, u = np.empty((6, W)), np.zeros((3, W))
    last, velocity, integral = np.empty((3, W)), np.zeros((3, W)), np.zeros((3, W))
    blend = 1.0 - math.exp(-filter_rate * period)
    out[:] = 0.0
    for i in range(6):
        for w in range(W):
            x[i, w] = x0[i]
    for i in range(3):
        for w in range(W):
            last[i, w] = x0[i]
    for sample in range(samples):
        for i in range(3):
            target, target_velocity = r[sample, 0, i], r[sample, 1, i]
            jump = r[samples - 1, 0, i] - x0[i]
            band, side = _BAND * abs(jump), 1.0 if jump >= 0 else -1.0
            bound = min(limit[i], n[LIMIT + i])
            time = sample * period
            for w in range(W):
                e = target - x[i, w]
                difference = (x[i, w] - last[i, w]) / period - velocity[i, w]
                velocity[i, w] = cf.not_denormal(velocity[i, w] + blend * difference)
                last[i, w] = x[i, w]
                without = kp[i, w] * e + kd[i, w] * (target_velocity - velocity[i, w])
                wound = integral[i, w] + ki[i, w] * e * period
                raw = without + wound
                rest = (abs(raw) > limit[i]) & (raw * e > 0.0)
                integral[i, w] = integral[i, w] if rest else wound
                raw = without + integral[i, w]
                u[i, w] = min(max(raw, -bound), bound)
                out[0, i, w] += e * e
                out[1, i, w] = max(out[1, i, w], -side * e)
                out[2, i, w] = time + period if abs(e) > band else out[2, i, w]
                out[3, i, w] = e
                out[4, i, w] = max(out[4, i, w], abs(u[i, w]))
        if sample + 1 == samples:
            break
        for _ in range(steps):
            for i in range(6):
                for w in range(W):
                    y[i, w] = x[i, w]
            dx[:] = 0.0
            for stage in range(4):
                _accelerations(theta, n, y, u, k)
                _combine(x, y, k, dx, h, stage)
            for i in range(6):
                for w in range(W):
                    x[i, w] += h / 6.0 * dx[i, w]
        for i in range(3, 6):
            for w in range(W):
                x[i, w] = cf.not_denormal(x[i, w])
    for i in range(3):
        for w in range(W):
            out[0, i, w] = math.sqrt(out[0, i, w] / samples)
