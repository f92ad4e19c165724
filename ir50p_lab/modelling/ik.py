"""Inverse kinematics: all four branches in closed form (1.60)-(1.73 corrected)."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ir50p_lab.errors import UnreachableError
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import lengths
from ir50p_lab.modelling.kernel import evaluate, kernel

BRANCHES = ("front/up", "front/down", "back/up", "back/down")
_EDGE = 1e-12  # share of the reach by which rounding may put the tip of a stretched arm outside it


@dataclass(frozen=True)
class IKSolutions:
    """All joint angles that reach a point, or each of n points.

    q: (4, 3) or (n, 4, 3) rad, one row per branch in the order of `branches`; q_min, q_max: the joint limits, rad.
    In the front branches joint 1 faces the point; in the back ones it faces away, and the arm bends over backwards.
    Up and down are the sign of q3: q3 <= 0 is up, q3 >= 0 is down. In the front branches the elbow of up is above the
    line from shoulder to tip, that of down below it; for an arm bent over backwards it is the other way round. At the
    edge of the workspace up and down coincide.

    For a single point, iterating, indexing and len() go over the branches.
    """

    q: np.ndarray
    q_min: tuple
    q_max: tuple
    branches: tuple = BRANCHES

    @cached_property
    def within_limits(self):
        """Which branches are within the joint limits: bool, (4,) or (n, 4)."""
        return ((self.q >= np.array(self.q_min)) & (self.q <= np.array(self.q_max))).all(axis=-1)

    def __len__(self):
        return len(self.branches)

    def __iter__(self):
        return iter(np.moveaxis(self.q, -2, 0))

    def __getitem__(self, branch):
        """Branch by name or number: (3,) or (n, 3) rad."""
        index = self.branches.index(branch) if isinstance(branch, str) else branch
        return self.q[..., index, :]


def reachability(arm, p):
    """Return the distance from `p` to the workspace, 0 if `p` is inside.

    The workspace is the shell |l2 - l3| <= r <= l2 + l3, with r the distance from the shoulder (0, 0, l1). Joint limits
    are not taken into account.

    Args: arm: Arm; p: (3,) or (n, 3) m. Returns: scalar or (n,) m.
    """
    p = vectors3("p", p, unit="m")
    l1, l2, l3 = arm.l
    r = np.linalg.norm(p - np.array([0.0, 0.0, l1]), axis=-1)
    return np.maximum(0.0, np.maximum(r - (l2 + l3), abs(l2 - l3) - r))


def _out_of_reach(arm, p):
    """The error that names the worst of the points, how far it is outside, and the nearest that can be reached."""
    p = vectors3("p", p, unit="m")
    distance = reachability(arm, p)
    outside = distance > _EDGE * arm.reach
    worst = np.unravel_index(np.argmax(distance), distance.shape)
    l1, l2, l3 = arm.l
    shoulder = np.array([0.0, 0.0, l1])
    offset = p[worst] - shoulder
    r = np.linalg.norm(offset)
    direction = offset / r if r > 0 else np.array([1.0, 0.0, 0.0])
    nearest = shoulder + np.clip(r, abs(l2 - l3), l2 + l3) * direction
    count = f" (and {int(outside.sum()) - 1} more points)" if outside.sum() > 1 else ""
    error = UnreachableError(
        f"p = {np.round(p[worst], 4).tolist()} m is {distance[worst]:.4g} m outside the workspace: it lies "
        f"{r:.4g} m from the shoulder, the arm reaches {abs(l2 - l3):.4g} to {l2 + l3:.4g} m{count}; "
        f"nearest point {np.round(nearest, 4).tolist()} m"
    )
    error.distance, error.nearest = float(distance[worst]), nearest
    return error


@kernel("(n),(b),(n)->(b,n)")
def _branches(l, four, p, q):
    l1, l2, l3 = l
    delta, z = math.hypot(p[0], p[1]), p[2] - l1
    r = math.hypot(delta, z)
    # differences of squares as products: rounding adds nothing to that of p at the edges of the workspace
    inner, outer = r - abs(l2 - l3), l2 + l3 - r
    if not min(inner, outer) >= -_EDGE * (l2 + l3):
        raise UnreachableError("a point is out of reach")
    inner = math.sqrt(max(0.0, inner) * (r + abs(l2 - l3)))
    outer = math.sqrt(max(0.0, outer) * (l2 + l3 + r))
    bend = 2 * math.atan2(outer, inner)
    for k in range(4):  # in the order of BRANCHES
        side, elbow = 1.0 if k < 2 else -1.0, -1.0 if k % 2 == 0 else 1.0
        q3 = elbow * bend
        q2 = math.atan2(z, side * delta) - math.atan2(l3 * math.sin(q3), l2 + l3 * math.cos(q3))
        q2 -= 2 * math.pi * math.ceil(q2 / (2 * math.pi) - 0.5)  # into (-pi, pi]
        q[k, 0], q[k, 1], q[k, 2] = math.atan2(side * p[1], side * p[0]), q2, q3


_FOUR = np.empty(4)  # gives the branches their number: the signature of a ufunc may hold no numbers


def inverse_kinematics(arm, p):
    """Return all four joint solutions for a position of the tip, in closed form    (1.60)-(1.73) corrected

    q1 = atan2(y, x) or atan2(-y, -x);  Delta = +-hypot(x, y), z1 = z - l1, r^2 = Delta^2 + z1^2
    q3 = -+2 atan2(sqrt((l2 + l3)^2 - r^2), sqrt(r^2 - (l2 - l3)^2))
    q2 = atan2(z1, Delta) - atan2(l3 sin q3, l2 + l3 cos q3)

    Near the folded arm with equal links the half-angle form of q3 keeps all digits of the tip, where acos (1.69)
    misses it by up to 1e-8 of the reach. Near the stretched arm the two are alike: there the tip hardly depends on
    q3, so that the rounding of p alone leaves q3 uncertain by some 3e-8 rad while the tip is right to the last digits.
    Joint limits are checked last; solutions beyond them are returned, too, and only marked.

    Args: arm: Arm; p: (3,) or (n, 3) m.
    Returns: IKSolutions with q of shape (4, 3) or (n, 4, 3), angles in (-pi, pi].
    Raises: UnreachableError (with .distance in m and .nearest (3,) m) if a point is outside the workspace;
    InputError on a wrong shape or a number that is not finite.

    >>> from ir50p_lab.modelling import IR50P, inverse_kinematics
    >>> inverse_kinematics(IR50P, [0.42, -0.15, 0.03]).q.round(3)
    array([[-0.343,  0.115, -0.958],
           [-0.343, -1.154,  0.958],
           [ 2.799, -1.988, -0.958],
           [ 2.799,  3.027,  0.958]])
    """
    try:
        q = evaluate(_branches, (lengths(arm), _FOUR), p=p)
    except UnreachableError:
        raise _out_of_reach(arm, p) from None
    return IKSolutions(q=q, q_min=arm.q_min, q_max=arm.q_max)
