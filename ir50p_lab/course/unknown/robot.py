"""Notebook 19, what is given: eyes, safe paths, the motion behind a recording. It runs the student's own functions."""

import itertools
from types import SimpleNamespace

import numpy as np

from ir50p_lab.course import my_robot
from ir50p_lab.course.images.notebook_functions import edges_of, with_neighbours
from ir50p_lab.course.torque.bench_views import Rate  # noqa: F401  (of the error, as in 15)
from ir50p_lab.course.unknown.notebook_functions import with_a_pull  # noqa: F401

#: Of the twenty columns of the regressor those that each joint can tell apart in its own motion.
COLUMNS = [0, 1, 4, 5, 10, 11, 16], [1, 2, 3, 4, 5, 8, 9, 12, 13, 17], [3, 4, 5, 9, 14, 15, 18, 19]
_OVER = np.array([0, 0, 0.035])  # m, from the centre of a ball to the place of a touch
_RED, _WIDE = 0.0, 0.3  # rad: hue of the balls, and how far from it
_RADII, _FINER = range(14, 42, 3), range(-2, 3)  # px; tried first, and then beside the best
_STILL = 0.05  # rad/s: slower, friction has no sure direction
_EVERY, _EDGE = 4, 100  # samples
_VIA = np.array([0, 0.16, 0])  # rad: higher in the middle


def motion(recording, both_ways):
    """Return what a recording tells: Y (n, 3, 20) by the student's regressor, and moving (n, 3) bool, the rows to use.

    both_ways: the student's filter, of a signal (n,).
    """
    q = np.apply_along_axis(both_ways, 0, recording.q)
    qd = np.gradient(q, 0.01, axis=0)
    qdd = np.gradient(qd, 0.01, axis=0)
    direction = np.tanh(qd / _STILL)
    Y = np.array([my_robot.regressor(*row) for row in zip(q, qd, qdd, direction, strict=True)])
    moving = np.zeros(q.shape, dtype=bool)
    moving[_EDGE:-_EDGE:_EVERY] = True
    return SimpleNamespace(Y=Y, moving=moving & (np.abs(qd) > _STILL))


def find_balls(bench, camera_at):
    """Return the centres (3, 3) m of three red balls in one picture.

    camera_at(K, corners, points) returns T_base_cam.
    """
    T = camera_at(bench.K, bench.corners, bench.points)
    mask = my_robot.hue_mask(bench.look(), _RED, _WIDE)
    points, inwards = edges_of(mask)
    found = []
    for _ in range(3):
        *_, radius = max(_circle(points, inwards, radius, mask.shape) for radius in _RADII)
        _, x, y, radius = max(_circle(points, inwards, radius + more, mask.shape) for more in _FINER)
        found.append(my_robot.pixel_to_plane(bench.K, T, (x, y), 0.03))
        others = np.hypot(points[:, 0] - x, points[:, 1] - y) > 1.3 * radius
        points, inwards = points[others], inwards[others]
    return np.array(found)


def _circle(points, inwards, radius, shape):
    """(share of the votes of a full circle, column, row, radius) of the best middle, finer than a pixel."""
    votes = with_neighbours(my_robot.circle_votes(points, inwards, radius, shape))
    row, column = np.unravel_index(np.argmax(votes), votes.shape)
    rows, columns = np.mgrid[max(row - 2, 0) : row + 3, max(column - 2, 0) : column + 3]
    rows, columns = np.minimum(rows, shape[0] - 1), np.minimum(columns, shape[1] - 1)
    near = votes[rows, columns]
    weights = near / max(near.sum(), 1)
    return votes.max() / (2 * np.pi * radius), np.sum(columns * weights), np.sum(rows * weights), radius


def clearance(a, b, l):
    """How low elbow or tip come on the straight path from pose a to pose b, m."""
    poses = a + np.linspace(0, 1, 13)[:, None] * (b - a)
    return min(my_robot.frames(q, l)[2:, 2, 3].min() for q in poses)


class PracticePath:
    """A path between safe poses, drawn as it goes on: path(t) is q, qd, qdd (3, 3) at a time t, which only grows."""

    def __init__(self, bench, seed):
        self._bench, self._rng = bench, np.random.default_rng(seed)
        self._leg = 0.0, bench.start, bench.start, 1.0

    def __call__(self, t):
        """The plan at t."""
        begin, a, b, seconds = self._leg
        while t > begin + seconds:
            begin, a = begin + seconds, b
            b, seconds = self._next(a)
            self._leg = begin, a, b, seconds
        return np.array(my_robot.quintic(a, b, seconds, t - begin))

    def _next(self, a):
        low, high = self._bench.limits
        while True:
            b = self._rng.uniform(low + 0.25, high - 0.25)
            if clearance(a, b, self._bench.l) > 0.2:
                return b, max(0.8, np.abs(b - a).max() / self._rng.uniform(0.3, 0.75))


def plan(bench, balls, seconds_for):
    """Return the legs of the race, [(a, b, seconds, whether b is at a ball)]: of the six orders the quickest.

    seconds_for(a, b): how long a leg may take. If the straight path comes too low, it goes over a higher pose.
    """
    poses = [my_robot.reach(ball + _OVER, bench.l, bench.start, bench.limits) for ball in balls]
    return min((_legs(bench, order, seconds_for) for order in itertools.permutations(poses)), key=_lasts)


def _legs(bench, poses, seconds_for):
    legs, at = [], bench.start
    for pose in poses:
        middle = at + (pose - at) * 11 / 12
        over = [] if clearance(at, middle, bench.l) > 0.06 else [(at + pose) / 2 + _VIA]
        for b in (*over, pose):
            legs.append((at, b, seconds_for(at, b), b is pose))
            at = b
    return legs


def _lasts(legs):
    return sum(seconds for _, _, seconds, _ in legs)


class OnLegs:
    """Which leg the race is on: on_legs(sample, ahead) is q, qd, qdd (3, 3), `ahead` seconds after the sample.

    A leg to a ball ends when the ball is touched, any other when its time is over.
    """

    def __init__(self, legs):
        self._legs, self._k, self._begin, self._touched = legs, 0, 0.0, 0

    def __call__(self, sample, ahead):
        """The plan of the leg."""
        while self._k + 1 < len(self._legs) and self._is_over(sample):
            self._touched += self._legs[self._k][3]
            self._k, self._begin = self._k + 1, sample.t
        a, b, seconds, _ = self._legs[self._k]
        return np.array(my_robot.quintic(a, b, seconds, sample.t - self._begin + ahead))

    def _is_over(self, sample):
        _, _, seconds, at_a_ball = self._legs[self._k]
        return sample.touched > self._touched if at_a_ball else sample.t - self._begin >= seconds
