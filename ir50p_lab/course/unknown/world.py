"""The world of one unknown arm: it answers what a bench asks, and counts touches. Nobody who asks holds arm or balls.

Questions and answers are dictionaries of numbers and texts alone, so that they fit through a pipe as lines of JSON.
"""

import base64
import math
import zlib
from collections import deque

import numpy as np

from ir50p_lab.course.unknown.arms import ABOVE, PERIOD, START, drawn
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, vector3

BALLS, PRACTICE, PICTURES = 3, 120.0, 5  # s of practice in all
NEAR, HOLD = 0.008, 0.3  # m, s: the tip touches a ball that stays so near the place above it for so long
LIMIT = 255  # counts
KNOCK = 0.022  # m from the centre of a ball that is not touched yet: it rolls away
TABLE = 0.02  # m: elbow or tip under it ends a run
END, MISSING = 20.0, 10.0  # s: of a race; for each ball that was not touched
_CORNERS = np.array([[0.25, -0.3, 0], [0.25, 0.3, 0], [0.55, 0.3, 0], [0.55, -0.3, 0]])  # m, of the table's mark


class World:
    """One unknown arm, its balls and its camera; seed: a whole number, of all of it.

    Attributes: given: Drawn; left: s of practice; pictures: how many may still be taken; raced; touched (3,): s at
    which each ball was touched, nan for never; knocked (3,) bool; path: [(t, q true)] of the race; ended: how the last
    run did.
    """

    def __init__(self, seed):
        self.given, self.left, self.pictures, self.raced, self.ended = drawn(seed), PRACTICE, PICTURES, False, ""
        self.touched, self.knocked, self.path = np.full(BALLS, np.nan), np.zeros(BALLS, dtype=bool), []
        self._rng, self._run = np.random.default_rng([seed, 4]), None

    def answer(self, question):
        """Return what the bench answers to a question, {"op": ...} or {"u": counts}.

        Raises InputError for anything else.
        """
        if self._run is not None and "u" in question:
            return self._run.send(vector3("the counts of drive", question["u"], unit="counts"))
        self._run = None  # who asks for something else has left the run
        match question.get("op"):
            case "begin":
                return self._told()
            case "look":
                return self._picture()
            case "practice":
                return self._begun(
                    min(number("seconds of practice", question.get("seconds"), ">= 0"), self.left), race=False
                )
            case "race" if not self.raced:
                self.raced = True
                return self._begun(END, race=True)
            case "race":
                raise InputError("there is one race an arm, and it is over: practise on another arm")
        raise InputError(f"the bench cannot answer {str(question)[:80]}: ask it to look, run, drive or race")

    @property
    def score(self):
        """The score, s: the time of the last touch; if a ball is missing, that of the race and more for each."""
        missing = int(np.isnan(self.touched).sum())
        return END + MISSING * missing if missing else float(self.touched.max())

    @property
    def complete(self):
        """Tell whether all balls were touched."""
        return not np.isnan(self.touched).any()

    def _told(self):
        arm, nominal = self.given.arm, self.given.machine().nominal
        K, T = np.array(self.given.pinhole.K), self.given.T_cam_world
        seen = K @ (T[:3, :3] @ _CORNERS.T + T[:3, 3:])
        corners = (seen[:2] / seen[2]).T + self._rng.normal(0, 0.1, (4, 2))
        told = {
            "l": arm.l,
            "limits": (arm.q_min, arm.q_max),
            "start": START,
            "slope": nominal.slope,
            "zero": nominal.zero,
        }
        told |= {"K": K, "corners": corners, "points": _CORNERS, "nominal": self.given.nominal}
        told = {name: np.asarray(value).tolist() for name, value in told.items()}
        return told | {"delay": self.given.delay * PERIOD, "left": self.left}

    def _picture(self):
        from ir50p_lab.vision.rendering import Scene, SceneBall, render_scene  # OpenCV: not at import

        if self.pictures == 0:
            raise InputError(f"there are {PICTURES} pictures an arm, and all are taken: keep what you have seen")
        self.pictures -= 1
        balls = tuple(SceneBall(position=tuple(ball)) for ball in self.given.balls)
        scene = Scene(pinhole=self.given.pinhole, T_cam_world=self.given.T_cam_world, objects=balls)
        image, _ = render_scene(scene, seed=int(self._rng.integers(1 << 30)))
        return {"picture": base64.b64encode(zlib.compress(image.tobytes(), 1)).decode(), "shape": image.shape}

    def _begun(self, seconds, race):
        self._run = self._driven(seconds, race)
        return next(self._run)

    def _driven(self, seconds, race):
        """Yield what is measured in each period, and at last how it ended; takes the counts (3,) of each in return."""
        machine, began, inside = self.given.machine(), self.left, (None, 0)
        machine.noise(int(self._rng.integers(1, 1000)))
        queue = deque([np.zeros(3)], maxlen=self.given.delay + 1)
        queue.extend(np.zeros((self.given.delay, 3)))
        self.ended = "the time is over"
        for k in range(int(seconds / PERIOD + 1e-9)):
            if k:
                tip = self._moved(machine, queue[0], race)
                if tip is None:
                    self.ended = "it was under the table"
                    break
                inside = self._touching(tip, inside, k) if race else inside
                if race and self.complete:
                    self.ended = "all are touched"
                    break
            if race:
                self.path.append((k * PERIOD, machine.q_true))
            else:
                self.left = began - (k + 1) * PERIOD
            touched = int(BALLS - np.isnan(self.touched).sum())
            counts = yield {"t": k * PERIOD, "c": machine.counts().tolist(), "n": touched}
            queue.append(np.clip(np.rint(counts), -LIMIT, LIMIT))
        self._run = None
        yield {"ended": self.ended, "left": self.left}

    def _moved(self, machine, counts, race):
        """The tip (3,) a period later, or None under the table; looks twice a period. Knocks balls."""
        l1, l2, l3 = self.given.arm.l
        for _ in range(2):
            machine.advance(counts, PERIOD / 2)
            q1, q2, q3 = machine.q_true.tolist()
            out, elbow = l2 * math.cos(q2) + l3 * math.cos(q2 + q3), l1 + l2 * math.sin(q2)
            tip = np.array([out * math.cos(q1), out * math.sin(q1), elbow + l3 * math.sin(q2 + q3)])
            if min(elbow, tip[2]) < TABLE:
                return None
            if race:
                near = np.linalg.norm(tip - self.given.balls, axis=1) < KNOCK
                self.knocked |= np.isnan(self.touched) & near
        return tip

    def _touching(self, tip, inside, k):
        """(ball, periods) that the tip has been near the same ball without a break; marks it when it is touched."""
        near = np.linalg.norm(tip - self.given.balls - [0, 0, ABOVE], axis=1) < NEAR
        ball = int(np.argmax(near)) if near.any() else None
        periods = 0 if ball is None else 1 + inside[1] * (ball == inside[0])
        if periods * PERIOD >= HOLD - 1e-9 and not self.knocked[ball] and np.isnan(self.touched[ball]):
            self.touched[ball] = k * PERIOD
        return ball, periods
