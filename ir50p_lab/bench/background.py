"""`bench.start(controller, reference)`: the loop of the lesson in the background, and the handle to control it.

On hardware the loop has a process of its own: nothing that the notebook does can make it late, and it never outlives
the notebook. The child is told over a pipe what to run, opens the port itself and answers over another pipe. It cuts
the drive when its parent dies, however that happens; if the child itself dies, no more frames come and the board cuts
the drive after 100 ms.
"""

import contextlib
import math
import os
import pickle
import subprocess
import sys
import tempfile
import threading
from collections import namedtuple
from queue import SimpleQueue

import cloudpickle
import numpy as np

from ir50p_lab.bench import loop_process
from ir50p_lab.bench.limits import MOST_PUSH, checked_pose, checked_push, checked_reference
from ir50p_lab.bench.live_loop import ENDED, LEADING, RUNNING, STARTING, live_loop
from ir50p_lab.bench.recording import Recording
from ir50p_lab.browser_tab import IN_BROWSER, needs_more
from ir50p_lab.controllers.base import check_controller, check_reference, gains, gains_of
from ir50p_lab.errors import BenchError, InputError
from ir50p_lab.modelling.chain import forward_kinematics

_TO_REST = 60.0  # s: if the motion to the rest pose takes longer, it has failed
_OBEYED = 0.25  # s: a loop that takes longer to obey hangs: the drive is cut from outside, its process killed
_BEGINS_WITHIN = 80.0  # s: if the first cycle comes later, the start has failed; importing and compiling take long
_KEPT = 8192  # newest samples that the notebook can read: 82 s at 100 Hz
_NAMES, _FORMATS = "t q u reference clock missed trips".split(), "f8 3f8 3f8 3f8 f8 i8 i8".split()


def start(bench, controller, reference=None):
    """Run `controller` on `reference` in the background, in real time, until it is stopped; the notebook stays free.

    The cycles are those of `for sample in bench.run(...)`. If the reference does not begin where the arm stands, the
    arm first moves there smoothly. On a simulated or replayed arm the loop runs in a thread; on hardware it runs in a
    process of its own, which cuts the drive when this process dies. Both get copies of controller and reference, so it
    must be possible to send these to another process (not so with a controller that holds an open file).

    Args:
        bench: open Bench. controller: step(t, measured, reference) -> u.
        reference: target(t) -> (q, qd, qdd); None: hold the pose measured at the start.

    Returns: LiveRun. Raises BenchError if the bench is closed or busy, InputError for bad arguments, and whatever
    opening the port raises.
    """
    if IN_BROWSER:
        needs_more("a loop in the background needs threads")
    check_controller(controller)
    if reference is not None:
        check_reference(reference)
        checked_reference(bench.arm, 0.0, reference(0.0))
    bench._number_of_cycles(1.0)  # it is open, and no other loop has it
    if bench._run is not None:
        raise BenchError("a run in a cell has the arm: end its loop first")
    try:
        cargo = cloudpickle.dumps((controller, reference))  # whoever defined them
    except Exception as error:
        said = f"controller or reference cannot be sent to the background ({error})"
        raise InputError(f"{said}: let them hold no files, widgets or benches") from None
    bench.live_run = LiveRun(bench, controller, cargo)
    bench.live_run._begin()
    return bench.live_run


class LoopStatistics(namedtuple("LoopStatistics", "cycles missed trips period_p50 period_p99 period_max")):
    """How well the loop keeps time.

    cycles, missed, trips: counts since the start (a trip: the drive was cut because the loop had paused); period_p50,
    period_p99, period_max: s between measurements, in the last 80 s at most; NaN before there are any.
    """

    def __str__(self):
        median, most, longest = (f"{1e3 * x:.2f} ms" for x in self[3:])
        counts = f"{self.cycles} cycles, {self.missed} late, {self.trips} cuts of the drive by pauses"
        return f"{counts}; period {median} median, {most} 99 %, {longest} longest"


class LiveRun:
    """A loop in the background; `bench.start` makes it.

    ================================ ==========================================================================
    stop()                           end it in order: the arm moves to the rest pose and is let go
    cut()                            cut the drive within a cycle and end the loop; the arm sinks
    set_gains(kp=, ki=, kd=)         change gains from the next cycle, without a bump; what is left out stays
    set_point([q1, q2, q3])          go there from where the reference is, at limited speed; rad
    push(link, point, force)         a hand pushes a simulated arm for a second; m in the link's frame, N
    recent(10)                       the last 10 s: .t .q .u .reference
    statistics()                     cycles, late cycles, periods
    join(timeout)                    wait for the end; raises what ended it early
    alive, phase, error, recording   whether it runs; what it does; what went wrong, or None; its Recording
    most_push                        how much of a push is felt now, N; 0 where nobody can push from here
    gains                            {'kp': (3,), 'ki': (3,), 'kd': (3,)} as last ordered; empty if it has none
    ================================ ==========================================================================

    A thread of this process runs the loop, or it listens to the process that does, until that is gone. Orders go into a
    queue; what the loop tells comes back to `_hear`.
    """

    def __init__(self, bench, controller, cargo):
        """cargo: controller and reference, as bytes."""
        self._bench, self._cargo = bench, cargo
        self.error, self.gains = None, gains_of(controller)
        self._orders, self._reports, self._begun = SimpleQueue(), {}, threading.Event()
        self._ring, self._count = np.rec.array(None, names=_NAMES, formats=_FORMATS, shape=_KEPT), 0
        self._thread, self._process = threading.Thread(target=self._work, daemon=True), None

    def _begin(self):
        """Start the loop; back when its first cycle follows. Raises what kept it from that."""
        self._thread.start()
        try:
            self._begun.wait(_BEGINS_WITHIN)
            if "phase" not in self._reports:
                raise self.error or BenchError("the loop in the background does not begin")
        except BaseException:
            self._give_up()
            raise

    def _work(self):
        try:
            arguments = self._bench._arguments()
            self._loop_here() if arguments is None else self._loop_in_a_process(arguments)
        except BaseException as error:
            self.error = error
        finally:
            self._begun.set()

    def _loop_here(self):
        """In this thread: good enough for an arm that is simulated or replayed."""
        bench, realtime = self._bench, getattr(self._bench, "realtime", True)
        bench.realtime = True
        try:
            live_loop(bench, *pickle.loads(self._cargo), self._orders, self._hear)
        finally:
            bench.realtime = realtime

    def _loop_in_a_process(self, arguments):
        """Start the child, and listen until it is gone. arguments: of its bench."""
        options = {"start_new_session": True}
        if os.name == "nt":  # either way: Ctrl-C and the notebook's interrupt button are not for the child
            options = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
        work = (sys.path, cloudpickle.dumps((type(self._bench), arguments)), self._cargo)
        command, pipe = [sys.executable, "-c", loop_process.START], subprocess.PIPE
        self._bench._close()  # the port is the child's from here on
        with tempfile.TemporaryFile() as said:
            self._process = child = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=said, **options)
            with contextlib.suppress(OSError):  # it has died
                pickle.dump(work, child.stdin)
                child.stdin.flush()
            threading.Thread(target=loop_process.write_on, args=(self._orders, child.stdin), daemon=True).start()
            loop_process.read_on(child.stdout, self._hear)
            code = child.wait()
            self._orders.put(None)
            said.seek(max(0, said.seek(0, os.SEEK_END) - 1500))
            words = said.read().decode("utf-8", "replace").strip()
        if "failed" in self._reports:
            raise pickle.loads(self._reports["failed"])
        if "done" not in self._reports:
            died = f"the loop's process has died (exit code {code}); a board cuts its drive by itself: connect() again"
            raise BenchError(died + "; it said: " * bool(words) + words)

    def _hear(self, name, content):
        """Keep what the loop tells; see `live_loop`."""
        if name == "sample":
            self._ring[self._count % _KEPT] = content
            self._count += 1
            return
        self._reports[name] = content
        if name == "phase":
            self._begun.set()

    # ---- what it does

    @property
    def alive(self):
        """True while the loop runs."""
        return self._thread.is_alive()

    @property
    def phase(self):
        """What the loop does: 'starting', 'leading in', 'running', 'moving to the rest pose' or 'ended'."""
        return self._reports.get("phase", STARTING) if self.alive else ENDED

    @property
    def recording(self):
        """The Recording as it grows, or that of a child as far as it is on disk; None if the child's is not on disk."""
        if self._process is None:
            return self._bench.recording
        path = self._reports.get("recording")
        return Recording.load(path) if path else None

    def _latest(self, count):
        """The last `count` samples at most, oldest first: a copy."""
        end = self._count  # the loop goes on writing while this is copied: the oldest are left out
        return self._ring[np.arange(max(0, end - min(count, _KEPT - 64)), end) % _KEPT]

    def recent(self, seconds):
        """Return the samples of the last `seconds`, at most 80 s.

        Returns: record array: t (n,) s, q (n, 3) rad, u (n, 3) PWM counts as sent, reference (n, 3) rad; trips (n,):
        how often the drive had been cut by then because the loop had paused.
        """
        rows = self._latest(1 + math.ceil(seconds / self._bench.period))
        return rows[rows.t >= rows.t.max(initial=0.0) - seconds]

    def statistics(self):
        """Return how well the loop keeps time: LoopStatistics."""
        rows = self._latest(_KEPT)
        if len(rows) < 2:
            return LoopStatistics(0, 0, 0, math.nan, math.nan, math.nan)
        periods = np.percentile(np.diff(rows.clock), (50, 99, 100))
        return LoopStatistics(self._count, int(rows.missed[-1]), int(rows.trips[-1]), *periods)

    def __repr__(self):
        return f"<LiveRun: {self.phase}; {self.statistics()}>"

    # ---- orders

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains from the next cycle, without a jump of the command; a gain that is left out stays.

        Raises InputError for gains that are negative or not finite, and for a controller without gains.
        """
        if not self.gains:
            raise InputError("this controller has no gains kp, ki, kd: there is nothing to change live")
        given = {"kp": kp, "ki": ki, "kd": kd}
        wanted = {name: gains(name, value) for name, value in given.items() if value is not None}
        self.gains = self.gains | wanted
        self._orders.put(("gains", wanted))

    def set_point(self, q):
        """Go to q (3,) rad at limited speed, from where the reference is.

        Raises InputError if q is outside the joint limits or the lab's workspace, or below the table.
        """
        q = checked_pose("set point", self._bench.arm, q)
        self._bench.caps.check("the tip of the set point, m,", "workspace", forward_kinematics(self._bench.arm, q))
        self._orders.put(("set point", q))

    @property
    def most_push(self):
        """The strongest push that is felt now, N; 0 for an arm that is not simulated, and on the way to rest."""
        return MOST_PUSH if hasattr(self._bench, "push") and self.phase in (LEADING, RUNNING) else 0.0

    def push(self, link, point, force):
        """Let a hand push a simulated arm, see `SimulatedBench.push`.

        Raises InputError for bad arguments and any other arm.
        """
        if not hasattr(self._bench, "push"):
            raise InputError("only a simulated arm can be pushed from here; no hand at a real arm under drive")
        self._orders.put(("push", checked_push(link, point, force)))

    def stop(self, *, wait=True):
        """End the loop in order: the arm moves to its rest pose and is let go.

        wait: whether to wait until that is over.
        """
        self._orders.put(("stop", None))
        if wait and not self._wait(_TO_REST):
            self.cut()

    def cut(self):
        """Cut the drive within one cycle and end the loop. The arm sinks. Never raises; may be called at any time."""
        if self.is_here():
            return
        self._orders.put(("cut", None))
        if not self._wait(_OBEYED):
            self._give_up()

    def join(self, timeout=None):
        """Wait until the loop has ended, at most `timeout` s (None: without limit).

        Returns: whether it has ended. Raises what ended it early: an error of the controller, a lost board...
        """
        ended = self._wait(timeout)
        if self.error is not None:
            raise self.error
        return ended

    def give_back(self):
        """Give the bench and its port back to this process. Raises BenchError while the loop runs."""
        if self.alive:
            raise BenchError(f"a loop in the background has the arm ({self.phase}): stop() or cut() it first")
        if self._process is not None and self._bench.is_open:
            self._bench._open()

    def is_here(self):
        """Return True if called from the loop's own thread."""
        return threading.current_thread() is self._thread

    def _wait(self, timeout):
        """Wait for the end. Returns whether it came."""
        if self.alive and not self.is_here():
            self._thread.join(timeout)
        return not self.alive

    def _give_up(self):
        """The loop does not obey: cut from here; a child is ended, and the board cuts 0.1 s after its last frame."""
        self._orders.put(("cut", None))  # for a loop that has not begun yet
        with contextlib.suppress(Exception):
            if self._process is None:
                self._bench._cut()
            else:
                self._process.kill()
                self._wait(5.0)
