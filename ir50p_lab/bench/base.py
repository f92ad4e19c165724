"""What every bench promises: one loop, whether a board, a simulated arm or a recording answers."""

import abc
import math
from typing import NamedTuple

import numpy as np

from ir50p_lab.bench.recorder import Recorder
from ir50p_lab.bench.rest import rest_pose, way_to_rest
from ir50p_lab.bench.runaway import RunawayGuard
from ir50p_lab.errors import BenchError, InputError
from ir50p_lab.inputs import check_arm, check_controller, check_reference

JOINTS = 3
LIMIT_PWM = 255


class Sample(NamedTuple):
    """What the bench says once per period.

    t: s since the run began, when it was measured; q: (3,) rad, through the calibration; counts: (3,) counts of the
    10-bit converter (quarters where the board averages); missed: cycles that came late so far in this run.
    """

    t: float
    q: np.ndarray
    counts: np.ndarray
    missed: int


class Bench(abc.ABC):
    """The arm on the bench, opened with `connect()`; `with` guarantees that the drive ends.

    ============================ ====================================================================================
    for sample in run(seconds)   one `Sample` every `period`; in the body call `drive` once
    drive(pwm)                   PWM counts (3,) in -255..255 for the joints; returns what was really sent
    recording                    the Recording of the last run, complete up to the last sample
    cut()                        drive off at once (the bridges brake)
    start(controller, reference) the same loop in the background, for the live panel
    close()                      go to the rest pose, let go, give the port free
    ============================ ====================================================================================

    A command holds until the next one, at most to the end of its run. Leaving `with` in order moves the arm to its
    rest pose, where it stays without drive, and then lets go; leaving it by an error or Ctrl-C cuts the drive at once,
    and the arm sinks as gravity has it.

    Subclasses supply `_open`, `_begin`, `_measure`, `_send`, `_cut` and `_close`.

    Attributes: arm: Arm (limits, kinematics); calibration: counts to rad; period: s; simulated: bool; name: str;
    bench_id: which bench it is, on which results are measured, as 'board-0a1b2c' or 'simulated-unit-0' (None: nobody
    knows, or the board has none yet); recording: Recording of the last run (None before).
    """

    kind = "bench"
    simulated = False
    bench_id = None
    guarded = True  # whether a runaway is cut; off only while the motors have no supply
    own_process = False  # whether a loop in the background gets a process of its own

    def __init__(self, arm, calibration, *, period=0.01, record_to=None, name=None):
        """record_to: folder for recordings (default: recordings/ in the student's folder), False for none on disk."""
        arm = check_arm(arm)
        if not (isinstance(period, int | float | np.number) and 0.001 <= period <= 1.0):
            raise InputError(f"period = {period!r} s: give 0.001 to 1 s (the thesis samples every 0.01 s)")
        self.arm, self.calibration, self.period = arm, calibration, float(period)
        self.name = name or f"{self.kind} {arm.name}"
        self.recording = None
        self._record_to = record_to
        self._is_open = self._running = False
        self._pwm, self._gripper = np.zeros(JOINTS), False
        self._last, self._recorder = None, None
        self._live = None  # the LiveRun that has the arm, or had it last
        self._travel = tuple(zip(arm.q_min, arm.q_max, strict=True))

    # ---- what a subclass supplies

    @abc.abstractmethod
    def _open(self):
        """Get hold of the arm; no drive yet."""

    @abc.abstractmethod
    def _begin(self):
        """A run begins: its time is zero now."""

    @abc.abstractmethod
    def _measure(self, k):
        """Wait for cycle k of the run, measure, keep the present command alive: (t, counts (3,), missed)."""

    @abc.abstractmethod
    def _send(self, pwm, gripper):
        """Send the command: pwm (3,) whole numbers within the limit, gripper bool. Returns what was applied."""

    @abc.abstractmethod
    def _cut(self):
        """Drive off at once; must work in any state and never raise."""

    @abc.abstractmethod
    def _close(self):
        """Give everything free; must work in any state."""

    def _radians(self, counts):
        """Angles of the counts just measured; only a recording knows better."""
        return self.calibration.radians(counts)

    def _header(self):
        """More lines for the head of a recording: dict of str."""
        return {}

    def _make_guard(self):
        """What looks at every exchange of the run that begins, or None.

        Its check(sample, pwm) gets each Sample before the program does, and the command (3,) PWM counts that the motors
        had since the sample before. What it raises cuts the drive and ends the run. An arm without actuators has none:
        nobody knows what its motors can do.
        """
        if not self.guarded or self.arm.actuators is None:
            return None
        return RunawayGuard(self.arm, self.calibration, self.period)

    def _arguments(self):
        """Keyword arguments that make the same bench in another process; needed if `own_process`."""
        raise NotImplementedError(f"{type(self).__name__} has own_process, so it must define _arguments()")

    # ---- the contract

    def open(self):
        """Get hold of the arm (`with` and `connect()` do it). Returns the bench."""
        if not self._is_open:
            self._open()
            self._is_open = True
        return self

    @property
    def is_open(self):
        """Whether the arm is in hand."""
        return self._is_open

    def __enter__(self):
        return self.open()

    def __exit__(self, kind, error, traceback):
        if error is None:
            self.close()
        else:
            self.abort()

    def close(self):
        """Go to the rest pose, let go, and give the port free. May be called twice."""
        if not self._is_open:
            return
        try:
            if self._live is not None:
                self._live.stop()  # brings the arm to its rest pose
            self._end_run()
            if self._last is not None:  # never moved: nothing to bring back
                self.go_to_rest()
        finally:
            self.abort()

    def abort(self):
        """Cut the drive and give the port free, at once. May be called twice."""
        if not self._is_open:
            return
        self.cut()
        self._end_run()
        self._is_open = False
        self._close()

    def cut(self):
        """Drive off at once; a run in a cell goes on without it until the next `drive`, one in the background ends."""
        if self._live is not None and not self._live.is_here():
            self._live.cut()
        self._pwm = np.zeros(JOINTS)
        self._cut()

    def run(self, seconds, *, record=True, **header):
        """Yield one Sample every period for `seconds`; drive the arm in the loop's body.

        record: whether the run is recorded; header: further lines for the head of its recording (gains, a note).
        Raises InputError for a bad duration, BenchError if the bench is not open or already runs, BoardLostError if
        the board stops answering. On any error the drive is cut first.
        """
        return self._cycles(self._number_of_cycles(seconds), record, header)

    def _number_of_cycles(self, seconds):
        if not (isinstance(seconds, int | float | np.number) and math.isfinite(seconds) and seconds > 0):
            raise InputError(f"seconds = {seconds!r}: give how long to run, in seconds, > 0")
        self._take_back()
        if not self._is_open:
            raise BenchError("the bench is closed: open it with `with connect() as bench:` and run inside the block")
        return max(1, round(seconds / self.period))

    def _take_back(self):
        """Have the arm back from a loop in the background that is over; BenchError if it is not."""
        if self._live is not None and not self._live.is_here():
            self._live.give_back()
            self._live = None

    def _cycles(self, cycles, record, header):
        self._end_run()  # of a loop that was left by break
        recorder = self._start_recorder(header) if record else None
        self._recorder, self._running = recorder, True
        self._pwm = np.zeros(JOINTS)
        try:
            self._begin()
            guard = self._make_guard()
            for k in range(cycles):
                t, counts, missed = self._measure(k)
                sample = Sample(t, self._radians(counts), counts, missed)
                self._last = sample
                if guard is not None:
                    guard.check(sample, self._pwm)
                self._reference = None
                yield sample
                if recorder is not None:
                    recorder.write(sample, self._pwm, self._reference, self._gripper)
        except GeneratorExit:  # the loop was left by break
            if recorder is not None and self._recorder is recorder:
                try:
                    recorder.write(sample, self._pwm, self._reference, self._gripper)
                except BaseException:  # a full disk; nobody may hear of it while a generator is closed
                    self.cut()
                    raise
            raise
        except BaseException:
            self.cut()
            raise
        finally:
            if self._recorder is recorder:
                self._end_run()

    def head(self):
        """What the head of a recording says of this bench: dict of str."""
        return {
            "arm": self.arm.name,
            "kind": self.kind,
            "bench": self.name,
            "bench_id": self.bench_id or "none",
            "simulated": str(self.simulated).lower(),
            "period_s": f"{self.period:g}",
            **self.calibration.header(),
            **self._header(),
        }

    def _start_recorder(self, header):
        head = self.head() | {name: str(value) for name, value in header.items()}
        recorder = Recorder(head, folder=self._record_to)
        self.recording = recorder.recording
        return recorder

    def _end_run(self):
        recorder, self._recorder, self._running = self._recorder, None, False
        if recorder is not None:
            recorder.close()

    def drive(self, pwm, *, gripper=None, reference=None):
        """Send PWM counts to the three joints; they hold until the next call.

        Args:
            pwm: (3,), -255..255; sign is direction. Rounded to whole counts, limited, and set to 0 for a joint at an
            end of its travel that would be driven further out.
            gripper: True closes, False opens, None leaves it. reference: q (3,) rad, only to be recorded beside.

        Returns: what was really sent, (3,) PWM counts.
        Raises InputError if pwm is no three finite numbers (the drive is cut first), BenchError outside a run.
        """
        if not self._running:
            self.cut()
            raise BenchError("drive() works only inside `for sample in bench.run(...)`: outside nothing keeps watch")
        try:
            command = np.asarray(pwm, dtype=float)
        except (TypeError, ValueError):
            command = np.full(JOINTS, np.nan)
        if command.shape != (JOINTS,) or not math.isfinite(command[0] + command[1] + command[2]):
            self.cut()
            raise InputError(f"pwm = {pwm!r}: give three finite numbers of PWM counts; the drive has been cut")
        limited = []  # scalars: for three numbers arrays take longer than the arm
        for u, q, (low, high) in zip(command.tolist(), self._last.q.tolist(), self._travel, strict=True):
            out = (q <= low and u < 0) or (q >= high and u > 0)
            limited.append(0.0 if out else min(max(float(round(u)), -LIMIT_PWM), LIMIT_PWM))
        command = np.array(limited, dtype=float)
        if gripper is not None:
            self._gripper = bool(gripper)
        self._reference = reference
        self._pwm = self._send(command, self._gripper)
        return self._pwm

    def note(self, text):
        """Write into the recording what has just been changed (gains, a payload): it stands between the samples."""
        if self._recorder is not None and self._last is not None:
            self._recorder.event(self._last.t, text)

    def follow(self, controller, reference, seconds, *, record=True, **header):
        """Run `controller` on `reference` for `seconds`; the loop of the lesson in one call.

        Returns the Recording (None with record=False). Raises InputError if these are no controller and reference.
        """
        check_controller(controller)
        check_reference(reference)
        controller.reset() if hasattr(controller, "reset") else None
        for sample in self.run(seconds, record=record, **{**header_of(controller), **header}):
            target = reference(sample.t)
            self.drive(controller.step(sample.t, sample.q, target), reference=target[0])
        return self.recording if record else None

    def start(self, controller, reference, **options):
        """Run `controller` on `reference` in the background; see `bench.background`. Returns its handle."""
        from ir50p_lab.bench.background import start

        return start(self, controller, reference, **options)

    def go_to_rest(self):
        """Move to the rest pose, where the arm stays when let go; not recorded."""
        controller, reference = way_to_rest(self.arm, self._last.q, self.period)
        for sample in self.run(reference.duration + 0.5, record=False):
            self.drive(controller.step(sample.t, sample.q, reference(sample.t)))
        self.cut()

    @property
    def rest_pose(self):
        """The pose (3,) rad where the arm is let go."""
        return rest_pose(self.arm)


def header_of(controller):
    """The gains of a controller for the head of a recording, if it tells them."""
    return controller.header() if hasattr(controller, "header") else {}
