"""What a reach leaves behind: its looks, how it ended, where a followed ball was."""

from collections import namedtuple

import numpy as np


class Look(namedtuple("Look", "marker joint_errors note t")):
    """One stop of a reach; at all except the last the camera has looked again.

    marker: (2,) px on the hand, None if it was not seen; joint_errors: (3,) rad, by how much the potentiometers are
    off; note: what did not go as planned; t: s, when the arm stood there, by the clock of the run.
    """


class Reached(namedtuple("Reached", "ball goal tip q looks tip_true")):
    """How a reach ended.

    ========== ==================================================================================== ============
    ball       its centre, as seen                                                                  (3,) m
    goal       where the tip was to go: above the ball                                              (3,) m
    tip        where it is, by averaged potentiometers and the camera's correction                  (3,) m
    q          the joint angles of that                                                             (3,) rad
    looks      the looks, a tuple of Look
    tip_true   where the tip really is, for a simulated arm, else None. Nothing here uses it.       (3,) m
    ========== ==================================================================================== ============
    """

    @property
    def miss(self):
        """The distance between the goal and the tip as measured, m."""
        return float(np.linalg.norm(self.goal - self.tip))


class FollowLog(namedtuple("FollowLog", "t tip ball velocity lead")):
    """What following a ball recorded.

    t: (n,) s; tip: (n, 3) m, by potentiometers; ball: (n, 2) m and velocity: (n, 2) m/s, as tracked; lead: how far
    ahead it aimed, s. ball is NaN before the first look, and while the ball has not been seen for 0.5 s.
    """

    @property
    def speed(self):
        """The speed of the ball, (n,) m/s."""
        return np.linalg.norm(self.velocity, axis=1)

    @property
    def ahead(self):
        """How far the tip is ahead of the ball along its path, (n,) m: negative behind it, NaN while the ball rests."""
        along = np.sum((self.tip[:, :2] - self.ball) * self.velocity, axis=1)
        return np.divide(along, self.speed, out=np.full(len(along), np.nan), where=self.speed > 0)


class BallTracker:
    """Tracks position and velocity of a rolling ball from looks at irregular times, by an alpha-beta filter."""

    alpha, beta = 0.7, 0.25  # shares of (seen minus expected) that correct position and velocity

    def __init__(self):
        self.position, self.velocity, self._t = None, np.zeros(2), 0.0

    def update(self, t, xy):
        """Take in that a look at time t s found the ball at xy (2,) m."""
        if self.position is None:
            self.position, self._t = np.array(xy, dtype=float), t
            return
        dt = max(t - self._t, 1e-3)
        surprise = xy - (self.position + self.velocity * dt)
        self.position = self.position + self.velocity * dt + self.alpha * surprise
        self.velocity = self.velocity + self.beta / dt * surprise
        self._t = t

    def at(self, t):
        """Predict the place at time t s, (2,) m; NaN before the first look."""
        return np.full(2, np.nan) if self.position is None else self.position + self.velocity * (t - self._t)
