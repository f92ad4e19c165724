"""The sampled PID as one compiled function on flat arrays; what it does is explained in `pid`."""

import math

from ir50p_lab.controllers.sampling import elapsed
from ir50p_lab.jit import jit
from ir50p_lab.modelling.closed_form import not_denormal

# places in the parameter vector
KP, KI, KD, LIMIT, PERIOD, FILTER_RATE, POSITION_RATE, ON_ERROR, ANTI_WINDUP = 0, 3, 6, 9, 12, 13, 14, 15, 16
N_PARAMETERS = 17
# places in the state vector
INTEGRAL, VELOCITY, LAST, ERROR, SLOPE, TIME, STARTED, FILTERED, N_STATES = 0, 3, 6, 9, 12, 15, 16, 17, 20


@jit()
def pid_step(p, s, t, q, r, u):
    """One sample of the PID: reads parameters p, state s, time t, measured q, reference rows r; writes s and u."""
    started = s[STARTED] > 0.0
    dt = elapsed(s, TIME, STARTED, p[PERIOD], t)
    blend = 1.0 - math.exp(-p[FILTER_RATE] * dt)
    position_blend = 1.0 - math.exp(-p[POSITION_RATE] * dt)
    for i in range(3):
        y = q[i]
        if p[POSITION_RATE] > 0.0:
            if started:
                y = s[FILTERED + i] + position_blend * (q[i] - s[FILTERED + i])
            s[FILTERED + i] = y
        e = r[0, i] - y
        moved = e - s[LAST + i] if p[ON_ERROR] > 0.0 else y - s[LAST + i]
        if not started:
            moved = 0.0
        if dt > 0.0:
            s[VELOCITY + i] = not_denormal(s[VELOCITY + i] + blend * (moved / dt - s[VELOCITY + i]))
        s[LAST + i] = e if p[ON_ERROR] > 0.0 else y
        slope = s[VELOCITY + i] if p[ON_ERROR] > 0.0 else r[1, i] - s[VELOCITY + i]
        s[ERROR + i], s[SLOPE + i] = e, slope  # for a change of gains without a bump
        without = p[KP + i] * e + p[KD + i] * slope
        integral = s[INTEGRAL + i] + p[KI + i] * e * dt
        command = without + integral
        limit = p[LIMIT + i]
        if p[ANTI_WINDUP] > 0.0 and abs(command) > limit and command * e > 0.0:
            integral = s[INTEGRAL + i]  # saturated, and integrating on would only make it worse
            command = without + integral
        s[INTEGRAL + i] = integral
        u[i] = min(max(command, -limit), limit)
    s[TIME], s[STARTED] = t, 1.0
