"""The compiled part of `optimise_excitation`: condition numbers and room at the bounds for one set of coefficients."""

import math

import numpy as np

from ir50p_lab.identification.arm_regressor import regressor_block
from ir50p_lab.jit import jit

BOUNDS = 11  # per joint: above, below, speed; then elbow and tip over the table
_GRAVITY = 9.81  # m/s^2; scales whole columns only, which does not matter here
_TURN = 0.03  # rad/s: sgn(qd) as tanh(qd/_TURN), for a jump has no slope to follow
_SLOW = 0.1  # rad/s: about where a dry joint may stick
_WORST = 1e8  # condition number that counts as endless
_STEP = 1e-6  # rad, of the differences


@jit()
def evaluate(x, basis, picked, shared, bounds, out):
    """Fill out (1 + BOUNDS): mean log condition number (plus the price of standing), then room at each bound.

    x: q0 (3), then free coefficients (3, p); basis (3, n, p): from these to q, qd, qdd; picked (3, 20): columns of each
    joint; bounds: q low (3), q high (3), speed (3), table, l (3), share of half the range that may hide,
    price of standing.
    """
    n, p = basis.shape[1], basis.shape[2]
    motion = np.empty((3, n, 3))
    for d in range(3):
        for k in range(n):
            for i in range(3):
                total = x[i] if d == 0 else 0.0
                for j in range(p):
                    total += basis[d, k, j] * x[3 + i * p + j]
                motion[d, k, i] = total
    _room(motion, bounds, out)
    gram = np.zeros((3, 20, 20))
    block = np.zeros((3, 20))
    place, count = np.zeros((3, 20), dtype=np.int64), np.zeros(3, dtype=np.int64)
    for i in range(3):
        for a in range(20):
            if picked[i, a]:
                place[i, count[i]] = a
                count[i] += 1
    for k in range(n):
        q, qd, qdd = motion[0, k], motion[1, k], motion[2, k]
        regressor_block(
            _GRAVITY, q[1], q[2], qd[0], qd[1], qd[2], qdd[0], qdd[1], qdd[2],
            np.tanh(qd[0] / _TURN), np.tanh(qd[1] / _TURN), np.tanh(qd[2] / _TURN), block,
        )  # fmt: skip
        for i in range(3):
            for m in range(count[i]):
                a = place[i, m]
                for j in range(m + 1):
                    b = place[i, j]
                    gram[i, a, b] += block[i, a] * block[i, b]
    if shared:
        cost = _log_condition(gram[0] + gram[1] + gram[2], picked[0] | picked[1] | picked[2])
    else:
        cost = sum([_log_condition(gram[i], picked[i]) for i in range(3)]) / 3.0
    still = 0.0
    for k in range(n):
        for i in range(3):
            still += 1.0 / (1.0 + (motion[1, k, i] / _SLOW) ** 2)
    out[0] = cost + bounds[14] * still / (3 * n)


@jit()
def _room(motion, bounds, out):
    n = motion.shape[1]
    hidden = bounds[13]
    for i in range(3):
        low, high, speed = np.inf, -np.inf, 0.0
        for k in range(n):
            low, high = min(low, motion[0, k, i]), max(high, motion[0, k, i])
            speed = max(speed, abs(motion[1, k, i]))
        more = hidden * 0.5 * (high - low)
        out[1 + 3 * i] = bounds[3 + i] - high - more
        out[2 + 3 * i] = low - more - bounds[i]
        out[3 + 3 * i] = bounds[6 + i] - speed * (1.0 + hidden)
    elbow, tip = np.inf, np.inf
    for k in range(n):
        height = bounds[10] + bounds[11] * math.sin(motion[0, k, 1])
        elbow = min(elbow, height)
        tip = min(tip, height + bounds[12] * math.sin(motion[0, k, 1] + motion[0, k, 2]))
    reach = bounds[11] + bounds[12]
    out[10] = min(elbow - bounds[9] - hidden * reach, 1e3)
    out[11] = min(tip - bounds[9] - hidden * reach, 1e3)


@jit()
def _log_condition(gram, picked):
    """Log of the condition number of columns with this Gram matrix (lower half), each scaled to length 1."""
    m = picked.sum()
    G = np.empty((m, m))
    place = np.flatnonzero(picked)
    for a in range(m):
        for b in range(a + 1):
            size = math.sqrt(gram[place[a], place[a]] * gram[place[b], place[b]])
            G[a, b] = G[b, a] = gram[place[a], place[b]] / size if size > 0.0 else 0.0
    values = np.linalg.eigvalsh(G)
    return 0.5 * math.log(min(values[m - 1] / max(values[0], 1e-300), _WORST**2))


@jit()
def slopes(x, basis, picked, shared, bounds, out):
    """Derivatives of `evaluate` by differences: out (1 + BOUNDS, len(x))."""
    here, ahead, moved = np.empty(1 + BOUNDS), np.empty(1 + BOUNDS), x.copy()
    evaluate(x, basis, picked, shared, bounds, here)
    for j in range(len(x)):
        moved[j] = x[j] + _STEP
        evaluate(moved, basis, picked, shared, bounds, ahead)
        moved[j] = x[j]
        out[:, j] = (ahead - here) / _STEP
