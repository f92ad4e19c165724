"""Joint velocity from sampled angles: differences behind a low pass, and a Kalman filter beside them."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, number, vector3, vectors3
from ir50p_lab.jit import jit
from ir50p_lab.signals.low_pass import low_pass
from ir50p_lab.signals.reference import per_joint

ONE_COUNT = (0.0056, 0.0084, 0.0054)  # rad rms: 1 count of noise and rounding, by the slopes of the sister arm


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


@jit()
def _run(gain, period, q, state, started, out):
    """Fill out (n, 2, 3) with q and qd; gain and state (3, 3): joint, (q, qd, qdd). Returns whether it has started."""
    T = period
    for k in range(q.shape[0]):
        for i in range(3):
            if not started:
                state[i, 0], state[i, 1], state[i, 2] = q[k, i], 0.0, 0.0
            else:
                x = state[i, 0] + T * state[i, 1] + 0.5 * T * T * state[i, 2]
                v = state[i, 1] + T * state[i, 2]
                surprise = q[k, i] - x
                state[i, 0] = x + gain[i, 0] * surprise
                state[i, 1] = v + gain[i, 1] * surprise
                state[i, 2] += gain[i, 2] * surprise
            out[k, 0, i], out[k, 1, i] = state[i, 0], state[i, 1]
        started = True
    return started


class VelocityKalman:
    """Kalman filter for angle and velocity of the three joints, with its steady gain.

        predict   x <- F x,                F = [[1, T, T^2/2], [0, 1, T], [0, 0, 1]]  (model="velocity": upper left 2x2)
        correct   x <- x + K (q - x_1),    K = P H'/(H P H' + noise^2)
        P         solves the discrete Riccati equation (scipy.linalg.solve_discrete_are)

    model="velocity": the velocity is constant but for an acceleration that is drawn anew each period, of `change`
    rad/s^2 rms. It lags while the joint accelerates. model="acceleration": the acceleration is kept and changes by
    `change` rad/s^2 rms each period; it does not lag at constant acceleration and lets more noise through.
    Only change T^2/noise counts: more trust in the measurement and less lag, or more in the model and less noise.

    Args: period: s; noise: rms of the measured angle, rad (default: one count of each potentiometer);
    change: rad/s^2; each one number or (3,). model: 'velocity' or 'acceleration'.
    Attributes: gain (3, 3): joint, (q, qd, qdd). Raises InputError on other values.
    """

    def __init__(self, period=0.01, *, noise=ONE_COUNT, change=10.0, model="velocity"):
        self.period = number("period", period, "> 0", unit="s")
        self.model = choice("model", model, ("velocity", "acceleration"))
        self.noise = per_joint("noise", noise, "> 0", unit="rad")
        self.change = per_joint("change", change, "> 0", unit="rad/s^2")
        self.gain = np.zeros((3, 3))
        size = 2 if model == "velocity" else 3
        for i in range(3):
            self.gain[i, :size] = steady_gain(self.period, self.noise[i], self.change[i], size)
        self.state = np.zeros((3, 3))
        self._one = np.empty((1, 2, 3))
        self.reset()

    def reset(self):
        """Forget the past: the next sample is taken as it is, at rest."""
        self.state[:], self._started = 0.0, False

    def step(self, q):
        """Take one sample q (3,) rad; returns the estimates q (3,) rad and qd (3,) rad/s."""
        q = vector3("q", q)
        self._started = _run(self.gain, self.period, q[None], self.state, self._started, self._one)
        return self._one[0, 0].copy(), self._one[0, 1].copy()

    def estimate(self, q):
        """The same for a record q (n, 3) rad from its beginning: q (n, 3) rad and qd (n, 3) rad/s."""
        q = vectors3("q", q)
        if q.ndim != 2 or len(q) == 0:
            raise InputError(f"q has shape {q.shape}; give a record (n, 3), time first")
        out = np.empty((len(q), 2, 3))
        _run(self.gain, self.period, np.ascontiguousarray(q), np.zeros((3, 3)), False, out)
        return out[:, 0].copy(), out[:, 1].copy()


def steady_gain(period, noise, change, size):
    """Steady Kalman gain (size,) for one joint; size 2: constant velocity, 3: constant acceleration."""
    from scipy.linalg import solve_discrete_are

    # in units of noise and period the equation holds numbers near 1 only
    strength = change * period**2 / noise
    F = np.array([[1.0, 1.0, 0.5], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])[:size, :size]
    G = np.array([0.5, 1.0, 1.0])[:size]
    H = np.eye(size)[:1]
    P = solve_discrete_are(F.T, H.T, strength**2 * np.outer(G, G), np.eye(1))
    return P[:, 0] / (P[0, 0] + 1.0) / period ** np.arange(size)
