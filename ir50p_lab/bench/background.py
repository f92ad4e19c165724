"""`bench.start(controller, reference)`: the loop of the lesson in the background."""

import contextlib
import threading

from ir50p_lab.bench import shared_loop
from ir50p_lab.bench.live_loop import live_loop
from ir50p_lab.bench.live_run import LiveRun
from ir50p_lab.bench.pace import warm_up
from ir50p_lab.bench.set_point import checked_reference
from ir50p_lab.bench.shared_loop import SharedLoop
from ir50p_lab.controllers.base import check_controller, check_reference
from ir50p_lab.errors import BenchError, InputError


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
    cargo = _packed(controller, reference)
    options = {"seconds": seconds, "lead_in": lead_in, "rest": rest}
    if bench.own_process:
        from ir50p_lab.bench.loop_process import ProcessRun

        run = ProcessRun(bench, controller, cargo, options)
    else:
        run = ThreadRun(bench, controller, cargo, options)
    bench.live_run = run
    run.begin()
    return run


def _packed(controller, reference):
    """Controller and reference as bytes, whoever defined them."""
    import cloudpickle

    try:
        return cloudpickle.dumps((controller, reference))
    except Exception as error:
        raise InputError(
            f"controller or reference cannot be sent to the loop in the background ({error}): let them hold numbers "
            "and functions only, no files, widgets or benches"
        ) from None


class ThreadRun(LiveRun):
    """The loop as a thread of this process: good enough for an arm that is simulated or replayed."""

    def __init__(self, bench, controller, cargo, options):
        super().__init__(bench, controller, cargo, options, SharedLoop())
        self._thread = threading.Thread(target=self._run, name="bench loop", daemon=True)

    def begin(self):
        """Start; the first cycle follows at once."""
        import cloudpickle

        self._cargo = cloudpickle.loads(self._cargo)
        warm_up(*self._cargo)
        self._thread.start()

    def _run(self):
        realtime, self._bench.realtime = self._bench.realtime, True
        try:
            live_loop(self._bench, *self._cargo, self._memory, **self._options)
        except BaseException as error:
            self.error = error
        finally:
            self._bench.realtime = realtime
            self._memory.status.phase = shared_loop.ENDED

    @property
    def alive(self):
        """Whether the loop still runs."""
        return self._thread.is_alive()

    @property
    def recording(self):
        """The recording of the run: it grows while it goes on."""
        return self._bench.recording

    def is_here(self):
        """Whether the caller is the loop itself."""
        return threading.current_thread() is self._thread

    def wait(self, timeout):
        """Wait for the end. Returns whether it came."""
        if not self.is_here():
            self._thread.join(timeout)
        return not self._thread.is_alive()

    def give_up(self):
        """The loop hangs in its controller and gives no more commands; cut from here."""
        with contextlib.suppress(Exception):
            self._bench._cut()
