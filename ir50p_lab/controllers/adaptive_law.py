"""One compiled step of Slotine and Li's adaptive control: a command from what is believed, then a better belief."""

import math

from ir50p_lab.controllers.model_law import soft_sign
from ir50p_lab.controllers.sampling import elapsed
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf

# places in the parameter vector
LAMBDA, K, LIMIT, PERIOD, FILTER_RATE, GRAVITY, DEAD_BAND, SMOOTH = 0, 3, 6, 9, 10, 11, 12, 15
GAMMA, LOWER, UPPER, FIRST_THETA, N_PARAMETERS = 18, 78, 138, 198, 258
# places in the state vector; Y: the regressor of the last sample, a row of 20 per joint
RATE, LAST, SLIDE, TIME, STARTED, THETA, Y, N_STATES = 0, 3, 6, 9, 10, 11, 71, 131


@jit()
def passive_regressor(gravity, q2, q3, a, b, c, ar, br, cr, A, B, C, s1, s2, s3, out):
    """Y (3, 20) with Y theta = M(q) qdd_r + C(q, qd) qd_r + g(q) + F(qd_r), C by Christoffel symbols; zeros stay.

    (a, b, c) velocity qd, (ar, br, cr) qd_r, (A, B, C) qdd_r, (s1, s2, s3) what stands for sgn(qd).
    """
    sin2, c2 = cf.sincos(q2)
    sin3, c3 = cf.sincos(q3)
    c23, sin23 = c2 * c3 - sin2 * sin3, sin2 * c3 + c2 * sin3
    mixed = sin23 * c2 + c23 * sin2
    one, two, three = out[0], out[1], out[2]
    one[0] = A
    one[1] = c2 * c2 * A - sin2 * c2 * (b * ar + a * br)
    two[1] = B + sin2 * c2 * a * ar
    one[4] = c23 * c23 * A - sin23 * c23 * ((b + c) * ar + a * (br + cr))
    two[4] = three[4] = B + C + sin23 * c23 * a * ar
    one[5] = 2 * c2 * c23 * A - mixed * (b * ar + a * br) - sin23 * c2 * (c * ar + a * cr)
    two[5] = 2 * c3 * B + c3 * C + mixed * a * ar - sin3 * (c * br + (b + c) * cr)
    three[5] = c3 * B + sin23 * c2 * a * ar + sin3 * b * br
    two[2] = gravity * c2
    two[3] = three[3] = gravity * c23
    one[6], one[7] = B, B + C
    two[6] = two[7] = three[7] = A
    two[8] = B
    two[9] = three[9] = B + C
    three[19] = C
    one[10], two[12], three[14] = ar, br, cr
    one[11], two[13], three[15] = s1, s2, s3
    one[16] = two[17] = three[18] = 1.0


@jit()
def adaptive_step(p, s, t, q, r, u):
    """One sample: reads parameters p, state s, time t, measured q (3,), reference r (3, 3); writes s and u (3,)."""
    dt = elapsed(s, TIME, STARTED, p[PERIOD], t)
    blend = 1.0 - math.exp(-p[FILTER_RATE] * dt)
    if s[STARTED] == 0.0:
        for k in range(60):
            s[THETA + k] = p[FIRST_THETA + k]
    for i in range(3):
        e = q[i] - r[0, i]
        if s[STARTED] > 0.0 and dt > 0.0:
            s[RATE + i] = cf.not_denormal(s[RATE + i] + blend * ((e - s[LAST + i]) / dt - s[RATE + i]))
        s[LAST + i] = e
        s[SLIDE + i] = s[RATE + i] + p[LAMBDA + i] * e
    e1, e2, e3 = s[LAST], s[LAST + 1], s[LAST + 2]
    v1, v2, v3 = s[RATE], s[RATE + 1], s[RATE + 2]
    L1, L2, L3 = p[LAMBDA], p[LAMBDA + 1], p[LAMBDA + 2]
    a, b, c = r[1, 0], r[1, 1], r[1, 2]
    rows = s[Y:N_STATES].reshape((3, 20))
    passive_regressor(
        p[GRAVITY],
        q[1],
        q[2],
        a + v1,
        b + v2,
        c + v3,
        a - L1 * e1,
        b - L2 * e2,
        c - L3 * e3,
        r[2, 0] - L1 * v1,
        r[2, 1] - L2 * v2,
        r[2, 2] - L3 * v3,
        soft_sign(a, p[SMOOTH]),
        soft_sign(b, p[SMOOTH + 1]),
        soft_sign(c, p[SMOOTH + 2]),
        rows,
    )
    for i in range(3):
        slide = s[SLIDE + i]
        command = -p[K + i] * slide
        for k in range(20 * i, 20 * i + 20):
            command += s[Y + k] * s[THETA + k]
        u[i] = min(max(command, -p[LIMIT + i]), p[LIMIT + i])
        # small: noise, nothing to learn from; limited: the arm does not get what the law asked for
        if abs(slide) > p[DEAD_BAND + i] and abs(command) <= p[LIMIT + i]:
            for k in range(20 * i, 20 * i + 20):
                learnt = s[THETA + k] - dt * p[GAMMA + k] * s[Y + k] * slide
                s[THETA + k] = min(max(learnt, p[LOWER + k]), p[UPPER + k])
    s[TIME], s[STARTED] = t, 1.0
