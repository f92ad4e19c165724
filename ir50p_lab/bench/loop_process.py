"""A loop in the background as a process of its own: nothing the notebook does can make it late, and it outlives nobody.

The child is told over a pipe what to run, opens the port itself and answers over another pipe. It cuts the drive when
its parent dies, however that dies: the pipe's end closes, and its parent's number changes. If the child itself dies,
no more frames come and the board cuts after 100 ms.
"""

import contextlib
import gc
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import traceback
from pathlib import Path

from ir50p_lab.bench import shared_loop
from ir50p_lab.bench.live_run import LiveRun
from ir50p_lab.bench.recording import Recording
from ir50p_lab.bench.shared_loop import SharedLoop
from ir50p_lab.errors import BenchError, LabError

_OPENED_WITHIN = 80.0  # s: a cold start imports and compiles, and a board restarts when its port is opened
_PACKAGE_ROOT = str(Path(__file__).resolve().parents[2])
_START = f"import sys; sys.path.insert(0, {_PACKAGE_ROOT!r}); from ir50p_lab.bench.loop_process import main; main()"


class ProcessRun(LiveRun):
    """The parent's side: starts the child, lends it the port, hears what it says."""

    def __init__(self, bench, controller, cargo, options):
        super().__init__(bench, controller, cargo, options, SharedLoop.shared())
        self._process, self._path, self._stage = None, None, None  # the last stage the child has told of
        self._said, self._words = None, ""  # the file of what the child prints, and the end of it
        self._told, self._ended = threading.Event(), threading.Event()

    def begin(self):
        """Start the child; back when it has the port and its first cycle follows. Raises what kept it from that."""
        import cloudpickle

        options = {"start_new_session": True, "pass_fds": self._memory.file_descriptors}
        if os.name == "nt":  # either way: Ctrl-C and the notebook's interrupt button are not for the child
            options = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
        bench = cloudpickle.dumps((type(self._bench), self._bench._arguments()))
        work = (sys.path, self._memory.address, os.getpid(), bench, self._cargo, self._options)
        command = [sys.executable, "-c", _START]
        self._said, pipe = tempfile.TemporaryFile(), subprocess.PIPE
        self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=self._said, **options)
        try:
            self._bench._close()  # the port is the child's from here on
            threading.Thread(target=self._listen, name="bench loop's messages", daemon=True).start()
            with contextlib.suppress(BrokenPipeError):  # it has died
                _send(self._process.stdin, work)
            self._told.wait(_OPENED_WITHIN)
            if self._stage is None:
                why = f"ended too soon{self._words}" if self._ended.is_set() else "does not open the bench"
                raise self.error or BenchError(f"the loop's process {why}")
        except BaseException:
            self.give_up()
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
        self._words = self._last_words()
        self._memory.handed_over()
        if self.error is None and self._stage not in (None, "done"):
            self.error = BenchError(
                f"the process of the loop has died (exit code {code}): the board has cut the drive 0.1 s after its "
                f"last command{self._words}"
            )
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        self._process.stdout.close()
        self._ended.set()
        self._told.set()

    def _last_words(self):
        """The end of what it printed: where Python's own complaints are."""
        with self._said as said:
            said.seek(max(0, said.seek(0, os.SEEK_END) - 1500))
            words = said.read().decode("utf-8", "replace").strip()
        return f"; it said: {words}" if words else ""

    @property
    def pid(self):
        """The number of the child process."""
        return self._process.pid

    @property
    def alive(self):
        """Whether the child still runs."""
        return self._process is not None and not self._ended.is_set()

    @property
    def recording(self):
        """The recording as far as it is on disk; None if it is not recorded there."""
        return Recording.load(self._path) if self._path else None

    def wait(self, timeout):
        """Wait for the end. Returns whether it came."""
        return self._ended.wait(timeout) if self._process is not None else True

    def give_up(self):
        """End a child that does not obey: no more frames, so the board cuts 0.1 s later."""
        with contextlib.suppress(OSError):
            self._process.kill()
        self.wait(5.0)

    def _take_back(self):
        """The port is wanted here again."""
        if self._bench.is_open:
            self._bench._open()


def _send(pipe, message):
    pickle.dump(message, pipe)
    pipe.flush()


# ---- the child


def main():
    """What the child does, from its first to its last moment."""
    orders, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a controller prints must not get among the answers
    sys.path[:], address, *work = pickle.load(orders)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    memory = SharedLoop.attach(address)
    try:
        _serve(orders, answers, memory, *work)
        _send(answers, ("done", None))
    except BaseException as error:
        memory.status.phase = shared_loop.ENDED
        with contextlib.suppress(OSError):
            _send(answers, ("failed", _packed_error(error)))


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
            _send(answers, ("recording", None if path is None else os.path.abspath(path)))
            return recorder

    bench = TellingBench(**arguments)
    bench.open()
    try:
        gc.collect()
        gc.freeze()  # what the imports made is never looked through again
        _send(answers, ("opened", None))
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
