"""One step of simulated time: Runge-Kutta for smooth motion, and a step that can stick for dry friction.

theta (3, 20) and n (33,) are the two arrays of a `Plant`.
"""

import math

from ir50p_lab.jit import jit, on_floats
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.simulation.plant import DRY, FC, FORCE_SCALE, FS, FV, GRAVITY, LENGTHS, Q_MAX, Q_MIN, QS, TABLE, TF


@jit(forceinline=True)
def acceleration(theta, n, q2, q3, a, b, c, u1, u2, u3):
    """Return the accelerations without dry friction: M^-1 (u - C qd - g - fv qd - Tf)."""
    s2, c2 = cf.sincos(q2)
    s3, c3 = cf.sincos(q3)
    c23, s23 = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
    h1, h2, h3 = cf.coriolis_torques(theta, c2, s2, s3, c23, s23, a, b, c)
    g2, g3 = cf.gravity_torques(theta, n[GRAVITY], c2, c23)
    r1 = u1 - h1 - n[FV + 0] * a - n[TF + 0]
    r2 = u2 - h2 - g2 - n[FV + 1] * b - n[TF + 1]
    r3 = u3 - h3 - g3 - n[FV + 2] * c - n[TF + 2]
    x1, x2, x3, _ = cf.solve_mass(cf.mass_terms(theta, c2, c3, c23), r1, r2, r3)
    return x1, x2, x3


@jit(forceinline=True)
def rk4_step(theta, n, q1, q2, q3, a, b, c, u1, u2, u3, h):
    """Take one classical Runge-Kutta step of h seconds with the command held; return q and qd, six scalars."""
    a1, b1, c1 = acceleration(theta, n, q2, q3, a, b, c, u1, u2, u3)
    k = 0.5 * h
    va, vb, vc = a + k * a1, b + k * b1, c + k * c1
    a2, b2, c2 = acceleration(theta, n, q2 + k * b, q3 + k * c, va, vb, vc, u1, u2, u3)
    wa, wb, wc = a + k * a2, b + k * b2, c + k * c2
    a3, b3, c3 = acceleration(theta, n, q2 + k * vb, q3 + k * vc, wa, wb, wc, u1, u2, u3)
    xa, xb, xc = a + h * a3, b + h * b3, c + h * c3
    a4, b4, c4 = acceleration(theta, n, q2 + h * wb, q3 + h * wc, xa, xb, xc, u1, u2, u3)
    w = h / 6.0
    q1 += w * (a + 2 * va + 2 * wa + xa)
    q2 += w * (b + 2 * vb + 2 * wb + xb)
    q3 += w * (c + 2 * vc + 2 * wc + xc)
    a += w * (a1 + 2 * a2 + 2 * a3 + a4)
    b += w * (b1 + 2 * b2 + 2 * b3 + b4)
    c += w * (c1 + 2 * c2 + 2 * c3 + c4)
    return q1, q2, q3, a, b, c


@jit()
def _slide(x, dry, A, lowest, highest):
    """Velocity from A v + dry friction = x: 0 while |x| <= dry, and within the end stops."""
    v = 0.0
    if x > dry:
        v = (x - dry) / A
    elif x < -dry:
        v = (x + dry) / A
    return lowest if v < lowest else highest if v > highest else v


@jit()
def dry_step(theta, n, q1, q2, q3, a, b, c, u1, u2, u3, h):
    """Take a step that can stick: Moreau's time stepping, which solves velocities and impulses together (Gauss-Seidel).

    (M + h fv) v+ = M v + h (u - C v - g - Tf) + impulses. Each dry-friction impulse is at most h F(v), and the end
    stops and the table can only repel. First order in h; a joint driven below breakaway does not move at all.
    """
    s2, c2 = cf.sincos(q2)
    s3, c3 = cf.sincos(q3)
    c23, s23 = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
    M11, M12, M13, M21, M22, M23, M31, M32, M33 = cf.mass_terms(theta, c2, c3, c23)
    h1, h2, h3 = cf.coriolis_torques(theta, c2, s2, s3, c23, s23, a, b, c)
    g2, g3 = cf.gravity_torques(theta, n[GRAVITY], c2, c23)
    r1 = M11 * a + M12 * b + M13 * c + h * (u1 - h1 - n[TF + 0])
    r2 = M21 * a + M22 * b + M23 * c + h * (u2 - h2 - g2 - n[TF + 1])
    r3 = M31 * a + M32 * b + M33 * c + h * (u3 - h3 - g3 - n[TF + 2])
    A11, A22, A33 = M11 + h * n[FV + 0], M22 + h * n[FV + 1], M33 + h * n[FV + 2]
    d1 = h * (n[FC + 0] + (n[FS + 0] - n[FC + 0]) * math.exp(-((a / n[QS + 0]) ** 2)))
    d2 = h * (n[FC + 1] + (n[FS + 1] - n[FC + 1]) * math.exp(-((b / n[QS + 1]) ** 2)))
    d3 = h * (n[FC + 2] + (n[FS + 2] - n[FC + 2]) * math.exp(-((c / n[QS + 2]) ** 2)))
    lo1, hi1 = (n[Q_MIN + 0] - q1) / h, (n[Q_MAX + 0] - q1) / h
    lo2, hi2 = (n[Q_MIN + 1] - q2) / h, (n[Q_MAX + 1] - q2) / h
    lo3, hi3 = (n[Q_MIN + 2] - q3) / h, (n[Q_MAX + 2] - q3) / h
    # table: height of the tip and its slope along joints 2 and 3
    l2, l3 = n[LENGTHS + 1], n[LENGTHS + 2]
    gap = n[LENGTHS] + l2 * s2 + l3 * s23 - n[TABLE]
    J2, J3 = l2 * c2 + l3 * c23, l3 * c23
    yield_ = J2 * J2 * n[FORCE_SCALE + 1] / A22 + J3 * J3 * n[FORCE_SCALE + 2] / A33
    push = 0.0
    for _ in range(200):
        v1 = _slide(r1 - M12 * b - M13 * c, d1, A11, lo1, hi1)
        v2 = _slide(r2 - M21 * v1 - M23 * c + J2 * n[FORCE_SCALE + 1] * push, d2, A22, lo2, hi2)
        v3 = _slide(r3 - M31 * v1 - M32 * v2 + J3 * n[FORCE_SCALE + 2] * push, d3, A33, lo3, hi3)
        change = abs(v1 - a) + abs(v2 - b) + abs(v3 - c)
        a, b, c = v1, v2, v3
        if gap < 0.1 and yield_ > 0.0:  # near the table only
            new = max(0.0, push - 0.5 * (J2 * b + J3 * c + gap / h) / yield_)
            change += abs(new - push)
            push = new
        if change < 1e-13:
            break
    return q1 + h * a, q2 + h * b, q3 + h * c, a, b, c


@on_floats
@jit()
def advance(theta, n, x, u, h, steps):
    """Advance the state x = (q, qd) (6,) by `steps` steps of h seconds with u (3,) held, within the drive's limits."""
    q1, q2, q3, a, b, c = x[0], x[1], x[2], x[3], x[4], x[5]
    u1, u2, u3 = u
    if n[DRY] > 0.0:
        for _ in range(steps):
            q1, q2, q3, a, b, c = dry_step(theta, n, q1, q2, q3, a, b, c, u1, u2, u3, h)
    else:
        for _ in range(steps):
            q1, q2, q3, a, b, c = rk4_step(theta, n, q1, q2, q3, a, b, c, u1, u2, u3, h)
    x[0], x[1], x[2] = q1, q2, q3
    x[3], x[4], x[5] = cf.not_denormal(a), cf.not_denormal(b), cf.not_denormal(c)
