"""Joint velocity from sampled angles: differences behind a low pass, and a Kalman filter beside them."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number
from ir50p_lab.signals.low_pass import low_pass


def difference_velocity(q, rate_hz, *, cutoff_hz=None, order=1, kind="causal"):
    """Velocity as difference quotient, (q_k - q_k-1) rate, and a low pass over it if a cut-off is given.

    Noise of sigma rad becomes sqrt(2) rate sigma rad/s: at 100 Hz half a degree becomes over 1 rad/s. The difference
    itself is half a period late. kind="zero-phase" takes central differences and filters without lag (records only).

    Args: q: (n,) or (n, k) rad, time first; rate_hz, cutoff_hz, order, kind: as in `low_pass`.
    Returns: rad/s, like q; the first value is 0 (causal). Raises InputError as `low_pass` does.
    """
    q = np.asarray(q, dtype=float)
    if q.ndim not in (1, 2) or len(q) < 3:
        raise InputError(f"q has shape {q.shape}; give at least three samples, (n,) or (n, k), time first (rad)")
    if kind == "zero-phase":
        v = np.gradient(q, axis=0) * rate_hz
    else:
        v = np.diff(q, axis=0, prepend=q[:1]) * rate_hz
    return v if cutoff_hz is None else low_pass(v, cutoff_hz, rate_hz, order=order, kind=kind)


def kalman_velocity(q, rate_hz, *, noise, change):
    """Velocity by a Kalman filter with its steady gain, which takes the velocity as constant but for accelerations.

        predict   x <- F x,                F = [[1, T], [0, 1]],  x = (angle, velocity), T = 1/rate
        correct   x <- x + K (q - x_1),    K = P H'/(H P H' + noise^2)
        P         solves the discrete Riccati equation (scipy.linalg.solve_discrete_are)

    An acceleration is drawn anew each period, of `change` rad/s^2 rms; the estimate lags while the joint accelerates.
    Only change T^2/noise counts: more trust in the measurement and less lag, or more in the model and less noise. The
    first sample is taken as it is, at rest.

    Args: q: (n,) or (n, k) rad, time first; rate_hz: samples per s; noise: rms of the measured angle, rad; change:
    rad/s^2. Returns: rad/s, like q. Raises InputError for numbers that are not positive.
    """
    from scipy.signal import lfilter, lfilter_zi

    T = 1 / number("rate_hz", rate_hz, "> 0")
    noise = number("noise", noise, "> 0", unit="rad")
    alpha, beta = steady_gain(number("change", change, "> 0", unit="rad/s^2") * T**2 / noise)
    b, a = np.array([beta, -beta, 0.0]) / T, np.array([1.0, alpha + beta - 2, 1 - alpha])  # from q to x_2
    q = np.asarray(q, dtype=float)
    return lfilter(b, a, q, axis=0, zi=np.multiply.outer(lfilter_zi(b, a), q[0]))[0]


def steady_gain(strength):
    """Steady Kalman gain (2,) for angle and velocity in units of noise and period: strength = change T^2/noise."""
    from scipy.linalg import solve_discrete_are

    F, G, H = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([0.5, 1.0]), np.array([[1.0, 0.0]])
    P = solve_discrete_are(F.T, H.T, strength**2 * np.outer(G, G), np.eye(1))
    return P[:, 0] / (P[0, 0] + 1.0)
