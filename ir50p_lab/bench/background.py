"""`bench.start(controller, reference)`: the loop of the lesson in the background, and the handle of it.

On hardware it has a process of its own: nothing the notebook does can make it late, and it outlives nobody. The child
is told over a pipe what to run, opens the port itself and answers over another pipe. It cuts the drive when its parent
dies, however that dies; if the child itself dies, no more frames come and the board cuts after 100 ms.
"""

import contextlib
import math
import os
import pickle
import subprocess
import sys
import tempfile
import threading
from dataclasses import dataclass

import cloudpickle
import numpy as np

from ir50p_lab.bench import loop_process, shared_loop
from ir50p_lab.bench.live_loop import live_loop
from ir50p_lab.bench.pace import warm_up
from ir50p_lab.bench.recording import Recording
from ir50p_lab.bench.set_point import checked_reference, checked_set_point
from ir50p_lab.bench.shared_loop import SharedLoop
from ir50p_lab.controllers.base import GAINS, check_controller, check_reference, gains, gains_of
from ir50p_lab.errors import BenchError, InputError

_TO_REST = 60.0  # s: a way to the rest pose that takes longer has failed
_OBEYED = 0.25  # s: a loop that has not taken the order to cut by then hangs
_OPENED_WITHIN = 80.0  # s: a cold start imports and compiles, and a board restarts when its port is opened


def start(bench, controller, reference=None, *, seconds=None, lead_in=True, rest=True):
    """Run `controller` on `reference` in the background, in real time; the notebook stays free.

    The same cycles as `for sample in bench.run(...)`. On a simulated or replayed arm they run in a thread, on
    hardware in a process of their own, which cuts the drive when this one dies; both get copies of controller and
    reference, which must therefore be sendable (a controller that holds an open file is not).

    Args:
        bench: open Bench. controller: step(t, measured, reference) -> u.
        reference: target(t) -> (q, qd, qdd); None: hold the pose measured at the start.
        seconds: of the reference, None: until stopped. lead_in: if the reference begins elsewhere than the arm
        stands, first move there smoothly. rest: afterwards move to the rest pose before letting go.

    Returns: LiveRun. Raises BenchError if the bench is closed or busy, InputError for bad arguments, and what opening
    the port raises.
    """
    check_controller(controller)
    if reference is not None:
        check_reference(reference)
        checked_reference(bench.arm, 0.0, reference(0.0))
    bench._number_of_cycles(1.0 if seconds is None else seconds)  # it is open, and no other loop has it
    if bench._run is not None:
        raise BenchError("a run in a cell has the arm: end its loop first")
    try:
        cargo = cloudpickle.dumps((controller, reference))  # whoever defined them
    except Exception as error:
        raise InputError(
            f"controller or reference cannot be sent to the loop in the background ({error}): let them hold numbers "
            "and functions only, no files, widgets or benches"
        ) from None
    run = bench.live_run = LiveRun(bench, controller, {"seconds": seconds, "lead_in": lead_in, "rest": rest})
    if bench.own_process:
        run._begin_process(cargo)
    else:
        run._begin_thread(cargo)
    return run


@dataclass(frozen=True)
class LoopStatistics:
    """How well the loop keeps time.

    cycles, missed, trips (times the drive was cut because the loop had paused): counts since the start; period_p50,
    period_p99, period_max: s between measurements; busy_p50: s from having a sample until its command was sent. The
    times are of the last 80 s at most; NaN before there are any.
    """

    cycles: int
    missed: int
    trips: int = 0
    period_p50: float = math.nan
    period_p99: float = math.nan
    period_max: float = math.nan
    busy_p50: float = math.nan

    def __str__(self):
        if not self.cycles:
            return "no cycle yet"
        p50, p99, largest = (1e3 * x for x in (self.period_p50, self.period_p99, self.period_max))
        cuts = f", {self.trips} cuts of the drive by pauses" if self.trips else ""
        return (
            f"{self.cycles} cycles, {self.missed} late{cuts}; period {p50:.2f} ms median, {p99:.2f} ms 99 %, "
            f"{largest:.2f} ms longest; {1e3 * self.busy_p50:.2f} ms from sample to command"
        )


@dataclass(frozen=True)
class LiveSamples:
    """The last samples: t (n,) s, q (n, 3) rad, u (n, 3) PWM counts as sent, reference (n, 3) rad; trips (k,) s, of the
    samples at which the drive had been cut because the loop had paused.
    """

    t: np.ndarray
    q: np.ndarray
    u: np.ndarray
    reference: np.ndarray
    trips: np.ndarray


class LiveRun:
    """A loop in the background: made by `bench.start`.

    ================================ ==========================================================================
    stop()                           end it in order: to the rest pose, then let go
    cut()                            drive off within a cycle, and the loop ends; the arm sinks
    set_gains(kp=, ki=, kd=)         from the next cycle on, without a bump; what is left out stays
    set_point([q1, q2, q3])          go there from where the reference is, at limited speed; rad
    recent(10)                       the last 10 s: .t .q .u .reference
    statistics()                     cycles, late ones, periods
    join(timeout)                    wait for the end; raises what ended it early
    alive, phase, error, recording   whether it runs; what it does; what went wrong or None; the file
    ================================ ==========================================================================

    A thread of this process runs the loop, or listens to the process that does until it is gone.
    """

    def __init__(self, bench, controller, options):
        """options: of `live_loop`."""
        self._bench, self._options = bench, options
        self._memory = SharedLoop.shared() if bench.own_process else SharedLoop()
        self.error = None  # the exception that ended the loop
        self._gains = gains_of(controller)
        self._lock = threading.Lock()  # orders may come from several widgets' threads
        self._thread = threading.Thread(target=self._listen if bench.own_process else self._loop, daemon=True)
        self._process, self._path, self._stage = None, None, None  # the last stage the child has told of
        self._told, self._words = threading.Event(), ""  # the end of what the child printed

    # ---- the loop as a thread: good enough for an arm that is simulated or replayed

    def _begin_thread(self, cargo):
        self._copies = pickle.loads(cargo)
        warm_up(*self._copies)
        self._thread.start()

    def _loop(self):
        realtime, self._bench.realtime = self._bench.realtime, True
        try:
            live_loop(self._bench, *self._copies, self._memory, **self._options)
        except BaseException as error:
            self.error = error
        finally:
            self._bench.realtime = realtime

    # ---- the loop as a process

    def _begin_process(self, cargo):
        """Start the child; back when it has the port and its first cycle follows. Raises what kept it from that."""
        options = {"start_new_session": True, "pass_fds": self._memory.file_descriptors}
        if os.name == "nt":  # either way: Ctrl-C and the notebook's interrupt button are not for the child
            options = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
        bench = cloudpickle.dumps((type(self._bench), self._bench._arguments()))
        work = (sys.path, self._memory.address, os.getpid(), bench, cargo, self._options)
        command = [sys.executable, "-c", loop_process.START]
        self._said, pipe = tempfile.TemporaryFile(), subprocess.PIPE
        self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=self._said, **options)
        try:
            self._bench._close()  # the port is the child's from here on
            self._thread.start()
            with contextlib.suppress(BrokenPipeError):  # it has died
                loop_process.send(self._process.stdin, work)
            self._told.wait(_OPENED_WITHIN)
            if self._stage is None:
                why = "does not open the bench" if self._process.poll() is None else f"ended too soon{self._words}"
                raise self.error or BenchError(f"the loop's process {why}")
        except BaseException:
            self._give_up()
            raise

    def _listen(self):
        """Hear what the child says until it is gone."""
        with contextlib.suppress(Exception):  # EOFError when it is gone; whatever the error of a stranger raises here
            while True:
                stage, content = pickle.load(self._process.stdout)
                if stage == "failed":
                    self.error = pickle.loads(content)
                    break
                if stage == "recording":
                    self._path = content
                self._stage = stage
                self._told.set()
        code = self._process.wait()
        self._memory.handed_over()
        with self._said as said:  # where Python's own complaints are
            said.seek(max(0, said.seek(0, os.SEEK_END) - 1500))
            words = said.read().decode("utf-8", "replace").strip()
        self._words = f"; it said: {words}" if words else ""
        if self.error is None and self._stage not in (None, "done"):
            self.error = BenchError(
                f"the process of the loop has died (exit code {code}): the board has cut the drive 0.1 s after its "
                f"last command{self._words}"
            )
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        self._process.stdout.close()
        self._told.set()

    @property
    def pid(self):
        """The number of the child process."""
        return self._process.pid

    # ---- either way

    @property
    def alive(self):
        """Whether the loop still runs."""
        return self._thread.is_alive()

    @property
    def recording(self):
        """The recording: as it grows, or of a child as far as it is on disk; None if it is not recorded there."""
        if self._process is None:
            return self._bench.recording
        return Recording.load(self._path) if self._path else None

    @property
    def phase(self):
        """What it does: 'starting', 'leading in', 'running', 'moving to the rest pose' or 'ended'."""
        return shared_loop.PHASES[self._memory.status.phase] if self.alive else shared_loop.PHASES[-1]

    @property
    def gains(self):
        """{'kp': (3,), 'ki': (3,), 'kd': (3,)} as ordered last; empty if the controller has none to set."""
        return {name: values.copy() for name, values in self._gains.items()}

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains from the next cycle on; the command does not jump. Raises InputError for bad gains."""
        if not self._gains:
            raise InputError("this controller has no gains kp, ki, kd: there is nothing to change live")
        given = {name: value for name, value in zip(GAINS, (kp, ki, kd), strict=True) if value is not None}
        wanted = {name: gains(name, value) for name, value in given.items()}
        with self._lock:
            self._gains.update(wanted)
            self._memory.order(gains=np.concatenate([self._gains[name] for name in GAINS]))

    def set_point(self, q):
        """Go to q (3,) rad at limited speed, from where the reference is.

        Raises InputError if q is outside the joint limits or below the table.
        """
        goal = checked_set_point(self._bench.arm, q)
        with self._lock:
            self._memory.order(set_point=goal)

    def give_back(self):
        """The bench is wanted in this process again, with its port. Raises BenchError while the loop runs."""
        if self.alive:
            raise BenchError(f"a loop in the background has the arm ({self.phase}): stop() or cut() it first")
        if self._process is not None and self._bench.is_open:
            self._bench._open()

    def stop(self, *, wait=True):
        """End in order: the arm moves to its rest pose and is let go. wait: until that is over."""
        with self._lock:
            self._memory.order(stop=True)
        if wait and not self._wait(_TO_REST):
            self.cut()

    def cut(self):
        """Drive off within one cycle, and the loop ends. The arm sinks. Never raises; may be called at any time."""
        if self.is_here():
            return
        with self._lock:
            self._memory.order(cut=True, stop=True)
        if not self._wait(_OBEYED):
            self._give_up()

    def join(self, timeout=None):
        """Wait until the loop has ended; at most `timeout` s.

        Returns: whether it has. Raises what ended it early: an error of the controller, a lost board...
        """
        ended = self._wait(timeout)
        if self.error is not None:
            raise self.error
        return ended

    def is_here(self):
        """Whether the caller is the loop itself."""
        return threading.current_thread() is self._thread

    def _wait(self, timeout):
        """Wait for the end. Returns whether it came."""
        if self.alive and not self.is_here():
            self._thread.join(timeout)
        return not self.alive

    def _give_up(self):
        """The loop does not obey: cut from here; a child is ended, and the board cuts 0.1 s after its last frame."""
        with contextlib.suppress(Exception):
            if self._process is None:
                self._bench._cut()
            else:
                self._process.kill()
                self._wait(5.0)

    def recent(self, seconds):
        """The samples of the last `seconds`, at most 80 s: LiveSamples."""
        rows = self._memory.latest(1 + math.ceil(seconds / self._bench.period))
        rows = rows[rows["t"] >= rows["t"].max(initial=0.0) - seconds]
        tripped = np.flatnonzero(np.diff(rows["trips"])) + 1
        return LiveSamples(rows["t"], rows["q"], rows["u"], rows["r"], rows["t"][tripped])

    def statistics(self):
        """How well the loop keeps time: LoopStatistics."""
        status, rows = self._memory.status, self._memory.latest(shared_loop.CAPACITY)
        counts = int(status.samples), int(status.missed), int(status.trips)
        if len(rows) < 2:
            return LoopStatistics(*counts)
        periods = np.diff(rows["measured"])[np.diff(rows["number"]) == 1]
        p50, p99 = np.percentile(periods, (50, 99))
        return LoopStatistics(*counts, p50, p99, periods.max(), float(np.median(rows["busy"])))

    def __repr__(self):
        return f"<LiveRun: {self.phase}; {self.statistics()}>"
