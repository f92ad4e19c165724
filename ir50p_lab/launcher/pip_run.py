"""One pip run: its output read line by line and shown as a single progress line."""

import queue
import re
import subprocess
import threading
import time

#: Seconds between two looks at what is happening, when pip is silent.
_TICK = 0.5


class ProgressLine:
    """What is going on now: rewritten in place on a terminal, a line every tenth of the way elsewhere."""

    def __init__(self, stream):
        self._stream = stream
        self._terminal = stream.isatty()
        self._shown = None  # what was last written, so that nothing is written twice
        self._width = 0

    def show(self, stage, done, total, detail=""):
        """Say that `done` of `total` are through `stage`; `detail` is only for a terminal."""
        if self._terminal:
            text = f"      {stage} {done}/{total} ({100 * done // total} %) {detail}"[:100]
            self._stream.write("\r" + text.ljust(self._width))
            self._width = len(text)
        else:
            tenth = (stage, 10 * done // total)
            if tenth == self._shown:
                return
            self._shown = tenth
            self._stream.write(f"      {stage} {done}/{total} ({100 * done // total} %)\n")
        self._stream.flush()

    def clear(self):
        """Take the line off a terminal."""
        if self._terminal and self._width:
            self._stream.write("\r" + " " * self._width + "\r")
            self._stream.flush()
            self._width = 0


class PipProgress:
    """Follows pip's output and knows how far it is: collecting, fetching, then installing `total` packages."""

    def __init__(self, requirements):
        self.total = max(requirements, 1)
        self.stage = "collecting"
        self.done = 0
        self.megabytes = 0.0
        self.name = ""
        self.troubled = False

    def read(self, line):
        """Take in one line of pip's output."""
        if line.startswith("Ignoring ") and "markers" in line:  # a line of the lock for other systems
            self.total = max(self.total - 1, 1)
        elif match := re.match(r"\s*(?:Collecting|Requirement already satisfied:|Processing) (\S.*)", line):
            asked = match[1].split(" (from ")[0].replace("\\", "/").split("/")[-1]  # a name, or a file of a folder
            self.name = " ".join(asked.removesuffix(".whl").replace("==", "-").split("-")[:2])
            self.done += 1
            self.troubled = False
        elif match := re.match(r"\s*(Downloading|Using cached) (\S+\.whl) \(([\d.]+) (kB|MB|bytes)\)", line):
            name = match[2].split("/")[-1].split("-")[0]
            if self.stage == "collecting" and _plain(name) != _plain(self.name.split(" ")[0]):
                self.stage, self.done = "fetching", 0  # newer pips look all packages up first, then fetch them
            self.name = name
            if match[1] == "Downloading":
                self.megabytes += float(match[3]) * {"MB": 1, "kB": 1e-3, "bytes": 1e-6}[match[4]]
            if self.stage == "fetching":
                self.done += 1
        elif line.startswith("Installing collected packages:"):
            self.stage, self.done, self.name = "installing", 0, ""
            self.total = line.count(",") + 1
        elif "connection broken by" in line:
            self.troubled = True

    @property
    def detail(self):
        """What a person wants to see beside the count."""
        if self.troubled:
            return "no answer from the download server, trying again"
        return f"{self.name}, {self.megabytes:.0f} MB fetched" if self.megabytes else self.name


def run(command, *, env, stream=None, requirements=0, count_installed=lambda: 0, pass_fds=()):
    """Run a pip command; return (exit code, output).

    With a `stream` the progress is shown there, against `requirements` lines asked for; `count_installed` tells how
    many packages are in place, for pip says nothing while it unpacks them.
    """
    begin = time.monotonic()
    progress = PipProgress(requirements)
    line_shown = ProgressLine(stream) if stream else None
    before = 0
    output = []
    child = subprocess.Popen(
        command,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
        pass_fds=pass_fds,
    )
    try:
        for line in _lines(child.stdout):
            if line is None:  # a tick without output
                if progress.stage == "installing":
                    progress.done = min(max(count_installed() - before, 0), progress.total)
            else:
                output.append(line)
                was = progress.stage
                progress.read(line)
                if progress.stage == "installing" != was:
                    before = count_installed()
            if line_shown:
                elapsed = f"{progress.detail}, {time.monotonic() - begin:.0f} s"
                line_shown.show(progress.stage, min(progress.done, progress.total), progress.total, elapsed)
        return child.wait(), "".join(output)
    finally:
        if line_shown:
            line_shown.clear()
        _end(child)


def _plain(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def _lines(pipe):
    """Yield each line of the pipe as it comes, and None whenever a tick passes without one."""
    lines = queue.Queue()
    finished = object()

    def read():
        with pipe:
            for line in pipe:
                lines.put(line)
        lines.put(finished)

    threading.Thread(target=read, daemon=True).start()
    while True:
        try:
            line = lines.get(timeout=_TICK)
        except queue.Empty:
            line = None
        if line is finished:
            return
        yield line


def _end(child):
    """Leave no pip behind that would go on writing after an interruption."""
    if child.poll() is None:
        try:
            child.wait(timeout=3)  # a Ctrl-C reached it too: let it tidy up
        except (subprocess.TimeoutExpired, KeyboardInterrupt):
            child.kill()
    child.wait()
