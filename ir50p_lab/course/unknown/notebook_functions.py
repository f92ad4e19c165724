"""Functions of 19 that stay in its notebook: the course's, what each is tried on; and a helper that it has."""

import numpy as np

from ir50p_lab.course.at_the_bench.functions.low_pass import low_pass
from ir50p_lab.course.camera.functions.homography import homography
from ir50p_lab.course.checking.task import notebook_tasks
from ir50p_lab.course.fitting.functions.least_squares import least_squares
from ir50p_lab.course.fitting.functions.regressor import regressor
from ir50p_lab.course.motion.functions.quintic import quintic

_PULL = 1e-3 / 100  # of a column's size, for each root of a row
_DELAYS = 0.05, 0.06, 0.07  # s


def both_ways(x):
    """Return a signal (n,) low-passed at 2 Hz forwards and backwards, so that it does not lag at all."""
    return low_pass(low_pass(x, 2, 100)[::-1], 2, 100)[::-1]


def with_a_pull(A, y):
    """Return A (n, k) and y (n,) with k more rows, which draw each number weakly to zero.

    So a number about which no row tells anything stays small.
    """
    pull = np.diag(np.linalg.norm(A, axis=0)) * _PULL * np.sqrt(len(y))
    return np.vstack([A, pull]), np.concatenate([y, np.zeros(len(pull))])


def acted(u, delay):
    """Return the counts (n, 3) that act in each period, from those (n, 3) that were sent in it; delay: s."""
    late = round(delay / 0.01)
    return np.concatenate([np.zeros((late, 3)), u[: len(u) - late]])


def fit_joint(Y, y, use):
    """Return the numbers (k,) of one joint, from columns (n, k) and counts (n,), filtered alike.

    use: (n,) bool, the rows that count.
    """
    A = np.apply_along_axis(both_ways, 0, Y)[use]
    theta, _ = least_squares(*with_a_pull(A, both_ways(y)[use]))
    return theta


def most_counts(theta, a, b, seconds):
    """Return the largest push, counts, that a theta (3, 20) asks for on the quintic from a to b."""
    plans = [quintic(a, b, seconds, t) for t in np.linspace(0, seconds, 15)]
    return np.max([np.abs(np.sum(regressor(*plan, np.tanh(plan[1] / 0.05)) * theta, axis=1)) for plan in plans])


def when_it_acts(off, off_rate, plan_at, delay):
    """Return place, speed and plan (3, 3) that a command of now meets: the plan of then, and a drift that goes on."""
    plan = plan_at(delay)
    return plan[0] + off + delay * off_rate, plan[1] + off_rate, plan


def camera_at(K, corners, points):
    """Return T_base_cam (4, 4) from the pixels (4, 2) of four places (4, 3) m of the table."""
    G = np.linalg.solve(homography(corners, points[:, :2]) @ K, np.eye(3))
    G = G / np.linalg.norm(G[:, 0]) * np.sign(G[2, 2])
    R = np.column_stack([G[:, 0], G[:, 1], np.cross(G[:, 0], G[:, 1])])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R.T, -R.T @ G[:, 2]
    return T


# ------------------------------------------------------------------------------------------------------ tried on
def _rng():
    return np.random.default_rng(190)


def _signals():
    return [(np.cumsum(_rng().normal(size=n)),) for n in (150, 200, 260)]


def _sent():
    return [(_rng().normal(0, 50, (9, 3)).round(), delay) for delay in _DELAYS]


def _joints():
    cases = []
    for n, k in ((200, 2), (300, 4)):
        Y = np.cumsum(_rng().normal(size=(n, k)), axis=0)
        cases.append((Y, Y @ np.arange(5, 5 + k) + _rng().normal(0, 20, n), np.arange(n) % 3 > 0))
    return cases


def _legs():
    poses = _rng().uniform(-1, 1, (4, 2, 3))
    return [(20 * _rng().normal(size=(3, 20)), a, b, 0.6 + a[0] ** 2) for a, b in poses]


def _drifts():
    rows = zip(_DELAYS, _rng().normal(size=(3, 2, 3)), strict=True)
    return [(off / 9, rate, made_up, delay) for delay, (off, rate) in rows]


def made_up(ahead):
    """a made-up plan, (3, 3): q, qd, qdd"""
    return np.outer([1, 2, 3], [0.4, -0.3, 0.2]) + ahead * np.outer([2, 3, 1], [0.5, 1, -1])


def _cameras():
    from ir50p_lab.course.unknown.world import World

    told = [World(seed).answer({"op": "begin"}) for seed in range(3)]
    cases = [[np.array(one[name]) for name in ("K", "corners", "points")] for one in told]
    cases[0][0][1, 2] += 2000  # px: as if the picture went on upwards, far above the horizon
    cases[0][1][:, 1] += 2000
    return cases


TASKS = notebook_tasks(
    __file__,
    both_ways=(both_ways, _signals, "the signal, smooth and not late"),
    acted=(acted, _sent, "the counts that act, as many rows as were sent", {"unit": "counts"}),
    fit_joint=(fit_joint, _joints, "the numbers of one joint, as many as there are columns"),
    most_counts=(most_counts, _legs, "the largest push, one number", {"tolerance": 0.04, "unit": "counts"}),
    when_it_acts=(when_it_acts, _drifts, "place, speed and plan", {"results": ("place", "speed", "plan")}),
    camera_at=(camera_at, _cameras, "T_base_cam, 4 by 4", {"tolerance": 2e-3}),
)
