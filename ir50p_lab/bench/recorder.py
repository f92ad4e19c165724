"""Writes a run to disk sample by sample, so that whatever happens to the program, what was recorded is there."""

import contextlib
import math
import os
from array import array
from datetime import datetime
from itertools import count
from pathlib import Path

from ir50p_lab.bench.recording import Recording
from ir50p_lab.bench.recording_file import event_text, head_text, lines_of, lines_text, rows_text, table_of
from ir50p_lab.controllers.base import gains_of
from ir50p_lab.errors import RecordingError
from ir50p_lab.home import home, path_setting
from ir50p_lab.inputs import vector3

_FLAGS = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_BINARY", 0)
_ELSEWHERE = "choose another folder with record_to=... or the environment variable IR50P_HOME"


class Recorder:
    """One run written into one new file; every sample is handed to the operating system before `write` returns.

    Args:
        head: dict of str for the head of the file; "kind" also goes into the file's name.
        folder: where the file goes; None: the folder of the environment variable IR50P_RECORDINGS, else recordings/ in
        the student's folder (IR50P_HOME); False: in memory only. A folder that is missing is made.

    Attributes: recording: a Recording that grows with every sample; path: the file, or None.
    Raises RecordingError if the file cannot be made.
    """

    def __init__(self, head, folder=None):
        head = {"date": datetime.now().astimezone().isoformat(timespec="seconds"), **head}
        self._rows, self._file, self.path = array("d"), None, None
        if folder is not False:
            self._create(Path(folder or path_setting("IR50P_RECORDINGS") or home() / "recordings"), head)
        self.recording = Recording(self._rows, head, path=self.path)

    def _create(self, folder, head):
        begun = datetime.fromisoformat(head["date"]).strftime("%Y-%m-%d_%H%M%S")
        try:
            folder.mkdir(parents=True, exist_ok=True)
            for run in count(1):  # several runs in one second get numbers
                self.path = folder / f"{begun}_{head.get('kind', 'arm')}_{run}.csv"
                with contextlib.suppress(FileExistsError):
                    self._file = os.open(self.path, _FLAGS, 0o666)
                    break
        except OSError as error:
            said = f"cannot record in {folder.absolute()}: {error.strerror}"
            raise RecordingError(f"{said}; {_ELSEWHERE}, or record=False for none") from None
        self._put(head_text, head)

    def write(self, sample, pwm, reference, gripper):
        """Record one cycle: the Sample, the command (3,) PWM counts, the reference (3,) rad or None, and gripper, bool.

        Raises RecordingError if the disk takes no more (memory and file keep what was recorded before), InputError
        for a reference that is not three numbers.
        """
        r = 3 * [math.nan] if reference is None else vector3("reference", reference).tolist()
        row = [sample.t, *sample.q.tolist(), *sample.counts.tolist(), *pwm.tolist(), *r, gripper, sample.missed]
        self._rows.extend(row)
        self._put(lines_of, row)

    def write_block(self, t, q, counts, u, r=math.nan, gripper=False, missed=0):
        """Record many cycles at once, for compiled runs: arrays (n,), (n, 3)... as in Recording; r may be NaN."""
        table = table_of(t, q, counts, u, r, gripper, missed)
        self._rows.frombytes(table.tobytes())
        self._put(rows_text, table)

    def event(self, t, text):
        """Record that something was changed at t, s, as a line between the samples, which spreadsheets show as text."""
        self.recording.events.append((t, text))
        self._put(event_text, t, text)

    def _put(self, text_of, *values):
        """Hand their text to the operating system; without a file there is none."""
        if self._file is None:
            return
        data = text_of(*values).encode("utf-8", "backslashreplace")
        try:
            while data:  # in parts if the disk is nearly full, or a signal came
                data = data[os.write(self._file, data) :]
        except OSError as error:  # leave a file of whole lines
            os.close(self._file)
            self._file = None
            with contextlib.suppress(OSError):  # else its last line is cut off; loading leaves that out
                os.truncate(self.path, self.path.read_bytes().rfind(b"\n") + 1)
            said = f"the recording {self.path} cannot be continued: {error.strerror}; what it holds is safe"
            raise RecordingError(f"{said}. The run ends here. Make room, or {_ELSEWHERE}") from None

    def close(self, statistics=None):
        """End the recording. statistics: dict of numbers about the run, for its head. May be called twice."""
        known = {name: str(value) for name, value in (statistics or {}).items()}
        self.recording.header.update(known)
        with contextlib.suppress(RecordingError):  # a full disk: the samples are there
            self._put(lines_text, known)
        if self._file is not None:
            os.close(self._file)
            self._file = None


def header_of(controller):
    """Return the lines of a controller for the head of a recording: its `header()`, else the gains that it keeps."""
    if hasattr(controller, "header"):
        return controller.header()
    return {name: " ".join(f"{x:g}" for x in values) for name, values in gains_of(controller).items()}
