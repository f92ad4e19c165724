"""What one run of a bench left behind: arrays, a head that says where they are from, a plot, a file."""

import math
import warnings
from array import array
from pathlib import Path

import numpy as np

from ir50p_lab.bench import recording_file
from ir50p_lab.bench.recording_file import COLUMNS, COUNTS, GRIPPER, MISSED, Q, R, T, U
from ir50p_lab.bench.recording_plot import plot, summarise
from ir50p_lab.errors import InputError, RecordingError


class RecordingWarning(UserWarning):
    """Something of a recording was left out when it was loaded."""


class Recording:
    """A run, sample by sample; from `bench.recording` (it grows while the run goes on) or `Recording.load(path)`.

    ============ ======= =========================================================================
    t            (n,)    s since the run began
    q            (n, 3)  rad, measured
    counts       (n, 3)  of the 10-bit converter
    u            (n, 3)  PWM counts that were really sent, held from each sample to the next
    reference    (n, 3)  rad, what `drive(..., reference=)` was told
    gripper      (n,)    1 closed, 0 open
    missed       (n,)    cycles that came late so far
    ============ ======= =========================================================================

    NaN where something is not known. Arrays are read-only. Attributes: header, dict of str (arm, bench, date,
    calibration, gains...); path: its file or None; notes: what loading left out; events: what was changed in the
    middle of the run, [(t in s, text), ...].
    """

    def __init__(self, table, header=None, *, path=None, notes=(), events=()):
        """table: (n, 15) array as `recording_file.COLUMNS`, or the growing array('d') of a Recorder."""
        self._rows = table if isinstance(table, array) else array("d", np.asarray(table, dtype=float).tobytes())
        self._cache = None
        self.header, self.path, self.notes = dict(header or {}), path, tuple(notes)
        self.events = list(events)

    @classmethod
    def from_arrays(cls, t, q, *, counts=None, u=None, reference=None, gripper=None, missed=None, header=None):
        """A recording from arrays, shapes as in the table above; what is left out is not known (NaN)."""
        table = np.full((len(t), len(COLUMNS)), np.nan)
        parts = ((T, t), (Q, q), (COUNTS, counts), (U, u), (R, reference), (GRIPPER, gripper), (MISSED, missed))
        for place, values in parts:
            if values is not None:
                try:
                    table[:, place] = values
                except ValueError:
                    raise InputError(
                        f"shape {np.shape(values)} beside {len(t)} times: give t (n,), q, counts, u, reference (n, 3)"
                    ) from None
        return cls(table, header)

    @classmethod
    def load(cls, path):
        """Read a recording; files of other programs need the columns t, q1, q2, q3 and may have u1, u2, u3.

        Raises RecordingError naming file, line, what is wrong and the remedy. Warns (RecordingWarning) if the last
        line was cut off and left out.
        """
        header, table, notes, events = recording_file.read(path)
        loaded = cls(table, header, path=Path(path), notes=notes, events=events)
        if "period_s" in header and len(loaded) > 1 and loaded._told_period() != loaded.period:
            said = f"period_s = {header['period_s']} does not fit its times"
            loaded.notes += (f"{said}: their step of {loaded.period:.4g} s is taken",)
        for note in loaded.notes:
            warnings.warn(f"{path}: {note}", RecordingWarning, stacklevel=2)
        return loaded

    def save(self, path):
        """Write the recording to `path` (CSV, as a bench writes it). Returns the path."""
        try:
            text = recording_file.head_text(self.header) + recording_file.rows_text(self._table, self.events)
            Path(path).write_bytes(text.encode("ascii"))
        except OSError as error:
            raise RecordingError(f"cannot write {path}: {error.strerror}; choose another place") from None
        return Path(path)

    @property
    def _table(self):
        if self._cache is None or len(self._cache) != len(self):
            # a copy, for an array that is looked at cannot grow; read-only
            self._cache = np.frombuffer(self._rows.tobytes()).reshape(-1, len(COLUMNS))
        return self._cache

    def __len__(self):
        return len(self._rows) // len(COLUMNS)

    t = property(lambda self: self._table[:, T], doc="Times (n,) s.")
    q = property(lambda self: self._table[:, Q], doc="Measured angles (n, 3) rad.")
    counts = property(lambda self: self._table[:, COUNTS], doc="Converter counts (n, 3).")
    u = property(lambda self: self._table[:, U], doc="PWM counts sent (n, 3).")
    reference = property(lambda self: self._table[:, R], doc="Reference angles (n, 3) rad, NaN where not given.")
    gripper = property(lambda self: self._table[:, GRIPPER], doc="1 closed, 0 open (n,).")
    missed = property(lambda self: self._table[:, MISSED], doc="Late cycles so far (n,).")

    @property
    def simulated(self):
        """Whether the head says that nothing here was measured."""
        return self.header.get("simulated", "").lower() == "true"

    @property
    def period(self):
        """Sampling period, s: from the head where it fits the times within 20 %, else their median step.

        Where most cycles came late or were left out their times say nothing of it.
        """
        told = self._told_period()
        if len(self) < 2 or (told > 0 and self.missed[-1] > 0.5 * len(self)):
            return told
        step = float(np.median(np.diff(self.t)))
        return told if abs(told - step) <= 0.2 * step else step

    def _told_period(self):
        try:
            return float(self.header["period_s"])
        except (KeyError, ValueError):
            return math.nan

    def between(self, t0, t1):
        """The samples with t0 <= t <= t1 (s), as a Recording of its own; times stay as they are."""
        table = self._table
        header = {**self.header, "cut": f"{t0:g} to {t1:g} s"}
        events = [event for event in self.events if t0 <= event[0] <= t1]
        return Recording(table[(table[:, T] >= t0) & (table[:, T] <= t1)], header, notes=self.notes, events=events)

    def recent(self, seconds):
        """The last `seconds` as a Recording of its own; cheap while the run goes on."""
        count = 1 + math.ceil(seconds / float(self.header.get("period_s", 0.01)))
        return Recording(self._rows[-count * len(COLUMNS) :], self.header)

    def metrics(self):
        """How each joint did: list of three JointSummary. Raises RecordingError if there is no sample."""
        return summarise(self)

    def plot(self):
        """Angles (measured: line; set point: dashed) and PWM over time, per joint: a matplotlib Figure.

        A notebook shows it at the end of a cell. Raises RecordingError if there is no sample.
        """
        return plot(self)

    def __repr__(self):
        n = len(self)
        seconds = f"{self._table[-1, T] - self._table[0, T]:.2f} s, " if n else ""
        return (
            f"<Recording: {self.header.get('bench', 'of unknown origin')}, {seconds}{n} samples"
            f"{', simulated' if self.simulated else ''}{f', {self.path}' if self.path else ''}>"
        )

    def _repr_html_(self):
        """The same with a line per joint, as a notebook shows it."""
        from html import escape

        head = f"<p>{escape(repr(self)[1:-1])}</p>" + "".join(f"<p>{escape(note)}</p>" for note in self.notes)
        if not len(self):
            return head
        import pandas as pd

        units = {name: f"{name} [rad]" for name in ("start", "final", "error", "overshoot", "swing")}
        table = pd.DataFrame(self.metrics()).rename(columns=units | {"u_std": "std(u) [PWM]"})
        return head + table.to_html(index=False, float_format="{:.3f}".format, na_rep="-")
