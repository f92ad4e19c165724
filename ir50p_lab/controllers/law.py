"""The sampled laws as one compiled step: PID and computed torque.

Error and rate, prediction, integral and limits are the same for both. What is the command of the PID is, for computed
torque, an acceleration, which a model of the arm turns into the command. The error is e = q - q_ref throughout.
"""

import math

from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf

PID, LINEARISE = 0.0, 1.0  # modes
# places in the parameter vector
KP, KI, KD, LIMIT, PERIOD, FILTER_RATE, POSITION_RATE, RATE_OF_ANGLE, ANTI_WINDUP = 0, 3, 6, 9, 12, 13, 14, 15, 16
MODE, DELAY, GRAVITY = 17, 18, 19
SMOOTH, THETA, N_PARAMETERS = 20, 23, 83
# places in the state vector; GROWTH: of the integral, now
INTEGRAL, RATE, LAST, ERROR, SLOPE, TIME, STARTED, FILTERED = 0, 3, 6, 9, 12, 15, 16, 17
GROWTH, N_STATES = 20, 23


@jit()
def elapsed(p, s, t):
    """Return the time since the last sample, s: the period, or the true length of a cycle that was late or early."""
    dt = p[PERIOD]
    if s[STARTED] > 0.0 and abs(t - s[TIME] - dt) > 1e-6 * dt:
        dt = max(t - s[TIME], 0.0)
    return dt


@jit()
def measure_error(p, s, q, r, dt):
    """Write each joint's error e = q - q_ref into s[ERROR], its rate into s[SLOPE]; the low pass keeps s[RATE]."""
    started = s[STARTED] > 0.0
    blend = 1.0 - math.exp(-p[FILTER_RATE] * dt)
    position_blend = 1.0 - math.exp(-p[POSITION_RATE] * dt) if p[POSITION_RATE] > 0.0 else 1.0
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
    """Return sgn x with a line through zero of width about 2 smooth, so that a product with it does not chatter."""
    return math.tanh(x / smooth) if smooth > 0.0 else cf.sign(x)


@jit()
def error_ahead(p, s, i):
    """Return the error of joint i at the moment when the command acts."""
    return s[ERROR + i] + p[DELAY] * s[SLOPE + i]


@jit()
def through_model(p, s, r, u):
    """Turn the acceleration in u, which the error asks for, into the command before limits: inverse dynamics (2.19)."""
    theta = p[THETA : THETA + 60].reshape((3, 20))
    d = p[DELAY]
    # the reference when the command acts
    a, b, c = r[1, 0] + d * r[2, 0], r[1, 1] + d * r[2, 1], r[1, 2] + d * r[2, 2]
    q2 = r[0, 1] + d * (r[1, 1] + 0.5 * d * r[2, 1]) + error_ahead(p, s, 1)
    q3 = r[0, 2] + d * (r[1, 2] + 0.5 * d * r[2, 2]) + error_ahead(p, s, 2)
    A, B, C = r[2, 0] + u[0], r[2, 1] + u[1], r[2, 2] + u[2]
    dry1, dry2, dry3 = soft_sign(a, p[SMOOTH]), soft_sign(b, p[SMOOTH + 1]), soft_sign(c, p[SMOOTH + 2])
    a, b, c = a + s[SLOPE], b + s[SLOPE + 1], c + s[SLOPE + 2]
    s2, c2 = cf.sincos(q2)
    s3, c3 = cf.sincos(q3)
    c23, s23 = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
    g2, g3 = cf.gravity_torques(theta, p[GRAVITY], c2, c23)
    h1, h2, h3 = cf.coriolis_torques(theta, c2, s2, s3, c23, s23, a, b, c)
    M11, M12, M13, M21, M22, M23, M31, M32, M33 = cf.mass_terms(theta, c2, c3, c23)
    u[0] = M11 * A + M12 * B + M13 * C + h1 + theta[0, 10] * a + theta[0, 11] * dry1 + theta[0, 16]
    u[1] = M21 * A + M22 * B + M23 * C + h2 + theta[1, 12] * b + theta[1, 13] * dry2 + theta[1, 17] + g2
    u[2] = M31 * A + M32 * B + M33 * C + h3 + theta[2, 14] * c + theta[2, 15] * dry3 + theta[2, 18] + g3


@jit()
def command(p, s, r, u):
    """Write the command before limits into u."""
    for i in range(3):
        proportional = p[KD + i] * s[SLOPE + i] + p[KP + i] * error_ahead(p, s, i)
        u[i] = -proportional - (s[INTEGRAL + i] + s[GROWTH + i])
    if p[MODE] == LINEARISE:
        through_model(p, s, r, u)


@jit()
def law_step(p, s, t, q, r, u):
    """Take one sample: parameters p, state s, time t, measured q (3,), reference r (3, 3).

    Updates s and fills u (3,).
    """
    dt = elapsed(p, s, t)
    measure_error(p, s, q, r, dt)
    for i in range(3):
        s[GROWTH + i] = p[KI + i] * s[ERROR + i] * min(dt, 10 * p[PERIOD])  # what happened in a pause is not known
    command(p, s, r, u)
    wound_up = False
    for i in range(3):
        # limited, and integrating on would only make it worse
        if p[ANTI_WINDUP] > 0.0 and p[KI + i] > 0.0 and abs(u[i]) > p[LIMIT + i] and u[i] * s[ERROR + i] < 0.0:
            s[GROWTH + i] = 0.0
            wound_up = True
    if wound_up:
        command(p, s, r, u)
    for i in range(3):
        s[INTEGRAL + i] += s[GROWTH + i]
        u[i] = min(max(u[i], -p[LIMIT + i]), p[LIMIT + i])
    s[TIME], s[STARTED] = t, 1.0
