"""What every sampled law needs: how long it has been since the last sample."""

from ir50p_lab.jit import jit


@jit()
def elapsed(s, time, started, period, t):
    """s since the last sample: the period, unless the cycle was late or early (then its true length, within limits).

    s: state vector; time, started: places in it of the last t and of whether there was one.
    """
    dt = period
    if s[started] > 0.0 and abs(t - s[time] - dt) > 1e-6 * dt:
        dt = min(max(t - s[time], 0.0), 10 * period)
    return dt
