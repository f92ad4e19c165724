"""Many gain sets at once: the sampled PID loop in lock step over lanes, so that one instruction serves several arms.

Only figures of merit come out, no trajectories; `simulate` gives those for a case worth a look. Smooth motion only.
"""

import math

import numpy as np
from numba import types
from numba.extending import intrinsic

from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.simulation.plant import LIMIT
from ir50p_lab.simulation.steps import rk4_step

LANES = 32  # several vector registers; a number that the compiler knows, or it does not vectorise
METRICS = ("rms_error", "overshoot", "settling_time", "end_error", "peak_command", "saturated_time", "top_speed")
_BAND = 0.02


@intrinsic
def _use_widest_registers(_):
    """Let the loops of the calling function fill registers of 512 bits, where there are: by default LLVM uses half."""

    def emit(context, builder, *_):
        builder.function.attributes.update(['"prefer-vector-width"="512"'])
        return context.get_dummy_value()

    return types.void(), emit


@jit(nogil=True)
def pid_batch(theta, n, kp, ki, kd, limit, period, filter_rate, r, x0, h, steps):
    """Run LANES sampled PIDs; kp, ki, kd (3, LANES); r (samples, 3, 3); x0 (6,). Returns METRICS (7, 3, LANES).

    The law is that of `law_step` (derivative on the measurement, anti-windup), written over lanes; the motion is that
    of `rk4_step`. Every loop over the lanes is free of branches: the compiler turns it into vector instructions.
    """
    _use_widest_registers()
    samples = r.shape[0]
    kp, ki, kd = kp.copy(), ki.copy(), kd.copy()  # of arrays made here the compiler knows that they do not overlap
    out = np.zeros((len(METRICS), 3, LANES))
    x, u = np.empty((6, LANES)), np.zeros((3, LANES))
    last, velocity, integral = np.empty((3, LANES)), np.zeros((3, LANES)), np.zeros((3, LANES))
    blend = 1.0 - math.exp(-filter_rate * period)
    x[:] = x0.reshape((6, 1))
    last[:] = x[:3]
    for sample in range(samples):
        for i in range(3):
            target, target_velocity = r[sample, 0, i], r[sample, 1, i]
            jump = r[samples - 1, 0, i] - x0[i]
            band, side = _BAND * abs(jump), 1.0 if jump >= 0 else -1.0
            bound = min(limit[i], n[LIMIT + i])
            time = sample * period
            for w in range(LANES):
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
                out[5, i, w] += period if abs(u[i, w]) >= bound else 0.0
                out[6, i, w] = max(out[6, i, w], abs(x[3 + i, w]))
        for _ in range(steps):
            for w in range(LANES):
                q1, q2, q3, a, b, c = x[0, w], x[1, w], x[2, w], x[3, w], x[4, w], x[5, w]
                u1, u2, u3 = u[0, w], u[1, w], u[2, w]
                q1, q2, q3, a, b, c = rk4_step(cf.solve_in_line, theta, n, q1, q2, q3, a, b, c, u1, u2, u3, h)
                x[0, w], x[1, w], x[2, w], x[3, w], x[4, w], x[5, w] = q1, q2, q3, a, b, c
        for i in range(3, 6):
            for w in range(LANES):
                x[i, w] = cf.not_denormal(x[i, w])
    out[0] = np.sqrt(out[0] / samples)
    return out
