"""The contest: a controller drives arms that it has not seen, and the worst of five figures is its score.

Each run has a copy of the arm as the series scatters, with noise, a converter of 10 bits, dry friction, play, 30 ms of
delay and a payload; its potentiometers are calibrated. The arm takes up its weight for 3 s (not scored), makes a large
step of all joints (4 s) and a small one (3 s). The true angle is scored, by the figures of `step_metrics` and two of
our own, each divided by a limit that a careful hand can keep. The score is the *largest* of these quotients, over
joints and runs: what is saved in one does not help another. Below 1 is won. Simulated: no number here was measured.
"""

from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from ir50p_lab.bench.arm_instance import ArmInstance
from ir50p_lab.bench.simulated import SimulatedBench
from ir50p_lab.controllers.base import check_controller, is_compiled
from ir50p_lab.controllers.pid import PID
from ir50p_lab.course import lab_book
from ir50p_lab.errors import LabError
from ir50p_lab.modelling.chain import frames
from ir50p_lab.modelling.named_arms import load_arm
from ir50p_lab.signals import steps

UNIT = ArmInstance(delay=3, pot_bow=(0, 0, 0), slope_spread=0, shift_spread=0, bow_spread=0)
TIMES, END = (0.0, 3.0, 7.0), 10.0  # s: hold, large step, small step
LARGE, SMALL = 0.6, 0.15  # rad, each joint's step within 30 % of it, up or down
PAYLOAD = 0.2  # largest payload, as a share of the forearm's mass
BAND = 0.03  # rad: about five counts of the potentiometers
#: What is scored, and the most of it that wins.
LIMITS = MappingProxyType({
    "large step": (3.0, "s until it stays within 30 mrad"),
    "small step": (2.0, "s until it stays within 30 mrad"),
    "overshoot": (0.20, "rad beyond the target"),
    "rest error": (0.025, "rad, mean of the last second"),
    "activity": (44.0, "counts that the command swings by within 0.1 s, mean"),
})  # fmt: skip
PRACTICE = (1, 2, 3)  # seeds that everybody may look at
RUNS = 9  # arms of an attempt: on three, gains that fail one arm in five won every second time
_LOST = 1e6  # score kept for a cut drive: it is infinite, which JSON cannot hold
_PERIOD = 0.01
_MOMENT = 10  # samples over which the swing of the command is taken: holding a command does not make it smaller


@dataclass(frozen=True)
class Draw:
    """One arm of the contest.

    poses: (3, 3) rad, held from the TIMES; payload: kg at the tip; copy: its number in the series.
    """

    poses: np.ndarray
    payload: float
    copy: int

    @property
    def reference(self):
        """The poses as a reference."""
        return steps(TIMES, self.poses)


@dataclass(frozen=True)
class Score:
    """How a controller did.

    terms: (5, 3), the largest of each figure in LIMITS, per joint; fault: why the bench cut the drive, "" if it did
    not.

    value: the largest term divided by its limit; won: whether that is below 1; decides: the name of that term, and the
    joint (1, 2, 3).
    """

    terms: np.ndarray
    fault: str = ""

    @property
    def quotients(self):
        """The terms divided by their limits, (5, 3)."""
        return self.terms / np.array([limit for limit, _ in LIMITS.values()])[:, None]

    @property
    def value(self):
        """The score: the largest quotient."""
        return float(self.quotients.max())

    @property
    def won(self):
        """Whether every term keeps its limit."""
        return self.value < 1

    @property
    def decides(self):
        """The name of the worst term, and its joint."""
        term, joint = np.unravel_index(np.argmax(self.quotients), self.terms.shape)
        return list(LIMITS)[term], int(joint) + 1

    def __str__(self):
        if self.fault:
            return f"lost: the bench cut the drive. {self.fault}"
        rows = [f"{'':12s}  joint 1  joint 2  joint 3   limit"]
        never = [TIMES[2] - TIMES[1], END - TIMES[2], *[np.inf] * 3]  # outside the band to the end
        for (name, (limit, unit)), row, end in zip(LIMITS.items(), self.terms, never, strict=True):
            marks = [f"{x:7.3g}{' ' if x < limit else '!'}" if x < end else "  never!" for x in row]
            rows.append(f"{name:12s} {' '.join(marks)} {limit:7.3g} {unit}")
        term, joint = self.decides
        outcome = "won" if self.won else "lost"
        rows.append(f"score {self.value:.2f}, {outcome} (below 1 wins); {term} of joint {joint} decides")
        return "\n".join(rows)


@lru_cache(maxsize=32)
def draw(arm, seed):
    """Return the Draw of a seed: poses in the inner 70 % of the travel, elbow and tip at least 8 cm above the table."""
    rng = np.random.default_rng(seed)
    low, high = (np.clip(limit, -np.pi, np.pi) for limit in (arm.q_min, arm.q_max))
    low, high = low + 0.15 * (high - low), high - 0.15 * (high - low)
    payload, copy = PAYLOAD * arm.m[2] * rng.uniform(), int(rng.integers(1, 10**6))
    sizes = np.array([LARGE, SMALL])[:, None]
    while True:
        jumps = sizes * rng.uniform(0.7, 1.3, (500, 2, 3)) * rng.choice([-1, 1], (500, 2, 3))
        poses = np.cumsum(np.concatenate([rng.uniform(low, high, (500, 1, 3)), jumps], axis=1), axis=1)
        poses = poses[((poses > low) & (poses < high)).all(axis=(1, 2))]
        heights = frames(arm, poses.reshape(-1, 3))[:, 2:, 2, 3].reshape(len(poses), -1)
        if (heights > 0.08).all(axis=1).any():
            chosen = poses[np.argmax((heights > 0.08).all(axis=1))]
            chosen.flags.writeable = False
            return Draw(chosen, payload, copy)


def drive(controller, seed, arm=None):
    """Drive the arm of a seed. Returns Draw, Recording (what the controller saw and sent) and true angles (1000, 3).

    controller: any object with `step(t, q, reference)`, in PWM counts; the package's PID runs compiled.
    Raises LabError if the bench cuts the drive, and whatever the controller raises.
    """
    arm = load_arm() if arm is None else arm
    given = draw(arm, seed)
    bench = SimulatedBench(
        arm.with_payload(given.payload), unit=UNIT, seed=given.copy, q0=given.poses[0], record_to=False, period=_PERIOD
    ).open()
    recording = bench.follow(controller, given.reference, END)
    return given, recording, bench.truth.q  # left open: closing would only let a simulated arm sink for 3 s


def grade_run(given, u, q):
    """Return the five figures of LIMITS for a run, (5, 3): u (1000, 3) commands in counts, q (1000, 3) true angles."""
    first, second, end = (round(t / _PERIOD) for t in (*TIMES[1:], END))
    found = np.zeros((5, 3))
    for k, part in enumerate((slice(first, second), slice(second, end))):
        error = given.poses[k + 1] - q[part]
        side = np.sign(given.poses[k + 1] - given.poses[k])
        outside = np.abs(error) > BAND
        found[k] = _PERIOD * (len(error) - np.argmax(outside[::-1], axis=0)) * outside.any(axis=0)
        found[2] = np.maximum(found[2], np.max(-side * error, axis=0))
        found[3] = np.maximum(found[3], np.abs(np.mean(error[-100:], axis=0)))
        moments = np.lib.stride_tricks.sliding_window_view(u[part], _MOMENT, axis=0)
        found[4] = np.maximum(found[4], np.mean(np.ptp(moments, axis=-1), axis=0))
    return found


def score(controller, seeds=PRACTICE, arm=None):
    """Return the Score of a controller on the arms of `seeds`, which everybody may look at.

    A cut drive has lost (inf).
    """
    check_controller(controller)
    try:
        return score_of([drive(controller, seed, arm) for seed in seeds])
    except LabError as fault:
        return Score(np.full((5, 3), np.inf), str(fault))


def score_of(runs):
    """Return the Score of a list of what `drive` has returned."""
    return Score(np.max([grade_run(given, recording.u, q) for given, recording, q in runs], axis=0))


def contest(controller, name):
    """Enter the contest on RUNS arms drawn for this attempt only; print term by term; keep the attempt, won or lost.

    controller: any object with `step`; this object itself runs, in Python, not a twin. name: what you changed, kept
    with the attempt and shown in `history`. Returns the Score. Raises what the controller raises: then the attempt is
    lost.
    """
    check_controller(controller)
    arm = load_arm()
    seeds = [int(seed) for seed in np.random.default_rng().integers(1000, 2**31, RUNS)]
    entry = {"name": str(name), "arm": arm.name, "seeds": seeds, "at": lab_book.now(), "decides": ("large step", 1)}
    # lost until it has ended: else whoever stops on an unlucky arm could enter until all are lucky
    before = _keep(entry | {"score": _LOST})
    try:
        found = score_of([drive(controller, seed, arm) for seed in seeds])
    except LabError as fault:
        found = Score(np.full((5, 3), np.inf), str(fault))
    _keep(entry | {"score": min(found.value, _LOST), "decides": found.decides})
    print(found)
    best = min(before, default=_LOST)  # where every drive was cut there is none
    if found.value < best:
        print(f"attempt {len(before) + 1}: the best so far")
    elif best < _LOST:
        print(f"attempt {len(before) + 1}: the best is {best:.2f}, attempt {before.index(best) + 1}")
    return found


def _keep(entry):
    """Write an attempt into the lab book, in place of its first form. Returns the scores of those before it."""

    def edit(book):
        book["contest"] = [one for one in book["contest"] if one["seeds"] != entry["seeds"]]
        before = [one["score"] for one in book["contest"]]
        book["contest"].append(entry)
        return before

    return lab_book.change(edit)


def twin_of(controller, arm=None):
    """Return the compiled PID that does what this controller does, or None.

    It is built from the gains `kp`, `ki`, `kd`. Both see the same angles of a practice run, noise included, and have to
    send the same commands to within a thousandth of a count.
    """
    if is_compiled(controller):
        return controller
    try:
        twin = PID(controller.kp, controller.ki, controller.kd, limit_pwm=255)
    except (AttributeError, LabError):
        return None
    given, recording, _ = drive(twin, PRACTICE[0], arm)
    twin.reset()
    if hasattr(controller, "reset"):
        controller.reset()
    rows = given.reference.sample(recording.t)
    for t, q, r in zip(recording.t, recording.q, rows, strict=True):
        theirs = np.asarray(controller.step(t, q.copy(), r.copy()), dtype=float)
        if theirs.shape != (3,) or not np.abs(theirs - twin.step(t, q, r)).max() < 1e-3:
            return None
    return PID(controller.kp, controller.ki, controller.kd, limit_pwm=255)
