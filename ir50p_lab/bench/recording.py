"""What one run of a bench leaves behind: arrays, a head that says where they come from, a plot, a file."""

import math
import warnings
from array import array
from pathlib import Path

import numpy as np

from ir50p_lab.bench import recording_file
from ir50p_lab.bench.recording_file import COLUMNS, COUNTS, GRIPPER, MISSED, Q, R, T, U, table_of
from ir50p_lab.errors import InputError, RecordingError


class RecordingWarning(UserWarning):
    """A part of a recording was left out when it was loaded."""


class Recording:
    """A run, sample by sample; from `bench.recording` (it grows while the run goes on) or `Recording.load(path)`.

    ============ ======= =========================================================================
    t            (n,)    s since the run began
    q            (n, 3)  rad, measured
    counts       (n, 3)  of the 10-bit converter
    u            (n, 3)  PWM counts that were really sent, held from each sample to the next
    reference    (n, 3)  rad, what `drive(..., reference=)` was given
    gripper      (n,)    1 closed, 0 open
    missed       (n,)    number of cycles that have come late so far
    ============ ======= =========================================================================

    What is not known is NaN. The arrays are read-only. Attributes: header: dict of str (arm, bench, date,
    calibration, gains...); path: its file, or None; events: what was changed in the middle of the run,
    [(t in s, text), ...]; truth: the Truth of a simulated run that has just ended, else None, because no file keeps it.
    """

    truth = None

    def __init__(self, table, header=None, *, path=None, events=()):
        """table: (n, 15) array as `recording_file.COLUMNS`, or the growing array('d') of a Recorder."""
        self._rows = table if isinstance(table, array) else array("d", np.asarray(table, dtype=float).tobytes())
        self._cache = None
        self.header, self.path = dict(header or {}), path
        self.events = list(events)

    @classmethod
    def from_arrays(cls, t, q, *, header=None, **known):
        """Make a recording from arrays, named and shaped as in the table above; what is left out is not known (NaN).

        Raises InputError for shapes that do not fit each other, RecordingError for values that cannot be: degrees, NaN.
        """
        try:
            table = table_of(t, q, **known)
        except ValueError as error:
            raise InputError(f"t (n,), q, counts, u, reference (n, 3) of one length are needed: {error}") from None
        recording_file.check(table, [f"sample {k}" for k in range(len(table))])
        return cls(table, header)

    @classmethod
    def load(cls, path):
        """Read a recording from the file at `path`.

        Raises RecordingError, which names the file, the line, what is wrong and the remedy. Warns (RecordingWarning) if
        the last line was cut off and is left out.
        """
        header, table, events, cut = recording_file.read(path)
        if cut:
            warnings.warn(f"{path}: its last line ({cut}) is cut off, and was left out", RecordingWarning, stacklevel=2)
        return cls(table, header, path=Path(path), events=events)

    def save(self, path):
        """Write the recording to `path` (CSV, as a bench writes it); return the path.

        Raises RecordingError if it cannot.
        """
        text = recording_file.head_text(self.header) + recording_file.rows_text(self._table, self.events)
        try:
            Path(path).write_text(text, encoding="utf-8", errors="backslashreplace", newline="\n")
        except OSError as error:
            raise RecordingError(f"cannot write {path}: {error.strerror}; give a file in a folder of yours") from None
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
        """Whether the head of the recording says that nothing in it was measured."""
        return self.header.get("simulated", "").lower() == "true"

    @property
    def period(self):
        """The sampling period, s: from the head if it fits the times within 20 %, else their median step.

        If most cycles came late or were left out, the times say nothing about it.
        """
        stated = recording_file.stated_period(self.header)
        if len(self) < 2 or (stated > 0 and self.missed[-1] > 0.5 * len(self)):
            return stated
        step = float(np.median(np.diff(self.t)))
        return stated if abs(stated - step) <= 0.2 * step else step

    def between(self, t0, t1):
        """Return the samples with t0 <= t <= t1 (s) as a Recording of its own; the times stay as they are."""
        table = self._table
        header = {**self.header, "cut": f"{t0:g} to {t1:g} s"}
        events = [event for event in self.events if t0 <= event[0] <= t1]
        return Recording(table[(table[:, T] >= t0) & (table[:, T] <= t1)], header, events=events)

    def recent(self, seconds):
        """Return the last `seconds` as a Recording of its own; this is cheap while the run goes on."""
        count = 1 + math.ceil(seconds / float(self.header.get("period_s", 0.01)))
        return Recording(self._rows[-count * len(COLUMNS) :], self.header)

    def plot(self):
        """Return a matplotlib Figure of angles (measured: line; set point: dashed) and PWM over time, joint by joint.

        A notebook shows it at the end of a cell. Raises RecordingError if there is no sample.
        """
        if not len(self):
            raise RecordingError("the recording has no sample: run the bench first")
        import matplotlib

        from ir50p_lab.lab_figure import LabFigure, figure_style

        dark, grey = "#333333", "#666666"
        with matplotlib.rc_context(figure_style()):
            figure = LabFigure(figsize=(9.0, 4.8), layout="constrained")
            colours = matplotlib.rcParams["axes.prop_cycle"].by_key()["color"]
            axes = figure.subplots(2, 3, sharex=True, sharey="row", height_ratios=(3, 2))
        known = self.reference[np.isfinite(self.reference).all(axis=1)]
        end = self.q[self.t >= max(self.t[-1] - 1.0, self.t.mean())].mean(axis=0)
        for j, (above, below) in enumerate(axes.T):
            above.plot(self.t, self.q[:, j], color=colours[j], lw=1.4, label="angle")
            off = ""
            if len(known):
                off = f" ends {1000 * abs(known[-1, j] - end[j]):.0f} mrad off"
                above.step(self.t, self.reference[:, j], where="post", color=dark, ls="--", lw=1.2, label="set point")
            below.step(self.t, self.u[:, j], where="post", color=colours[j], lw=0.8)
            below.vlines([t for t, _ in self.events], -275, 275, color=grey, ls=":", lw=1.0, label="event")
            above.set_title(f"joint {j + 1}{off}", fontsize=10.5, color=dark)
            below.set(ylim=(-275, 275), yticks=(-255, 0, 255), xlabel="t [s]")
        axes[0, 0].set_ylabel("angle [rad]")
        axes[1, 0].set_ylabel("u [PWM counts]")
        axes[0, 0].legend(fontsize=9)
        if self.events:
            axes[1, 0].legend(fontsize=9)
        origin = [self.header.get("bench", "recording of unknown origin"), "simulated, not measured" * self.simulated]
        origin.append(self.header.get("date", "")[:16].replace("T", " "))
        figure.suptitle("   |   ".join(filter(None, origin)), fontsize=10, color=grey, parse_math=False)
        return figure

    def __repr__(self):
        seconds = np.ptp(self.t) if len(self) else 0.0
        said = [self.header.get("bench", "of unknown origin"), f"{seconds:.2f} s", f"{len(self)} samples"]
        said += ["simulated" * self.simulated, str(self.path or "")]
        return f"<Recording: {', '.join(filter(None, said))}>"
