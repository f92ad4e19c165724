"""Reaching for what the camera sees: look, plan, move, look again and correct; pick and place; follow."""

import contextlib
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np

from ir50p_lab.errors import CameraError, UnreachableError, VisionError
from ir50p_lab.inputs import number, whole
from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.vision.arguments import coordinates
from ir50p_lab.vision.reaching.moving import Mover
from ir50p_lab.vision.reaching.plan import plan, reach_pose
from ir50p_lab.vision.reaching.reach_result import BallTracker, FollowLog, Look, Reached

HEIGHT = 0.06  # m: height of the tip over the ball's centre, 30 mm over its top
# Counts: standard deviation of a potentiometer's errors, calibrated and nominal (assumed: a good wire-wound one)
_COUNTS, _COUNTS_NOMINAL = 0.7, 2.5
_MOVED = 0.008  # m: if two looks see the ball farther apart, it has moved, and only the second counts
_LOST = 0.5  # s: if no look has shown the ball for longer, it is not known where it rolls
_ARM_LAG = 0.04  # s: delay of the tip behind its moving aim (simulated arms: 0.03 to 0.06 s)
_CAMERA_LAG = 0.1  # s: age of a webcam's picture (assumed: exposure, transfer, a picture that waits)


class Reacher(Mover):
    """The arm on an open bench, driven by what a BallLocator sees; every phase runs in one loop without a pause.

        with connect() as bench, Reacher(bench, locator) as reacher:
            found = reacher.reach()

    The drive stays on from the first command to the end of the `with` block, where the arm moves to its rest pose:
    between two runs a board would cut it, and the arm would sink onto the ball. While a real camera takes its picture
    and the picture is processed, the loop goes on in this thread and the camera works in another.

    Args:
        bench: an open bench. locator: BallLocator; one of rendered pictures raises CameraError for a real arm.
        controller: default `reaching_controller(arm)`. rest: whether to go to the rest pose at the end.

    The potentiometers' standard deviation is taken as 0.7 counts if the bench's calibration was measured (a
    characteristic is not quite the straight line that is fitted), and as 2.5 if it is a nominal one.

    Methods: reach, pick, put, follow_ball, look, move_to, move_along, hold. Attributes: q: (3,) rad, best estimate;
    sigma_q: (3,) rad, that deviation.
    """

    def __init__(self, bench, locator, *, controller=None, rest=True):
        super().__init__(bench, controller=controller, rest=rest)
        self.locator, self._pool = locator, ThreadPoolExecutor(1)
        self._refuse_drawn(getattr(locator.camera, "simulated", False))
        measured = bench.calibration.stderr_slope is not None
        self.sigma_q = (_COUNTS if measured else _COUNTS_NOMINAL) / np.abs(bench.calibration.slope)

    # ---- looking

    def look(self):
        """Look with the camera while the loop goes on. Returns Seen."""
        job = self._look()
        while not job.done():
            self.hold(self.bench.period)
        return job.result()

    def _look(self):
        """A Future of Seen: from another thread if the clock runs meanwhile; else it is done, by this one."""
        if not self.bench.simulated or getattr(self.bench, "realtime", False):
            return self._pool.submit(self._see)
        done = Future()
        done.set_result(self._see())
        return done

    def _see(self):
        seen = self.locator.look()
        self._refuse_drawn(seen.simulated)
        return seen

    def _refuse_drawn(self, drawn):
        """Refuse a rendered picture for a real arm: it would move among real things to where a ball was drawn."""
        if drawn and not self.bench.simulated:
            remedy = "open a webcam with open_camera(0), or take the simulated arm, connect('simulated')"
            raise CameraError(f"{self.bench.name} is a real arm, but the picture is rendered: {remedy}")

    # ---- tasks

    def reach(self, *, height=HEIGHT, looks=2):
        """Put the tip above the ball, `height` m above its centre; look again from there and correct.

        looks: 1: one look, then potentiometers alone; 2: after arriving the camera sees where ball and hand really
        are, and the hand is moved by the difference.
        Returns: Reached. Raises UnreachableError before anything moves; VisionError if no ball
        is seen, with the reason.
        """
        looks, records = whole("looks", looks, 1, 3), []
        over = np.array([0.0, 0.0, number("height", height, unit="m")])
        ball = self._sure(self.look()).position
        goal = ball + over
        self.move_along(plan(self.arm, self.q, goal))
        for again in reversed(range(looks)):
            q = self.settle(reach_pose(self.arm, goal, self.q))
            marker, notes, stood = None, [], self._last.t
            if again:
                ball, marker, q = self._look_again(ball, q, notes)
                try:
                    reach_pose(self.arm, ball + over)
                    goal = ball + over
                except UnreachableError:  # a ball that has rolled away must not let the arm fall
                    notes.append("the ball is out of reach now: the arm stays")
            records.append(Look(marker, self.errors.copy(), "; ".join(notes), stood))
        simulated = self.bench.simulated and hasattr(self.bench, "plant")
        return Reached(
            ball=ball,
            goal=ball + over,
            tip=forward_kinematics(self.arm, q),
            q=q,
            looks=tuple(records),
            tip_true=self.bench.plant.tip_true if simulated else None,
        )

    def _sure(self, seen):
        if not seen:
            raise VisionError(f"no ball to reach for: {seen.reason}")
        return seen

    def _look_again(self, ball, q, notes):
        """See ball and hand again: (ball, marker or None, corrected q); adds to `notes` what did not go as planned."""
        seen = self.look()
        if not seen:
            notes.append(f"the ball is not seen from here ({seen.reason}): its first place is kept")
        elif np.linalg.norm(seen.position - ball) > _MOVED:
            notes.append(f"the ball has moved by {1e3 * np.linalg.norm(seen.position - ball):.0f} mm")
            ball = seen.position
        else:
            ball = 0.5 * (ball + seen.position)
        marker = self.locator.find_marker(seen.image, self.arm, q)
        if marker is None:
            notes.append("the marker on the hand is not seen: the potentiometers are not corrected")
            return ball, None, q
        try:
            e = self.locator.joint_errors(self.arm, q, marker, self.sigma_q)
        except VisionError as error:
            notes.append(str(error))
            return ball, marker, q
        self.errors = self.errors + e
        return ball, marker, q + e

    def pick(self):
        """Reach, go down, close the gripper about the ball's middle, go up again.

        Whether the arm reaches down there is tested before anything moves.
        Returns: the Reached of the reach. Raises the same as `reach`. Only another look tells whether the ball came
        along.
        """
        reach_pose(self.arm, self._sure(self.look()).position)
        self.grip(False, 0.1)
        found = self.reach()
        self.move_to(found.ball, lift=0.0)
        self.grip(True)
        self.move_to(found.goal, lift=0.0)
        return found

    def put(self, place):
        """Carry what the gripper holds to `place` (2,) m on the table, open the gripper, go up.

        Raises InputError for a bad place, UnreachableError before anything moves.
        """
        down = np.array([*coordinates("place", place, 2, "m"), self.locator.radius])
        up = down + np.array([0.0, 0.0, HEIGHT])
        reach_pose(self.arm, up)
        self.move_to(down, lift=HEIGHT)
        self.grip(False)
        self.move_to(up, lift=0.0)

    def follow_ball(self, seconds, *, height=0.10, every=0.1, lead=None, progress=False):
        """Keep the tip above a moving ball: look every `every` s, filter position and velocity, aim ahead.

        The arm first moves on a planned trajectory, clear of the table, to where the ball is seen; `seconds` count from
        there. lead: how far ahead it aims, s: the delay of camera and arm together. A larger lead puts the tip ahead of
        the ball, a smaller one behind it, by the difference times the ball's speed. Default: 0.04 s, for the arm, with
        rendered pictures, which show this moment; 0.1 s more with any other camera (assumed of a webcam: if you have
        measured yours, give the sum). height: of the tip above the ball's centre, m.
        If the ball cannot be followed (out of reach, or not seen for 0.5 s), the arm waits at the last place.
        progress: whether a bar is shown. Returns: FollowLog.
        """
        from tqdm.auto import tqdm

        from ir50p_lab.bench.set_point import SetPoint

        seconds, every = number("seconds", seconds, "> 0", unit="s"), number("every", every, ">= 0", unit="s")
        height, seen = number("height", height, unit="m"), self._sure(self.look())
        if lead is None:
            lead = _ARM_LAG if seen.simulated else _ARM_LAG + _CAMERA_LAG
        lead = number("lead", lead, unit="s")
        self.move_along(plan(self.arm, self.q, seen.position + np.array([0.0, 0.0, height])))
        tracker, log, point = BallTracker(), [], SetPoint(self._set, speed=0.6)
        begin = next_look = last_seen = self._last.t
        job = self._frozen = None
        with tqdm(total=seconds, unit="s", desc="following", leave=False, disable=not progress) as bar:
            while self._last.t - begin < seconds:
                t = self._last.t
                bar.update(t - begin - bar.n)
                if job is None and t >= next_look:
                    next_look = t + every
                    taken, job = t, self._look()
                if job is not None and job.done():
                    seen, job = job.result(), None
                    if seen:
                        tracker.update(taken, seen.position[:2])
                        last_seen = t
                if t - last_seen > _LOST:
                    tracker = BallTracker()
                if tracker.position is not None:
                    aim = np.array([*tracker.at(t + lead), self.locator.radius + height])
                    with contextlib.suppress(ValueError):  # UnreachableError: wait
                        point.move_to(reach_pose(self.arm, aim, self.q) - self.errors)
                rows = point(t)
                self._set = rows[0]
                self._cycle(rows)
                t = self._last.t  # of the readings that this cycle has brought
                tip = forward_kinematics(self.arm, self._last.q + self.errors)
                log.append((t - begin, tip, tracker.at(t), tracker.velocity))
        self.hold(0.3)
        return FollowLog(*(np.array(column) for column in zip(*log, strict=True)), lead=lead)


def reach(bench, locator, *, height=HEIGHT, looks=2, **options):
    """Reach once on an open bench, and go back to rest: `Reacher` in one call.

    bench, locator, options: as of `Reacher`; height m, looks: as of its `reach`, and so is what it returns and raises.
    """
    with Reacher(bench, locator, **options) as reacher:
        return reacher.reach(height=height, looks=looks)
