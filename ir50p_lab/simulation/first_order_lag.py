"""A first-order lag with dead time, solved exactly for an input that changes in jumps."""

import numpy as np

from ir50p_lab.jit import jit

_SMALL = 1e-4  # below this a dt, series keep the digits that (1 - exp(-a dt))/a loses


@jit()
def respond(t, jump_times, jumps, a, L, out):
    """Solve x' = v(t - L) - a x exactly from x = 0, for a dead time L of any size (it need be no multiple of a period).

    v is the sum of the jumps so far. With a = 0 the lag integrates, with a < 0 it grows, with a complex a it swings.
    Fills out (n,), of the type of a, with x at the increasing times t (n,); jump_times (m,) also increase, and none is
    before t[0].
    """
    x, v, now, k = 0.0 * a, 0.0, t[0], 0
    for i in range(len(t)):
        while True:
            jump = k < len(jumps) and jump_times[k] + L <= t[i]
            dt = (jump_times[k] + L if jump else t[i]) - now
            z = a * dt
            gone = -np.expm1(-z)
            x = x * (1 - gone) + v * (dt * (1 - z / 2 + z * z / 6) if abs(z) < _SMALL else gone / a)
            now += dt
            if not jump:
                break
            v += jumps[k]
            k += 1
        out[i] = x
