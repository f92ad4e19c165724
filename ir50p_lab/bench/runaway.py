"""Runaway: a joint that does not do what its motor would make it do.

What do angle and command alone tell? Below, u is the command, K the motor's gain, fc dry friction, all
from the arm's own numbers, in PWM counts.

against   The joint moves against its command for `WINDOW` and does not slow down. Motor, back-EMF and friction then
          brake it with K|u| + b|qd| + fc; only something stronger keeps it going. Gravity is known; a payload or a
          hand is allowed `HAND` times the stall torque. Behind swapped wires the motor itself is that something: it
          seems twice as strong as it is, minus friction. A joint that is braked, or oscillates, slows down.
still     The angle stays within the noise, while a joint loaded by gravity, friction and `PAYLOAD` would have turned by
          `FRESH`; or by `HELD` if it has moved since the drive rose, because a hand may hold what moved before. Angle
          and command cannot tell a stuck potentiometer from a blocked joint or a motor without supply.
beyond    Driven with more than gravity and breakaway for `STRONG` s in all, the joint has not gone there. Gravity is
          the largest at any angle of its own, because a mirrored potentiometer gives a wrong angle, or that with
          `PAYLOAD`.
under     The measured tip lies more than `UNDER` under the table, for `LOW` blocks with drive or before the run's first
          drive: this cannot be, so an angle is wrong.
fast      Within two blocks the joint turns `FAST` times as fast as supply, gravity and payload together can turn it.

End stops and the table may hold a joint, and the table may lift it. Joint 3 is not judged by an angle of joint 2 that
may be wrong: it may stand still under its largest gravity. Angles are means over blocks of 50 ms without their
largest and smallest, so one disturbed sample counts for nothing. The same compiled function watches the loop in Python
and the compiled loop of the simulated arm.
"""

import math
from collections import namedtuple

import numpy as np

from ir50p_lab.bench.pace import cut_said
from ir50p_lab.errors import RunawayError
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.modelling.dynamics import mass_matrix
from ir50p_lab.simulation.plant import FC, FS, FV, GRAVITY, LENGTHS, LIMIT, Q_MAX, Q_MIN, TABLE, make_plant

AGAINST, STILL, FAST_ALARM, BEYOND, UNDER_ALARM = 10, 20, 30, 40, 50

BLOCK = 0.05  # s
WINDOW = 5  # blocks: a joint that moves against its command for 0.25 s and does not slow down raises the alarm
DELAY = 2  # blocks before the window in which the command had the same sign, too: a motor answers late
KEPT = WINDOW + 1 + DELAY
GAP = 0.3  # s: after a longer time without a sample the check begins anew
HAND = 1.2  # largest push of a hand or payload, as a share of the stall torque: 8 to 19 N at the tip of the IR50P
PAYLOAD = 0.3  # largest payload at the tip, kg
BREAKAWAY = 1.5  # largest breakaway friction to expect, as a share of the arm's own: greases age
FRESH, HELD = 0.1, 0.8  # rad
FAST = 1.5  # largest speed, as a share of what supply, gravity and payload together can reach
END, ABOVE = 0.12, 0.04  # rad from an end of travel, m above the table: there a joint may be held
UNDER, LOW = 0.05, 6  # m under the table, more than unlike potentiometers put it; blocks: 0.3 s
STRONG = 2.0  # s: a hand that holds a joint lets go before
NOISE = 3.0  # counts: while the means of blocks differ by less, the joint stands still


# What the check knows, arrays. Constants first: theta (3, 20) and numbers (33,) of the arm in PWM counts; lag (3,) s of
# the speed behind the drive; top (3,) rad/s: too fast; noise (3,) rad; load (3,) PWM counts per m of a payload's lever.
# Then what it remembers: now (3,): samples in the block, blocks kept, blocks `under`; block (n, 7): t, q and command of
# the last samples; past (KEPT, 7): of the last blocks, the command 0 where its sign changed, else the smallest. still
# (4, 3): speed and travel of the loaded joint, rad/s and rad, the angle it began at, and whether the joint has moved
# since. strong (2, 3): s of drive `beyond`, with its sign, and the angle farthest back since then, times that sign.
Watch = namedtuple("Watch", "theta numbers lag top noise load now block past still strong")


@jit()
def push(rows, new):
    """Move the rows of an array (n, k) up by one place, and put `new` (k,) into the last."""
    for i in range(rows.shape[0]):
        for j in range(new.size):
            rows[i, j] = rows[i + 1, j] if i + 1 < rows.shape[0] else new[j]


@jit()
def _still(w, i, q, u, load, held):
    """Whether joint i has stood still while the same joint under load would have turned; lets that one turn on."""
    n, dt, still = w.numbers, w.past[-1, 0] - w.past[-2, 0], w.still[:, i]
    excess = abs(u) - load
    idle = excess <= 0 or held or w.now[1] == 1
    if idle or abs(q - still[2]) > w.noise[i]:
        still[0], still[1], still[2], still[3] = 0.0, 0.0, q, 0.0 if idle else 1.0
        return False
    still[0] += min(1.0, dt / w.lag[i]) * (cf.sign(u) * excess / n[FV + i] - still[0])  # to and fro leads nowhere
    still[1] += still[0] * dt
    answered = cf.sign(u) * (still[1] - DELAY * dt * still[0])  # a motor answers late
    return answered > (HELD if still[3] > 0 else FRESH)


@jit()
def _beyond(w, i, q, u, most, held):
    """Whether joint i has been driven with |u| > most for STRONG in all, and has not gone there."""
    strong, along = w.strong[:, i], cf.sign(w.strong[0, i]) * q
    strong[1] = min(strong[1], along)
    if w.now[1] == 1 or along > strong[1] + w.noise[i]:
        strong[0] = 0.0
    if abs(u) > most and not held and w.now[1] > 1:
        if u * strong[0] <= 0:
            strong[0], strong[1] = 0.0, cf.sign(u) * q
        strong[0] += cf.sign(u) * (w.past[-1, 0] - w.past[-2, 0])
    return abs(strong[0]) > STRONG


@jit()
def _against(w, i, gravity):
    """Whether joint i has moved against its command through the window, without slowing down, too strongly."""
    n, t, q = w.numbers, w.past[DELAY:, 0], w.past[DELAY:, 1 + i]
    s = cf.sign(w.past[0, 4 + i])
    drive, travel = s * w.past[:, 4 + i], s * (q[:-1] - q[1:])
    if w.now[1] < KEPT or drive.min() <= 0 or travel.min() <= 0:
        return False
    before, after = (travel[0] + travel[1]) / (t[2] - t[0]), (travel[-2] + travel[-1]) / (t[-1] - t[-3])
    if after < before - w.noise[i] / (t[2] - t[0]):
        return False
    least = min(n[LIMIT + i], drive[DELAY + 1 :].min())
    return least + n[FV + i] * s * (q[0] - q[-1]) / (t[-1] - t[0]) + n[FC + i] > HAND * n[LIMIT + i] + s * gravity


@jit()
def _fast(w, i):
    """Whether joint i has turned faster within two blocks than it can."""
    travel, time = abs(w.past[-1, 1 + i] - w.past[-3, 1 + i]), w.past[-1, 0] - w.past[-3, 0]
    return w.now[1] >= 3 and travel > w.top[i] * time + 2 * w.noise[i]


@jit()
def tip_height(n, q):
    """Return the height of the tip above the table, m; n: numbers of the arm; q: (3,) rad."""
    return n[LENGTHS] + n[LENGTHS + 1] * math.sin(q[1]) + n[LENGTHS + 2] * math.sin(q[1] + q[2]) - n[TABLE]


@jit()
def _alarm(w):
    """The alarm at the end of a block, as `watch_step` returns it."""
    n, q, theta = w.numbers, w.past[-1, 1:4], w.theta
    c2, c3, c23 = math.cos(q[1]), math.cos(q[2]), math.cos(q[1] + q[2])
    l2, l3, upper, fore = n[LENGTHS + 1], n[LENGTHS + 2], theta[1, 2], theta[1, 3]
    gravity = (0.0, *cf.gravity_torques(theta, n[GRAVITY], c2, c23))
    turned = math.sqrt(max(0.0, upper * upper + fore * fore + 2 * upper * fore * c3))
    largest = (0.0, n[GRAVITY] * turned, n[GRAVITY] * abs(theta[2, 3]))  # at any angle of the joint
    rise = (0.0, l2 * c2 + l3 * c23, l3 * c23)  # of the tip, m/rad
    height = tip_height(n, q)
    w.now[2] = w.now[2] + 1 if height < -UNDER and np.abs(w.block[:, 4:]).max() > 0 else 0
    if w.now[2] >= LOW:
        return UNDER_ALARM
    for i in range(3):
        u = w.block[:, 4 + i].mean()  # not the smallest: the noise of a derivative is no rest
        s = cf.sign(u)
        supported = height < ABOVE and u * rise[i] < 0
        held = supported or (s < 0 and q[i] < n[Q_MIN + i] + END) or (s > 0 and q[i] > n[Q_MAX + i] - END)
        load = max(0.0, s * gravity[i]) + w.load[i] * max(0.0, s * rise[i])
        load = max(load, largest[i] if i == 2 else 0.0) + BREAKAWAY * n[FS + i]
        if _still(w, i, q[i], u, load, held):
            return STILL + i
        if _beyond(w, i, q[i], u, max(load, largest[i] + n[FS + i]), held):
            return BEYOND + i
        if _fast(w, i):
            return FAST_ALARM + i
        if not supported and _against(w, i, gravity[i]):
            return AGAINST + i
    return 0


@jit()
def watch_step(w, t, q, u):
    """Take a sample q (3,) rad at t s, and the command u (3,) PWM counts since the sample before.

    Returns: 0, or the alarm: AGAINST, STILL, FAST_ALARM or BEYOND, plus 0 to 2 for the joint; or UNDER_ALARM.
    """
    k, row = w.now[0], np.empty(7)
    if not 0 < t - w.block[-1, 0] < GAP:
        k = w.now[1] = w.now[2] = 0
    row[0] = t
    for i in range(3):
        row[1 + i], row[4 + i] = q[i], u[i]
    push(w.block, row)
    w.now[0] = k = (k + 1) % len(w.block)
    if k > 0:
        return 0
    for i in range(3):
        angles, drives = w.block[:, 1 + i], w.block[:, 4 + i]
        within = angles.sum() - angles.max() - angles.min()
        row[1 + i] = within / (angles.size - 2) if angles.size > 2 else angles.mean()
        row[4 + i] = max(drives.min(), 0.0) + min(drives.max(), 0.0)
    push(w.past, row)
    w.now[1] = min(w.now[1] + 1, KEPT)
    return _alarm(w)


class RunawayGuard:
    """Checks every sample of a run and raises RunawayError if a joint does not do what its motor would make it do.

    arm: Arm with actuators; calibration: counts to rad, from which the noise follows; period: s between two samples;
    table: its height, m (-inf: none); cut: a function that cuts the drive before an error is raised, and returns
    whether it is known to be off.
    """

    def __init__(self, arm, calibration, period, *, table=0.0, cut=lambda: True):
        plant = make_plant(arm, unit="PWM", stops=True, table=table)
        inertia = np.diag(mass_matrix(plant.theta, np.zeros(3)))  # stretched: the most
        damping, gravity = plant.numbers[FV : FV + 3], plant.numbers[GRAVITY]
        reach = np.array([0.0, arm.l[1] + arm.l[2], arm.l[2]])
        pull = np.abs([0.0, *cf.gravity_torques(plant.theta, gravity, 1.0, 1.0)])
        load = PAYLOAD * gravity / np.array(arm.actuators.gain)
        top, noise = FAST * (plant.limit + pull + load * reach) / damping, NOISE / np.abs(np.array(calibration.slope))
        block, past = np.zeros((max(1, round(BLOCK / period)), 7)), np.zeros((KEPT, 7))
        memory = np.zeros(3, dtype=np.int64), block, past, np.zeros((4, 3)), np.zeros((2, 3))
        self.watch = Watch(plant.theta, plant.numbers, inertia / damping, top, noise, load, *memory)
        self._driven, self._cut = False, cut
        watch_step(self.watch, -math.inf, np.zeros(3), np.zeros(3))  # compiles; forgotten at the first sample
        tip_height(self.watch.numbers, np.zeros(3))

    def check(self, sample, pwm):
        """Take the next Sample and the command (3,) PWM counts that acted before it. Raises RunawayError."""
        self.refuse(watch_step(self.watch, sample.t, sample.q, pwm), sample.t)

    def begin_anew(self):
        """Judge the joints anew from the next block: a hand is on the arm, and what it does is not a runaway."""
        self.watch.now[1] = 0

    def admit(self, pwm):
        """Raise RunawayError if pwm (3,), about to be sent, is the first drive and the tip lies under the table."""
        if not self._driven and pwm.any():
            now = self.watch.block[-1]
            self.refuse(UNDER_ALARM * (tip_height(self.watch.numbers, now[1:4]) < -UNDER), now[0])
            self._driven = True

    def refuse(self, alarm, t):
        """Raise the RunawayError for the alarm of `watch_step` in a sample at t s; do nothing if the alarm is 0."""
        if alarm == 0:
            return
        found, question = self._tip_found() if alarm == UNDER_ALARM else self._joint_found(alarm)
        found += f", at t = {t:.2f} s: {cut_said(self._cut())}"
        raise RunawayError(f"{found}. {question} `python3 -m ir50p_lab bench-test` finds out")

    def _tip_found(self):
        q = self.watch.block[-1, 1:4]
        depth = -100 * tip_height(self.watch.numbers, q)
        found = f"the tip is measured {depth:.0f} cm under the table, with the joints at {q.round(2).tolist()} rad"
        return found, "Has joint 2 or joint 3 the two ends of its potentiometer swapped, or one of its wires torn?"

    def _joint_found(self, alarm):
        joint, past = alarm % 10, self.watch.past
        angle, drive = past[-1, 1 + joint], self.watch.block[:, 4 + joint].mean()
        back = past[-3 if alarm >= FAST_ALARM else DELAY]
        speed = (angle - back[1 + joint]) / (past[-1, 0] - back[0])
        if alarm >= BEYOND:
            found = f"did not go where {drive:+.0f} PWM counts, more than gravity, drive it: it is at {angle:.3f} rad"
            question = "Are the two ends of its potentiometer swapped, has it come loose, or does something block it?"
        elif alarm >= FAST_ALARM:
            found = f"turned at {speed:+.2f} rad/s, and its motor can only do {self.watch.top[joint] / FAST:.2f} rad/s"
            question = "Is a wire or the track of its potentiometer torn, or the supply above the arm's actuators.V?"
        elif alarm >= STILL:
            found = f"stood still at {angle:.3f} rad although its command was {drive:+.0f} PWM counts"
            question = "Has its potentiometer come loose, does its motor lack supply, or does something block it?"
        else:
            found = f"ran at {speed:+.2f} rad/s against its command of {drive:+.0f} PWM counts and did not slow down"
            question = "Are its two motor wires, or the two ends of its potentiometer, swapped?"
        if joint == 2 and alarm >= STILL:
            question += " Its gravity hangs on joint 2: is that angle right?"
        return f"joint {joint + 1} {found}", question
