"""One compiled step of Slotine and Li's adaptive control: a command from what is believed, then a better belief."""

from ir50p_lab.controllers import law
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf

# places in the parameter vector: those of `law` to THETA, what is believed at first, and then
LAMBDA, K, DEAD_BAND, GAMMA, LOWER, UPPER, N_PARAMETERS = law.KP, law.KD, 86, 89, 149, 209, 269
# places in the state vector, likewise; THETA: what is believed now, Y: the regressor of the last sample, (3, 20) each
SLIDE, THETA, Y, N_STATES = 26, 29, 89, 149


@jit()
def passive_regressor(gravity, q2, q3, qd, qd_r, qdd_r, signs, out):
    """Y (3, 20) with Y theta = M(q) qdd_r + C(q, qd) qd_r + g(q) + F(qd_r), C by Christoffel symbols; zeros stay.

    qd, qd_r, qdd_r and signs, what stands for sgn(qd), are tuples of three numbers.
    """
    a, b, c = qd
    ar, br, cr = qd_r
    A, B, C = qdd_r
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
    one[11], two[13], three[15] = signs
    one[16] = two[17] = three[18] = 1.0


@jit()
def adaptive_step(p, s, t, q, r, u):
    """One sample: reads parameters p, state s, time t, measured q (3,), reference r (3, 3); writes s and u (3,)."""
    dt = law.elapsed(p, s, t)
    learning = min(dt, 10 * p[law.PERIOD])
    if s[law.STARTED] == 0.0:
        s[THETA:Y] = p[law.THETA : law.N_PARAMETERS]
    law.measure_error(p, s, q, r, dt)
    for i in range(3):
        s[SLIDE + i] = s[law.SLOPE + i] + p[LAMBDA + i] * s[law.ERROR + i]
    e1, e2, e3 = s[law.ERROR], s[law.ERROR + 1], s[law.ERROR + 2]
    v1, v2, v3 = s[law.SLOPE], s[law.SLOPE + 1], s[law.SLOPE + 2]
    L1, L2, L3 = p[LAMBDA], p[LAMBDA + 1], p[LAMBDA + 2]
    a, b, c = r[1, 0], r[1, 1], r[1, 2]
    qd = a + v1, b + v2, c + v3
    qd_r = a - L1 * e1, b - L2 * e2, c - L3 * e3
    qdd_r = r[2, 0] - L1 * v1, r[2, 1] - L2 * v2, r[2, 2] - L3 * v3
    signs = law.soft_sign(a, p[law.SMOOTH]), law.soft_sign(b, p[law.SMOOTH + 1]), law.soft_sign(c, p[law.SMOOTH + 2])
    passive_regressor(p[law.GRAVITY], q[1], q[2], qd, qd_r, qdd_r, signs, s[Y:N_STATES].reshape((3, 20)))
    for i in range(3):
        slide = s[SLIDE + i]
        command = -p[K + i] * slide
        for k in range(20 * i, 20 * i + 20):
            command += s[Y + k] * s[THETA + k]
        u[i] = min(max(command, -p[law.LIMIT + i]), p[law.LIMIT + i])
        # small: noise, nothing to learn from; limited: the arm does not get what the law asked for
        if abs(slide) > p[DEAD_BAND + i] and abs(command) <= p[law.LIMIT + i]:
            for k in range(20 * i, 20 * i + 20):
                learnt = s[THETA + k] - learning * p[GAMMA + k] * s[Y + k] * slide
                s[THETA + k] = min(max(learnt, p[LOWER + k]), p[UPPER + k])
    s[law.TIME], s[law.STARTED] = t, 1.0
