"""The child's side of a background loop that has a process of its own; `background` has the parent's side.

Two pipes connect them. On either side one thread writes what comes into a queue, and another reads, so that neither
process ever waits for the other.
"""

import contextlib
import os
import pickle
import signal
import sys
import threading
import traceback
from pathlib import Path
from queue import SimpleQueue

from ir50p_lab.bench.pace import cut_said
from ir50p_lab.errors import BenchError, LabError

_PACKAGE_ROOT = str(Path(__file__).resolve().parents[2])
START = f"import sys; sys.path.insert(0, {_PACKAGE_ROOT!r}); from ir50p_lab.bench.loop_process import main; main()"


def write_on(queue, pipe):
    """Write each message of the queue into the pipe at once, until None comes; this runs in a thread of its own."""
    with contextlib.suppress(OSError), pipe:
        for message in iter(queue.get, None):
            pickle.dump(message, pipe)
            pipe.flush()


def read_on(pipe, take):
    """Hand each message (name, content) from the pipe to `take`, until the other side has closed it."""
    with contextlib.suppress(EOFError, OSError, pickle.UnpicklingError), pipe:
        while True:
            take(*pickle.load(pipe))


def main():
    """Run in the child process: read the work from the pipe, run the loop, report how it ended."""
    orders, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a controller prints must not get among the answers
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.path[:], *work = pickle.load(orders)
    news = SimpleQueue()
    writer = threading.Thread(target=write_on, args=(news, answers), daemon=True)
    writer.start()
    try:
        _serve(orders, news, *work)
        news.put(("done", True))
    except BaseException as error:
        news.put(("failed", _packed_error(error)))
    news.put(None)
    writer.join()


def _serve(pipe, news, bench, cargo):
    import cloudpickle

    from ir50p_lab.bench.live_loop import live_loop

    (kind, arguments), (controller, reference) = cloudpickle.loads(bench), cloudpickle.loads(cargo)
    parent, orders = os.getppid(), SimpleQueue()
    reader = threading.Thread(target=read_on, args=(pipe, lambda *order: orders.put(order)), daemon=True)
    reader.start()

    def tell(*word):
        if not reader.is_alive() or os.getppid() != parent:  # the pipe has ended; a fork of the parent may hold it open
            raise BenchError(f"the process that started this loop is gone: {cut_said(bench.cut())}")
        news.put(word)

    bench = kind(**arguments)
    bench.open()
    try:
        live_loop(bench, controller, reference, orders, tell)
    finally:
        bench.abort()


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
