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
import time
import traceback
from pathlib import Path

from ir50p_lab.bench import shared_loop
from ir50p_lab.bench.live_run import LiveRun
from ir50p_lab.bench.recording import Recording
from ir50p_lab.bench.shared_loop import SharedLoop
from ir50p_lab.errors import BenchError, LabError

_READY_WITHIN = 60.0  # s: a cold start imports and compiles
_OPEN_WITHIN = 20.0  # s: a board that restarts when its port is opened
_GO = "go"
_PACKAGE_ROOT = str(Path(__file__).resolve().parents[2])
_START = f"import sys; sys.path.insert(0, {_PACKAGE_ROOT!r}); from ir50p_lab.bench.loop_process import main; main()"


class ProcessRun(LiveRun):
    """The parent's side: starts the child, lends it the port, hears what it says."""

    def __init__(self, bench, controller, cargo, options):
        super().__init__(bench, controller, cargo, options, SharedLoop.shared())
        self._process, self._path, self._said, self._words = None, None, tempfile.TemporaryFile(), ""
        self._ended, self._heard, self._stages = threading.Event(), threading.Condition(), set()

    def begin(self):
        """Start the child; back when it has the port and its first cycle follows. Raises what kept it from that."""
        import cloudpickle

        options = {"start_new_session": True, "pass_fds": self._memory.file_descriptors}
        if os.name == "nt":  # either way: Ctrl-C and the notebook's interrupt button are not for the child
            options = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
        self._process = subprocess.Popen(
            [sys.executable, "-c", _START],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._said,
            **options,
        )
        threading.Thread(target=self._listen, name="bench loop's messages", daemon=True).start()
        try:
            bench = cloudpickle.dumps((type(self._bench), self._bench._arguments()))
            with contextlib.suppress(BrokenPipeError):  # it has died: the messages say why
                _send(self._process.stdin, (sys.path, self._memory.address, os.getpid()))
                _send(self._process.stdin, (bench, self._cargo, self._options))
            self._await("ready", _READY_WITHIN)
            self._bench._close()  # the port is the child's from here on
            with contextlib.suppress(BrokenPipeError):
                _send(self._process.stdin, _GO)
            self._await("opened", _OPEN_WITHIN)
        except BaseException:
            self.give_up()
            raise

    def _await(self, stage, timeout):
        with self._heard:
            came = self._heard.wait_for(lambda: stage in self._stages or self._ended.is_set(), timeout)
        if stage in self._stages:
            return
        raise self.error or BenchError(
            f"the loop's process was not {stage} within {timeout:.0f} s"
            if not came
            else f"the loop's process ended before it was {stage}{self._words}"
        )

    def _listen(self):
        """Hear what the child says until it is gone."""
        with contextlib.suppress(EOFError, OSError, pickle.UnpicklingError):
            while True:
                stage, content = pickle.load(self._process.stdout)
                if stage == "failed":
                    self.error = _error_from(content)
                elif stage == "recording":
                    self._path = content
                with self._heard:
                    self._stages.add(stage)
                    self._heard.notify_all()
        code = self._process.wait()
        self._words = self._last_words()
        self._said.close()
        self._memory.handed_over()
        if self.error is None and "done" not in self._stages and "opened" in self._stages:
            self.error = BenchError(
                f"the process of the loop has died (exit code {code}): the board has cut the drive 0.1 s after its "
                f"last command{self._words}"
            )
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        self._process.stdout.close()
        with self._heard:
            self._ended.set()
            self._heard.notify_all()

    def _last_words(self):
        """The end of what it printed: where Python's own complaints are."""
        self._said.seek(0)
        said = self._said.read()[-1500:].decode("utf-8", "replace").strip()
        return f"; it said: {said}" if said else ""

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


def _error_from(content):
    try:
        return pickle.loads(content["error"])
    except Exception:
        return BenchError(f"the loop in the background failed: {content['text']}")


def _send(pipe, message):
    pickle.dump(message, pipe)
    pipe.flush()


# ---- the child


def main():
    """What the child does, from its first to its last moment."""
    orders = os.fdopen(os.dup(0), "rb")
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a controller prints must not get among the answers
    path, address, parent = pickle.load(orders)
    sys.path[:] = path
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    memory = None
    try:
        memory = SharedLoop.attach(address)
        _serve(orders, answers, memory, parent)
        _send(answers, ("done", None))
    except BaseException as error:
        if memory is not None:
            memory.enter(shared_loop.ENDED)
        with contextlib.suppress(OSError):
            _send(answers, ("failed", _packed_error(error)))
    finally:
        sys.stdout.flush()
        sys.stderr.flush()


def _serve(orders, answers, memory, parent):
    import cloudpickle

    from ir50p_lab.bench.live_loop import live_loop
    from ir50p_lab.bench.pace import warm_up

    bench, cargo, options = pickle.load(orders)
    (kind, arguments), (controller, reference) = cloudpickle.loads(bench), cloudpickle.loads(cargo)
    warm_up(controller, reference)
    _send(answers, ("ready", None))
    pickle.load(orders)  # the word to go; EOFError if nobody is there to give it
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
        while os.read(orders.fileno(), 1):
            time.sleep(0.01)
    left_alone.set()


def _packed_error(error):
    text = "".join(traceback.format_exception_only(error)).strip()
    if not isinstance(error, LabError):
        with contextlib.suppress(Exception):
            error.add_note("in the loop's process:\n" + "".join(traceback.format_tb(error.__traceback__)[-3:]))
    import cloudpickle

    try:
        return {"error": cloudpickle.dumps(error), "text": text}
    except Exception:
        return {"error": b"", "text": text}
