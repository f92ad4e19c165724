"""Runaway: a joint that does not do what its motor would make it do.

What can be told apart from angle and command alone? Below, u is the command, K the motor's gain, fc dry friction, all
from the arm's own numbers, in PWM counts.

against   The joint moves against its command for `WINDOW` and does not slow down. Motor, back-EMF and friction then
          brake it with K|u| + b|qd| + fc; only something stronger keeps it going. Gravity is known; a payload or a
          hand is allowed `HAND` times the stall torque. Behind swapped wires the motor itself is that something: it
          looks twice as strong as it is, less friction. A joint that is braked, or oscillates, slows down.
still     The angle stays within the noise, while a joint loaded by gravity, friction and `PAYLOAD` would have turned by
          `FRESH`; by `HELD` if it has moved since the drive rose: a hand may hold what moved before. Angle and command
          do not tell a stuck potentiometer from a blocked joint or a motor without supply.
fast      Within two blocks the joint turns `FAST` times as fast as supply, gravity and payload together can turn it.

End stops and the table may hold a joint, and the table may lift it. Angles are means over blocks of 50 ms without their
largest and smallest, so one disturbed sample counts for nothing. The same compiled function watches the loop in Python
and the compiled loop of the simulated arm.
"""

from typing import NamedTuple

import numpy as np

from ir50p_lab.errors import RunawayError
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.modelling.dynamics import mass_matrix
from ir50p_lab.simulation.plant import FC, FORCE_SCALE, FS, FV, GRAVITY, LENGTHS, LIMIT, Q_MAX, Q_MIN, make_plant

AGAINST, STILL, FAST_ALARM = 1, 2, 3

BLOCK = 0.05  # s
WINDOW = 5  # blocks, 0.25 s: a hand or a swing that lasts longer and does not slow down is no brake
DELAY = 2  # blocks before them with the same sign of the command: what was sent acts later
KEPT = WINDOW + 1 + DELAY
GAP = 0.3  # s without a sample: what was before says nothing about what comes
HAND = 1.2  # of the stall torque; 8 to 19 N at the tip of the IR50P
PAYLOAD = 0.3  # kg at the tip
BREAKAWAY = 1.5  # times the arm's own: greases age
FRESH, HELD = 0.1, 0.8  # rad
FAST = 1.5
END, TABLE = 0.12, 0.04  # rad from an end of travel, m above the table: there a joint may be held
NOISE = 3.0  # counts within which the mean of a block that stands still stays


class Watch(NamedTuple):
    """What the check knows. Constants first: theta (3, 20) and numbers (33,) of the arm in PWM counts; lag (3,) s of
    the speed behind the drive; top (3,) rad/s: too fast; noise (3,) rad.

    Then what it remembers: now (2,): samples in the block, blocks kept; clock (KEPT,) s, q (KEPT, 3) rad and drive
    (KEPT, 3), 0 where its sign changed: the last blocks; block (n, 3), t (n,), u (3,): the present one. still (4, 3):
    speed and way of the loaded joint, rad/s and rad, the angle it began at, and whether the joint has moved since.
    """

    theta: np.ndarray
    numbers: np.ndarray
    lag: np.ndarray
    top: np.ndarray
    noise: np.ndarray
    now: np.ndarray
    clock: np.ndarray
    q: np.ndarray
    drive: np.ndarray
    block: np.ndarray
    t: np.ndarray
    u: np.ndarray
    still: np.ndarray


def make_watch(arm, calibration, period):
    """The Watch of an Arm with actuators; calibration gives the noise; period: s between two samples."""
    plant = make_plant(arm, unit="PWM", stops=True, table=0.0)
    limit, damping = plant.numbers[LIMIT : LIMIT + 3], plant.numbers[FV : FV + 3]
    inertia = np.diag(mass_matrix(plant.theta, np.zeros(3)))  # stretched: the most
    reach = np.array([0.0, arm.l[1] + arm.l[2], arm.l[2]])
    pull = np.array([0.0, *cf.gravity_torques(plant.theta, plant.numbers[GRAVITY], 1.0, 1.0)])
    load = PAYLOAD * plant.numbers[GRAVITY] * reach / arm.actuators.gain
    n = max(1, round(BLOCK / period))
    return Watch(
        theta=plant.theta,
        numbers=plant.numbers,
        lag=inertia / damping,
        top=FAST * (limit + np.abs(pull) + load) / damping,
        noise=NOISE / np.abs(np.array(calibration.slope)),
        now=np.zeros(2, dtype=np.int64),
        clock=np.zeros(KEPT),
        q=np.zeros((KEPT, 3)),
        drive=np.zeros((KEPT, 3)),
        block=np.zeros((n, 3)),
        t=np.zeros(n),
        u=np.zeros(3),
        still=np.zeros((4, 3)),
    )


@jit()
def _middle(x):
    """Mean of x (n,) without its largest and smallest."""
    if x.size < 3:
        return x.mean()
    return (x.sum() - x.max() - x.min()) / (x.size - 2)


@jit()
def _weights(w, q):
    """Gravity torque (3,) and the rise of the tip per radian (3,) at q (3,); the tip's height."""
    n = w.numbers
    s2, c2 = cf.sincos(q[1])
    s23, c23 = cf.sincos(q[1] + q[2])
    g2, g3 = cf.gravity_torques(w.theta, n[GRAVITY], c2, c23)
    rise3 = n[LENGTHS + 2] * c23
    rise2 = n[LENGTHS + 1] * c2 + rise3
    height = n[LENGTHS] + n[LENGTHS + 1] * s2 + n[LENGTHS + 2] * s23
    return (0.0, g2, g3), (0.0, rise2, rise3), height


@jit()
def _still(w, i, dt, q, gravity, rise, supported):
    """Whether joint i has stood still while the same joint under load would have turned; lets that one turn by dt s."""
    n, u, still = w.numbers, w.u[i], w.still
    s = cf.sign(u)
    payload = PAYLOAD * n[GRAVITY] * n[FORCE_SCALE + i] * max(0.0, s * rise[i])
    excess = abs(u) - max(0.0, s * gravity[i]) - payload - BREAKAWAY * n[FS + i]
    at_end = (s < 0 and q[i] < n[Q_MIN + i] + END) or (s > 0 and q[i] > n[Q_MAX + i] - END)
    idle = excess <= 0 or at_end or supported
    if idle or abs(q[i] - still[2, i]) > w.noise[i]:
        still[0, i], still[1, i], still[2, i], still[3, i] = 0.0, 0.0, q[i], 0.0 if idle else 1.0
        return False
    still[0, i] += min(1.0, dt / w.lag[i]) * (excess / n[FV + i] - still[0, i])
    still[1, i] += still[0, i] * dt
    return still[1, i] > (HELD if still[3, i] > 0 else FRESH)


@jit()
def _against(w, i, gravity):
    """Whether joint i has moved against its command through the window, without slowing down, too strongly."""
    n, q, t = w.numbers, w.q[DELAY:, i], w.clock[DELAY:]
    s = cf.sign(w.drive[0, i])
    least = n[LIMIT + i]
    for k in range(KEPT):
        if s * w.drive[k, i] <= 0:
            return False
        if k > DELAY:
            least = min(least, s * w.drive[k, i])
    for k in range(WINDOW):
        if s * (q[k + 1] - q[k]) >= 0:
            return False
    before, after = s * (q[0] - q[2]) / (t[2] - t[0]), s * (q[-3] - q[-1]) / (t[-1] - t[-3])
    if after < before - w.noise[i] / (t[2] - t[0]):
        return False
    speed = s * (q[0] - q[-1]) / (t[-1] - t[0])
    return least + n[FV + i] * speed + n[FC + i] > HAND * n[LIMIT + i] + s * gravity[i]


@jit()
def watch_step(w, t, q, u):
    """Take a sample q (3,) rad at t s, and the command u (3,) PWM counts since the one before.

    Returns: 0, or the alarm: 3 (kind - 1) + joint, kind AGAINST, STILL or FAST_ALARM, joint 1 to 3.
    """
    count, kept = w.now[0], w.now[1]
    last = w.t[count - 1] if count > 0 else w.clock[KEPT - 1]
    if (count > 0 or kept > 0) and not 0 < t - last < max(GAP, 3.0 * BLOCK):
        count = kept = 0
        w.still[:] = 0.0
    for i in range(3):
        w.block[count, i] = q[i]
        if count == 0:
            w.u[i] = u[i]
        elif u[i] * w.u[i] <= 0:
            w.u[i] = 0.0
        elif abs(u[i]) < abs(w.u[i]):
            w.u[i] = u[i]
    w.t[count] = t
    count += 1
    if count < w.t.size:
        w.now[0], w.now[1] = count, kept
        return 0
    w.now[0], w.now[1] = 0, min(kept + 1, KEPT)
    for k in range(KEPT - 1):
        w.clock[k] = w.clock[k + 1]
        for i in range(3):
            w.q[k, i], w.drive[k, i] = w.q[k + 1, i], w.drive[k + 1, i]
    w.clock[KEPT - 1] = t
    for i in range(3):
        w.q[KEPT - 1, i], w.drive[KEPT - 1, i] = _middle(w.block[:, i]), w.u[i]
    return _alarm(w)


@jit()
def _alarm(w):
    """The alarm at the end of a block, as `watch_step` returns it."""
    q, kept = w.q[KEPT - 1], w.now[1]
    gravity, rise, height = _weights(w, q)
    for i in range(3):
        supported = height < TABLE and w.u[i] * rise[i] < 0
        if kept == 1:
            w.still[2, i] = q[i]
        elif _still(w, i, w.clock[KEPT - 1] - w.clock[KEPT - 2], q, gravity, rise, supported):
            return 3 * (STILL - 1) + i + 1
        if kept >= 3:
            way, time = abs(q[i] - w.q[KEPT - 3, i]), w.clock[KEPT - 1] - w.clock[KEPT - 3]
            if way > w.top[i] * time + 2 * w.noise[i]:
                return 3 * (FAST_ALARM - 1) + i + 1
        if kept == KEPT and not supported and _against(w, i, gravity):
            return 3 * (AGAINST - 1) + i + 1
    return 0


class RunawayGuard:
    """Looks at every sample of a run and raises RunawayError when a joint does not do what its motor makes it do.

    arm: Arm with actuators; calibration: counts to rad; period: s between two samples.
    """

    def __init__(self, arm, calibration, period):
        self.watch = make_watch(arm, calibration, period)

    def check(self, sample, pwm):
        """Take the next Sample and the command (3,) PWM counts that acted before it. Raises RunawayError."""
        self.judge(watch_step(self.watch, sample.t, sample.q, pwm), sample.t)

    def judge(self, alarm, t):
        """Raise the RunawayError that `watch_step` means by `alarm`, of a sample at t s; 0: nothing."""
        if alarm == 0:
            return
        kind, joint = (alarm - 1) // 3 + 1, (alarm - 1) % 3
        w = self.watch
        drive, back = w.drive[-1, joint], -3 if kind == FAST_ALARM else DELAY
        speed = (w.q[-1, joint] - w.q[back, joint]) / (w.clock[-1] - w.clock[back])
        found, question = {
            AGAINST: (
                f"ran at {speed:+.2f} rad/s against its command of {drive:+.0f} PWM counts and did not slow down",
                "Are its two motor wires, or the two ends of its potentiometer, swapped? (A hand would need more than "
                f"{HAND:g} times the motor's torque.)",
            ),
            STILL: (
                f"stood still at {w.q[-1, joint]:.3f} rad although its command was {drive:+.0f} PWM counts",
                "Has its potentiometer come loose, has its motor no supply, or does something block it?",
            ),
            FAST_ALARM: (
                f"turned at {speed:+.2f} rad/s, and its motor can only do {w.top[joint] / FAST:.2f} rad/s",
                "Is a wire or the track of its potentiometer torn, or the supply higher than the arm's actuators.V?",
            ),
        }[kind]
        raise RunawayError(
            f"joint {joint + 1} {found}, at t = {t:.2f} s: the drive has been cut. {question} "
            "`python3 -m ir50p_lab bench-test` finds out"
        )
