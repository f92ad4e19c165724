"""The arm driven in one loop without a pause: along references, to points, and standing still where it should."""

import numpy as np

from ir50p_lab.errors import BenchError
from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.modelling.dynamics import gravity
from ir50p_lab.vision.reaching.plan import LIFT, plan

_DAY = 86400.0  # s: the longest run
_SETTLE, _WINDOW, _WINDOWS = 0.6, 0.4, 15  # s: wait for the arm to stand, average readings for, at most so many times
# m at the tip, by averaged readings: the arm has arrived if it is nearer to its goal; it rests if it moved by less.
SETTLED, _RESTING = 1e-3, 2e-3
ACCEPTED = 1.5e-3  # m at the tip, by a second of readings with the command frozen: if it is nearer, it stays there


def reaching_controller(model, period=0.01, limit_pwm=255):
    """Return the controller for reaching: computed torque with a slow integral; without motor data the PIDs of 4.1-4.3.

    Its gains were tried out on simulated arms. It is stiff (12 rad/s), so that a joint that breaks loose does not jump
    far, and compensates two periods of delay; the gains of Tables 4.5-4.7 (5, 3, 7 rad/s) leave centimetres at the tip.
    model: Arm, or what `identify` returns; None: the PIDs. limit_pwm: what the lab allows, a number or (3,). period: s.
    """
    from ir50p_lab.controllers import PID, ComputedTorque

    if model is None or getattr(model, "actuators", model) is None:
        return PID(kp=(289, 225, 270), ki=(50, 150, 50), kd=(40, 30, 30), limit_pwm=limit_pwm, period=period)
    return ComputedTorque(model, kp=150, kd=24, ki=30, limit_pwm=limit_pwm, period=period, delay=2 * period)


class Mover:
    """The arm on an open bench as one run: `with Mover(bench) as mover: mover.move_to(p)`.

    The drive stays on from the first command to the end of the `with` block, where the arm moves to its rest pose:
    between two runs a board would cut it, and the arm would sink.

    Args:
        bench: an open bench. controller: default `reaching_controller(arm)`; on a real arm the PIDs, because a
        model of it must be measured first.
        rest: whether to go to the rest pose at the end.

    Attributes: q: (3,) rad, best estimate of where the set point is; errors: (3,) rad, by how much the potentiometers
    are off here: they show q - errors.
    """

    def __init__(self, bench, *, controller=None, rest=True):
        self.bench, self.arm, self.rest = bench, bench.arm, rest
        known = bench.arm if bench.simulated else None
        self.controller = controller or reaching_controller(known, bench.period, bench.caps.limit_pwm)
        self.errors = np.zeros(3)
        self._samples = self._last = self._gripper = self._frozen = None
        self._u = self._mean_u = np.zeros(3)

    # ---- the loop

    def __enter__(self):
        if hasattr(self.controller, "reset"):
            self.controller.reset()
        self._samples = self.bench.run(_DAY)
        self._last = next(self._samples)
        self._set = np.array(self._last.q)  # what the potentiometers shall show
        self._drive((self._set, np.zeros(3), np.zeros(3)))
        self.hold(0.3)
        return self

    def __exit__(self, kind, error, traceback):
        if kind is not None:
            self.bench.cut()
        self._samples.close()
        if kind is None and self.rest:
            self.bench.go_to_rest()

    def _drive(self, rows):
        u = self.controller.step(self._last.t, self._last.q, rows)
        u = u if self._frozen is None else self._frozen
        self._u = self.bench.drive(u, reference=rows[0], gripper=self._gripper)

    def _cycle(self, rows):
        self._last = next(self._samples, None)
        if self._last is None:
            raise BenchError("the run of this bench is over (a replay has ended, or a day is over): begin a new one")
        self._drive(rows)
        return self._last

    @property
    def q(self):
        """Best estimate of where the arm's set point is, (3,) rad."""
        return self._set + self.errors

    # ---- motions

    def hold(self, seconds):
        """Stay for `seconds`. Returns the mean of the measured angles, (3,) rad as the potentiometers show them."""
        rows = (self._set, np.zeros(3), np.zeros(3))
        shown, u = np.zeros(3), np.zeros(3)
        cycles = max(1, round(seconds / self.bench.period))
        for _ in range(cycles):
            shown += self._cycle(rows).q
            u += self._u
        self._mean_u = u / cycles
        return shown / cycles

    def move_along(self, reference):
        """Follow a reference of the arm's angles from its start to its end."""
        start, self._frozen = self._last.t, None
        period, seconds = self.bench.period, max(reference.duration, 0.3)
        t = np.arange(0.0, seconds + period, period)
        rows = reference.sample(t)
        shown = rows[:, 0] - self.errors
        # the set point may still have corrections of the last stop, which the start has not: fade them out
        shown += np.maximum(0.0, 1.0 - t / max(0.3, 0.5 * seconds))[:, None] * (self._set - shown[0])
        k = 0
        while k < len(t) - 1:
            k = min(round((self._last.t - start) / period) + 1, len(t) - 1)  # by the clock: a late cycle skips ahead
            self._set = shown[k]
            self._cycle((self._set, rows[k, 1], rows[k, 2]))

    def move_to(self, p, *, lift=LIFT):
        """Move the tip to p (3,) m on a trajectory clear of the table, and settle. Returns the trajectory."""
        trajectory = plan(self.arm, self.q, p, lift=lift)
        self.move_along(trajectory)
        self.settle(np.array(trajectory.points[-1]))
        return trajectory

    def settle(self, goal):
        """Stand at the joint angles `goal` (3,) rad: averaged readings show the error, and the set point is corrected.

        A joint that sticks waits until the integral has built up; moving the set point by the error shortens that. Once
        the arm is there, the command is frozen: friction holds the arm, nothing oscillates, and a second of readings is
        averaged, which has a tenth of the noise and rounding of a single one.
        Returns: the measured angles (3,) rad, averaged and corrected.
        """
        wanted = goal - self.errors
        self._set, self._frozen = wanted.copy(), None
        last = self.hold(_SETTLE)
        for _ in range(_WINDOWS):
            shown = self.hold(_WINDOW)
            resting, last = self._tip_size(goal, shown - last) < _RESTING, shown
            if not resting:
                continue
            if self._tip_size(goal, wanted - shown) > SETTLED:
                self._set = self._set + 0.7 * (wanted - shown)
                continue
            self._frozen = self._holding(goal)
            self.hold(0.1)
            last = self.hold(1.0)
            if self._tip_size(goal, wanted - last) < ACCEPTED:
                break
            self._frozen = None  # it slid on, or the shorter average was near by chance
        return last + self.errors

    def _holding(self, q):
        """A command under which a resting arm stays at rest, (3,): the recent mean, kept near what the weight needs.

        A joint in motion would slide on under a command that Coulomb friction does not hold; so at most half of that
        friction is left beside the weight.
        """
        if self.arm.actuators is None or self.controller.unit != "PWM":
            return self._mean_u
        weight = gravity(self.arm.theta_pwm, q) + np.array(self.arm.friction.Tf) / self.arm.actuators.gain
        room = 0.5 * np.array(self.arm.friction.fc) / self.arm.actuators.gain
        return np.clip(self._mean_u, weight - room, weight + room)

    def _tip_size(self, q, dq):
        return float(np.linalg.norm(forward_kinematics(self.arm, q + dq) - forward_kinematics(self.arm, q)))

    def grip(self, closed=True, seconds=0.6):
        """Close or open the gripper, and wait for `seconds`."""
        self._gripper = bool(closed)
        self.hold(seconds)
