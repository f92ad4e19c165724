"""What stands in for functions of 06 that have no task yet; plain NumPy."""

import numpy as np


def rk4_step(f, t, x, dt):
    """x after dt, (n,)."""
    k1 = f(t, x)
    k2 = f(t + dt / 2, x + dt / 2 * k1)
    k3 = f(t + dt / 2, x + dt / 2 * k2)
    k4 = f(t + dt, x + dt * k3)
    return x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def integrate(f, x0, duration, dt):
    """Times (k + 1,) and states (k + 1, n)."""
    t = dt * np.arange(round(duration / dt) + 1)
    x = [np.array(x0, dtype=float)]
    for now in t[:-1]:
        x.append(rk4_step(f, now, x[-1], dt))
    return t, np.array(x)


def quintic(q0, q1, duration, t):
    """Angles, speeds and accelerations of a smooth way."""
    s = np.clip(np.asarray(t, dtype=float) / duration, 0, 1)
    way = np.subtract(q1, q0)
    q = q0 + way * s**3 * (10 - 15 * s + 6 * s**2)
    qd = way / duration * 30 * s**2 * (1 - s) ** 2
    return q, qd, way / duration**2 * 60 * s * (1 - s) * (1 - 2 * s)
