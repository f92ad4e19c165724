"""The laws that know the arm, as one compiled step: computed torque, feed-forward, gravity compensation.

Everything they share stands here once: error and its rate, prediction, integral, limits, change of gains.
"""

import math

from ir50p_lab.controllers.pid_law import FILTER_RATE, KD, KI, KP, LIMIT, PERIOD, POSITION_RATE
from ir50p_lab.controllers.sampling import elapsed
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf

LINEARISE, FEED_FORWARD, GRAVITY_ONLY = 0.0, 1.0, 2.0  # modes
# places in the parameter vector, after KP to POSITION_RATE
MODE, RATE_OF_ANGLE, REFERENCE_VELOCITY, DELAY, ANTI_WINDUP, FADE_RATE, GRAVITY = 15, 16, 17, 18, 19, 20, 21
DRY, SIGN_OF_MEASURED, SMOOTH, BREAKAWAY, QS = 22, 23, 24, 27, 30
THETA, N_PARAMETERS = 33, 93
# places in the state vector
INTEGRAL, RATE, LAST, ERROR, SLOPE, TIME, STARTED, FILTERED, BUMP, N_STATES = 0, 3, 6, 9, 12, 15, 16, 17, 20, 23


@jit()
def measure_error(p, s, t, q, r, dt):
    """Error e = q - q_ref and its rate into s[ERROR], s[SLOPE], each joint; the low pass has its memory in s[RATE]."""
    started = s[STARTED] > 0.0
    blend = 1.0 - math.exp(-p[FILTER_RATE] * dt)
    position_blend = 1.0 - math.exp(-p[POSITION_RATE] * dt)
    for i in range(3):
        y = q[i]
        if p[POSITION_RATE] > 0.0:
            if started:
                y = s[FILTERED + i] + position_blend * (q[i] - s[FILTERED + i])
            s[FILTERED + i] = y
        e = y - r[0, i]
        followed = y if p[RATE_OF_ANGLE] > 0.0 else e
        if started and dt > 0.0:
            rate = s[RATE + i] + blend * ((followed - s[LAST + i]) / dt - s[RATE + i])
            s[RATE + i] = cf.not_denormal(rate)
        s[LAST + i] = followed
        s[ERROR + i] = e
        s[SLOPE + i] = s[RATE + i] - r[1, i] if p[RATE_OF_ANGLE] > 0.0 else s[RATE + i]


@jit()
def soft_sign(x, smooth):
    """sgn x, but a line through zero of width about 2 smooth: what it is multiplied with does not chatter."""
    return math.tanh(x / smooth) if smooth > 0.0 else cf.sign(x)


@jit()
def dry_friction(p, fc, i, velocity):
    """Coulomb friction of joint i with the Stribeck rise near zero, smoothed    (1.115)-(1.117)."""
    if p[DRY] == 0.0:
        return 0.0
    rise = (p[BREAKAWAY + i] - fc) * math.exp(-((velocity / p[QS + i]) ** 2)) if p[DRY] == 2.0 else 0.0
    return (fc + rise) * soft_sign(velocity, p[SMOOTH + i])


@jit()
def model_command(p, s, r, dt, u):
    """The command before limits, into u: (2.19), or feed-forward or gravity with a PD beside it."""
    theta = p[THETA:N_PARAMETERS].reshape((3, 20))
    d = p[DELAY]
    # error, its rate and what they ask for, at the moment when the command acts
    e1, e2, e3 = s[ERROR] + d * s[SLOPE], s[ERROR + 1] + d * s[SLOPE + 1], s[ERROR + 2] + d * s[SLOPE + 2]
    w1 = -p[KD] * s[SLOPE] - p[KP] * e1 - s[INTEGRAL] - s[BUMP]
    w2 = -p[KD + 1] * s[SLOPE + 1] - p[KP + 1] * e2 - s[INTEGRAL + 1] - s[BUMP + 1]
    w3 = -p[KD + 2] * s[SLOPE + 2] - p[KP + 2] * e3 - s[INTEGRAL + 2] - s[BUMP + 2]
    # the reference then
    a, b, c = r[1, 0] + d * r[2, 0], r[1, 1] + d * r[2, 1], r[1, 2] + d * r[2, 2]
    q2 = r[0, 1] + d * (r[1, 1] + 0.5 * d * r[2, 1])
    q3 = r[0, 2] + d * (r[1, 2] + 0.5 * d * r[2, 2])
    sign1, sign2, sign3 = a, b, c
    if p[MODE] != FEED_FORWARD:
        q2, q3 = q2 + e2, q3 + e3
    if p[SIGN_OF_MEASURED] > 0.0:
        sign1, sign2, sign3 = a + s[SLOPE], b + s[SLOPE + 1], c + s[SLOPE + 2]
    if p[MODE] == LINEARISE and p[REFERENCE_VELOCITY] == 0.0:
        a, b, c = a + s[SLOPE], b + s[SLOPE + 1], c + s[SLOPE + 2]
    s2, c2 = cf.sincos(q2)
    s3, c3 = cf.sincos(q3)
    c23, s23 = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
    g2, g3 = cf.gravity_torques(theta, p[GRAVITY], c2, c23)
    u[0], u[1], u[2] = theta[0, 16], g2 + theta[1, 17], g3 + theta[2, 18]
    if p[MODE] == GRAVITY_ONLY:
        u[0] += w1
        u[1] += w2
        u[2] += w3
        return
    A, B, C = r[2, 0], r[2, 1], r[2, 2]
    if p[MODE] == LINEARISE:
        A, B, C = A + w1, B + w2, C + w3
    else:
        u[0] += w1
        u[1] += w2
        u[2] += w3
    h1, h2, h3 = cf.coriolis_torques(theta, c2, s2, s3, c23, s23, a, b, c)
    M11, M12, M13, M21, M22, M23, M31, M32, M33 = cf.mass_terms(theta, c2, c3, c23)
    u[0] += M11 * A + M12 * B + M13 * C + h1 + theta[0, 10] * a + dry_friction(p, theta[0, 11], 0, sign1)
    u[1] += M21 * A + M22 * B + M23 * C + h2 + theta[1, 12] * b + dry_friction(p, theta[1, 13], 1, sign2)
    u[2] += M31 * A + M32 * B + M33 * C + h3 + theta[2, 14] * c + dry_friction(p, theta[2, 15], 2, sign3)


@jit()
def model_step(p, s, t, q, r, u):
    """One sample: reads parameters p, state s, time t, measured q (3,), reference r (3, 3); writes s and u (3,)."""
    dt = elapsed(s, TIME, STARTED, p[PERIOD], t)
    measure_error(p, s, t, q, r, dt)
    fade = math.exp(-p[FADE_RATE] * dt)
    for i in range(3):
        s[INTEGRAL + i] += p[KI + i] * s[ERROR + i] * dt
        s[BUMP + i] = cf.not_denormal(fade * s[BUMP + i])
    model_command(p, s, r, dt, u)
    taken_back = False
    for i in range(3):
        # limited, and integrating on would only make it worse
        if p[ANTI_WINDUP] > 0.0 and p[KI + i] > 0.0 and abs(u[i]) > p[LIMIT + i] and u[i] * s[ERROR + i] < 0.0:
            s[INTEGRAL + i] -= p[KI + i] * s[ERROR + i] * dt
            taken_back = True
    if taken_back:
        model_command(p, s, r, dt, u)
    for i in range(3):
        u[i] = min(max(u[i], -p[LIMIT + i]), p[LIMIT + i])
    s[TIME], s[STARTED] = t, 1.0
