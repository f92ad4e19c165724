"""What every bench promises: one loop, whether a board, a simulated arm or a recording answers."""

import contextlib
import math

import numpy as np

from ir50p_lab.bench.calibration import nominal_calibration
from ir50p_lab.bench.caps import Caps
from ir50p_lab.bench.pace import Clock, CountedPace, Pace, cut_said, undisturbed
from ir50p_lab.bench.protocol import JOINTS, LIMIT_PWM
from ir50p_lab.bench.recorder import Recorder, header_of
from ir50p_lab.bench.rest import trajectory_to_rest
from ir50p_lab.bench.run import Run, Sample
from ir50p_lab.bench.runaway import RunawayGuard
from ir50p_lab.controllers.base import check_controller, check_reference
from ir50p_lab.errors import BenchError, InputError, LabError
from ir50p_lab.inputs import number
from ir50p_lab.modelling.chain import lengths
from ir50p_lab.modelling.named_arms import load_arm

__all__ = ["Bench", "Sample"]


class Bench:
    """The arm on the bench, opened with `connect()`; `with` guarantees that the drive ends.

    ============================ ====================================================================================
    for sample in run(seconds)   one `Sample` every `period`; call `drive` once in the body of the loop
    drive(pwm)                   send PWM counts (3,), -255..255, to the joints; returns what was really sent
    recording                    the Recording of the last run, complete up to the last sample
    cut()                        cut the drive at once (the bridges brake)
    start(controller, reference) run the same loop in the background, for the live panel
    close()                      go to the rest pose, let go, release the port
    ============================ ====================================================================================

    A command holds until the next one, at most to the end of its run. If `with` is left in order, the arm moves to its
    rest pose, where it stays without drive, and is then let go. If it is left by an error or Ctrl-C, the drive is cut
    at once, and the arm sinks under gravity.

    Subclasses supply `measure` and, where there is something to do, `_open`, `_begin`, `_send`, `_cut` and `_close`.

    A `Run` uses `measure`, `radians` and `timing` of its bench, and writes `last`.

    Attributes: arm: Arm (limits, kinematics); calibration: counts to rad; period: s; simulated: bool; name: str;
    bench_id: the bench on which results are measured, such as 'board-0a1b2c' or 'simulated-unit-0' (None: it is not
    known, or the board has no id yet); is_open: whether the bench has been opened; live_run: the LiveRun that has the
    arm, or had it last; recording: Recording of the last run (None before); command: PWM counts (3,) that the motors
    have; gripper: whether it is closed; last: the Sample measured last (None before).
    """

    kind = "bench"
    simulated = False
    answers = True  # whether drive moves the arm
    bench_id = recording = live_run = last = _run = None
    guarded = True  # whether a runaway is cut; off only while the motors have no supply
    caps = Caps()
    table = 0.0  # its height, m: a tip far below cannot be; -inf where that is not asked

    def __init__(self, arm=None, calibration=None, *, period=0.01, record_to=None, name=None):
        """arm: default `load_arm()`; calibration: default the nominal one.

        record_to: folder for recordings (default: recordings/ in the student's folder), False for none on disk.
        """
        arm = load_arm() if arm is None else arm
        lengths(arm)  # refuses what is not an Arm
        if not (isinstance(period, int | float | np.number) and 0.001 <= period <= 1.0):
            raise InputError(f"period = {period!r} s: give 0.001 to 1 s (the thesis samples every 0.01 s)")
        self.arm, self.calibration, self.period = arm, calibration or nominal_calibration(arm), float(period)
        self.name = name or f"{self.kind} {arm.name}"
        self.record_to = record_to
        self.is_open, self._clock = False, Clock
        self.command, self.gripper = np.zeros(JOINTS), False
        self._travel = tuple(zip(arm.q_min, arm.q_max, strict=True))

    # ---- what a subclass supplies

    def _open(self):
        """Get hold of the arm; no drive yet."""

    def _begin(self):
        """A run begins: its time is zero now."""

    def measure(self, cycle, drive):
        """Measure in this cycle of the run; with `drive` the present command is kept alive, else the drive is off.

        Returns: t (s), counts (3,), and whether the watchdog had cut the drive before, so that it is off now.
        """

    def _send(self, pwm, gripper):
        """Send the command: pwm (3,) whole numbers within the limit, gripper bool."""

    def _cut(self):
        """Drive off at once; must work in any state and never raise. Returns whether it is known to be off."""
        return True

    def _close(self):
        """Release everything; must work in any state."""

    def radians(self, counts):
        """Return the angles (3,) rad of the counts just measured.

        (A replay overrides this with its recorded angles.)
        """
        return self.calibration.radians(counts)

    def _header(self):
        """More lines for the head of a recording: dict of str."""
        return {}

    def _make_pace(self):
        """Return the timer of a run: CountedPace, or Pace on a bench that follows the clock."""
        return CountedPace()

    def timing(self, run):
        """Return the timing of a run for the end of its recording: dict, empty on a bench that simulates time."""
        if not isinstance(run.pace, Pace):
            return {}
        return {"late_cycles": run.pace.missed, "watchdog_trips": run.trips}

    def _make_guard(self):
        """Return the guard that checks every sample of the run that begins, or None.

        Its check(sample, pwm) gets each Sample before the program does, and the command (3,) PWM counts that the motors
        had since the sample before. What it raises cuts the drive and ends the run. An arm without actuators has none:
        nobody knows what its motors can do.
        """
        if not self.guarded or self.arm.actuators is None:
            return None
        return RunawayGuard(self.arm, self.calibration, self.period, table=self.table, cut=self.cut)

    def _arguments(self):
        """Keywords with which a process of its own makes this bench for its loops in the background; None: a thread."""
        return None

    # ---- the contract

    def open(self):
        """Open the bench and take hold of the arm (`with` and `connect()` do it). Returns the bench."""
        if not self.is_open:
            self._open()
            self.is_open = True
        return self

    __enter__ = open

    def __exit__(self, kind, error, traceback):
        if error is None:
            self.close()
        else:
            self.abort()

    def close(self):
        """Move to the rest pose, let go, and release the port. May be called twice."""
        if not self.is_open:
            return
        try:
            if self.live_run is not None:
                self.live_run.stop()  # brings the arm to its rest pose
            self._end_run()
            if self.last is not None:  # never moved: nothing to bring back
                self.go_to_rest()
        finally:
            self.abort()

    def abort(self):
        """Cut the drive and release the port at once. May be called twice."""
        if not self.is_open:
            return
        self.cut()
        self._end_run()
        self.is_open = False
        self._close()

    def cut(self):
        """Cut the drive at once. A run in a cell goes on without it until the next `drive`; one in the background ends.

        Returns: whether the drive is known to be off. If not, the board has not answered, and it brakes by itself
        within 0.1 s.
        """
        if self.live_run is not None:
            self.live_run.cut()
        self.command = np.zeros(JOINTS)
        return self._cut()

    def run(self, seconds, reference=None, *, record=True, **header):
        """Yield one Sample every period for `seconds`; drive the arm in the loop's body.

        reference: target(t) -> (q, qd, qdd), handed out as `sample.reference`; record: whether the run is recorded;
        header: further lines for the head of its recording (gains, a note).

        On a bench that follows the clock the drive is cut if the program sends no command for 0.1 s. This becomes an
        event in the recording, and the next exchange only measures. A pause of more than 0.5 s ends the run.

        Raises InputError for a bad duration, for a reference that is not finite, leaves the joint limits or is farther
        than 2 rad from the measured pose, and for what the lab's own file does not allow (`caps`); BenchError if the
        bench is not open or already runs; PauseError after a pause; BoardLostError if the board stops answering. On
        any error the drive is cut first.
        """
        if reference is not None:
            check_reference(reference)
        return self._cycles(self._number_of_cycles(seconds), reference, record, header)

    def _number_of_cycles(self, seconds):
        seconds = number("seconds", seconds, "> 0", unit="s", hint="how long to run")
        if self.live_run is not None and not self.live_run.is_here():
            self.live_run.give_back()  # BenchError while it runs
            self.live_run = None
        if not self.is_open:
            raise BenchError("the bench is closed: open it with `with connect() as bench:` and run inside the block")
        return max(1, round(seconds / self.period))

    def _cycles(self, cycles, reference, record, header):
        with self._running(reference, record, header) as run:
            while (sample := run.next_sample(cycles)) is not None:
                yield sample
                if run.fault is not None:  # drive() has raised it, and the loop's body caught it
                    raise run.fault

    @contextlib.contextmanager
    def _running(self, reference, record, header):
        """A Run from its beginning to its end; an error cuts the drive first."""
        self._end_run()  # of a loop that was left by break
        run = self._run = Run(self, reference)
        self.command = np.zeros(JOINTS)
        try:
            if record:
                head = self.head() | {name: str(value) for name, value in header.items()}
                run.recorder = Recorder(head, folder=self.record_to)
                self.recording = run.recorder.recording
            self._begin()
            run.guard, run.pace = self._make_guard(), self._make_pace()
            with undisturbed() if isinstance(run.pace, Pace) else contextlib.nullcontext():
                yield run
        except GeneratorExit:  # the loop was left by break
            raise
        except BaseException as error:
            self.cut()
            if isinstance(error, LabError) and error is not run.fault:
                self.note(f"the run was ended: {error}")
            raise
        finally:
            if self._run is run:
                self._end_run()

    def head(self):
        """Return what the head of a recording says about this bench: dict of str."""
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

    def _end_run(self):
        run, self._run = self._run, None
        if run is not None:
            run.end_recording()

    def drive(self, pwm, *, gripper=None, reference=None):
        """Send PWM counts to the three joints; they hold until the next call.

        Args:
            pwm: (3,), -255..255; the sign is the direction. They are rounded to whole counts, limited, and set to 0 for
            a joint that is at an end of its travel and would be driven further out.
            gripper: True closes it, False opens it, None leaves it. reference: q (3,) rad, which is only recorded.

        Returns: what was really sent, (3,) PWM counts; zeros after a pause in which the drive was cut.
        Raises InputError if pwm is not three finite numbers, or more than the lab's own file allows (the drive is cut
        first), BenchError outside a run, PauseError if the program has paused for longer than 0.5 s.
        """
        run = self._run
        if run is None:
            self.cut()
            raise BenchError("drive() works only inside `for sample in bench.run(...)`: outside nothing keeps watch")
        if run.fault is not None:
            raise run.fault
        try:
            command = self._command_of(pwm)
            self.caps.check("the command", "limit_pwm", command)
        except InputError as error:
            raise InputError(f"{error}; {cut_said(self.cut())}") from None
        if run.pace.begins_anew() or run.paused(run.pace.silence()):
            return np.zeros(JOINTS)
        if run.guard is not None:
            run.guard.admit(command)
        run.pace.armed = True
        if gripper is not None:
            self.gripper = bool(gripper)
        if reference is not None:
            run.aim = reference
        self._send(command, self.gripper)
        self.command = command
        return command.copy()

    def _command_of(self, pwm):
        """`pwm` in whole counts, within the limit and not beyond the ends of the travel; or InputError."""
        try:
            given = np.asarray(pwm)
            if given.dtype.kind not in "iufO" or len(given) != JOINTS or not all(map(math.isfinite, given.tolist())):
                raise TypeError
        except Exception:  # whatever the conversion of a stranger raises
            raise InputError(f"pwm = {pwm!r:.60}: give three finite numbers of PWM counts") from None
        limited = []  # scalars: for three numbers arrays take longer than the arm
        for u, q, (low, high) in zip(given.tolist(), self.last.q.tolist(), self._travel, strict=True):
            out = (q <= low and u < 0) or (q >= high and u > 0)
            limited.append(0.0 if out else min(max(float(round(u)), -LIMIT_PWM), LIMIT_PWM))
        return np.array(limited)

    def note(self, text, t=None):
        """Write into the recording what has just been changed (gains, a payload).

        t: time of the change, s; default: that of the last sample.
        """
        if self._run is not None and self._run.recorder is not None and self.last is not None:
            self._run.recorder.event(self.last.t if t is None else t, text)

    def follow(self, controller, reference, seconds, *, record=True, **header):
        """Run `controller` on `reference` for `seconds`: the loop of the lesson in one call.

        Returns: the Recording (None with record=False). Raises InputError if these are not a controller and a
        reference, and whatever `run` and `drive` raise.
        """
        check_controller(controller)
        check_reference(reference)
        controller.reset() if hasattr(controller, "reset") else None
        for sample in self.run(seconds, reference, record=record, **{**header_of(controller), **header}):
            self.drive(controller.step(sample.t, sample.q, sample.reference))
        return self.recording if record else None

    def start(self, controller, reference=None):
        """Run `controller` on `reference` in the background; see `bench.background`. Returns its LiveRun."""
        from ir50p_lab.bench.background import start

        return start(self, controller, reference)

    def go_to_rest(self):
        """Move to the rest pose, where the arm stays when it is let go. This run is not recorded."""
        controller, reference = trajectory_to_rest(self.arm, self.last.q, self.period, *self.caps[:2])
        for sample in self.run(reference.duration + 0.5, record=False):
            self._run.capped = False
            self.drive(controller.step(sample.t, sample.q, reference(sample.t)))
        self.cut()
