"""The child's side of a loop in the background that has a process of its own; `background` has the parent's."""

import contextlib
import gc
import os
import pickle
import signal
import sys
import threading
import traceback
from pathlib import Path

from ir50p_lab.bench import shared_loop
from ir50p_lab.bench.shared_loop import SharedLoop
from ir50p_lab.errors import BenchError, LabError

_PACKAGE_ROOT = str(Path(__file__).resolve().parents[2])
START = f"import sys; sys.path.insert(0, {_PACKAGE_ROOT!r}); from ir50p_lab.bench.loop_process import main; main()"


def send(pipe, message):
    """Write a message into a pipe, at once."""
    pickle.dump(message, pipe)
    pipe.flush()


def main():
    """What the child does, from its first to its last moment."""
    orders, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a controller prints must not get among the answers
    sys.path[:], address, *work = pickle.load(orders)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    memory = SharedLoop.attach(address)
    try:
        _serve(orders, answers, memory, *work)
        send(answers, ("done", None))
    except BaseException as error:
        memory.status.phase = shared_loop.ENDED
        with contextlib.suppress(OSError):
            send(answers, ("failed", _packed_error(error)))


def _serve(orders, answers, memory, parent, bench, cargo, options):
    import cloudpickle

    from ir50p_lab.bench.live_loop import live_loop
    from ir50p_lab.bench.pace import warm_up

    (kind, arguments), (controller, reference) = cloudpickle.loads(bench), cloudpickle.loads(cargo)
    warm_up(controller, reference)
    left_alone = threading.Event()
    threading.Thread(target=_watch, args=(orders, left_alone), daemon=True).start()

    def orphaned():
        return left_alone.is_set() or (os.name != "nt" and os.getppid() != parent)

    class TellingBench(kind):
        """The same bench, which tells where it records."""

        def _start_recorder(self, header):
            recorder = super()._start_recorder(header)
            path = recorder.recording.path
            send(answers, ("recording", None if path is None else os.path.abspath(path)))
            return recorder

    bench = TellingBench(**arguments)
    bench.open()
    try:
        gc.collect()
        gc.freeze()  # what the imports made is never looked through again
        send(answers, ("opened", None))
        live_loop(bench, controller, reference, memory, orphaned=orphaned, **options)
    finally:
        bench.abort()


def _watch(orders, left_alone):
    """The parent never writes again: reading ends when it is gone."""
    with contextlib.suppress(OSError):
        orders.read()
    left_alone.set()


def _packed_error(error):
    """The error as bytes that the parent can read; a BenchError with its text where it cannot be sent."""
    import cloudpickle

    if not isinstance(error, LabError):
        error.add_note("in the loop's process:\n" + "".join(traceback.format_tb(error.__traceback__)[-3:]))
    try:
        packed = cloudpickle.dumps(error)
        pickle.loads(packed)
    except Exception:
        text = "".join(traceback.format_exception_only(error)).strip()
        packed = pickle.dumps(BenchError(f"the loop in the background failed: {text}"))
    return packed
