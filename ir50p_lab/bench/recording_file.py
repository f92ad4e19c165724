"""The file of a recording: lines `# key: value`, a line of column names, one line per sample. A spreadsheet opens it.

t is in s; q and r (the reference) in rad; counts are those of the 10-bit converter; u is in PWM counts; gripper: 1
closed, 0 open; missed: how many cycles were late so far. An empty cell is a value that is not known. A spreadsheet may
save the file with semicolons or tabs, and with decimal commas. Read tables of other programs with pandas, and make
them a recording by `Recording.from_arrays`.
"""

import contextlib
import csv
import math
import re
from operator import itemgetter
from pathlib import Path

import numpy as np

from ir50p_lab.errors import RecordingError

FORMAT = "ir50p_lab recording"
COLUMNS = tuple("t q1 q2 q3 counts1 counts2 counts3 u1 u2 u3 r1 r2 r3 gripper missed".split())
T, Q, COUNTS, U, R, GRIPPER, MISSED = 0, slice(1, 4), slice(4, 7), slice(7, 10), slice(10, 13), 13, 14
_ROW = ",".join(4 * ("%.6f",) + 6 * ("%g",) + 3 * ("%.6f",) + 2 * ("%.0f",)) + "\n"
_FOREIGN = "for tables of other programs: pandas, Recording.from_arrays"
_PADDING = ',; "\t'  # what spreadsheets pad and quote lines with
_EVENT = re.compile(r"[ \"]*#\W*event: (-?[\d.]+) s: (.*)")
_UNITS = "t s; q rad; counts of the 10-bit converter; u PWM counts; r (reference) rad; gripper 1 closed; missed cycles"


def table_of(t, q, counts=math.nan, u=math.nan, reference=math.nan, gripper=math.nan, missed=math.nan):
    """Return samples, given as arrays (n,) and (n, 3), as a table (n, 15) with the columns COLUMNS; NaN: not known."""
    table = np.empty((len(t), len(COLUMNS)))
    table[:, T], table[:, Q], table[:, COUNTS], table[:, U] = t, q, counts, u
    table[:, R], table[:, GRIPPER], table[:, MISSED] = reference, gripper, missed
    return table


def head_text(header):
    """Return the lines before the first sample. header: dict of str."""
    return lines_text({FORMAT: 1, "units": _UNITS} | header) + ",".join(COLUMNS) + "\n"


def lines_text(header):
    """Return lines of the head: all of them, or those known only at the end of a run. header: dict of str."""
    return "".join(f"# {key}: {_one_line(value)}\n" for key, value in header.items())


def lines_of(values):
    """Return the lines of samples. values: a list, row after row, with columns as in COLUMNS."""
    return (_ROW * (len(values) // len(COLUMNS)) % tuple(values)).replace("nan", "")


def rows_text(table, events=()):
    """Return the lines of samples. table: (n, 15), columns COLUMNS, NaN if not known; events: [(t, text), ...]."""
    samples = lines_of(table.ravel().tolist())
    if not events:
        return samples
    lines = [(t, 1, line) for t, line in zip(table[:, T].tolist(), samples.splitlines(keepends=True), strict=True)]
    lines += [(t, 0, event_text(t, text)) for t, text in events]
    return "".join(line for *_, line in sorted(lines, key=itemgetter(0, 1)))


def event_text(t, text):
    """Return the line that says what was changed at t (s) in the middle of a run."""
    return f"# event: {t:.3f} s: {_one_line(text)}\n"


def _one_line(value):
    return " ".join(str(value).split())


def read(path):
    """Read a recording.

    Returns: header (dict of str), table (n, 15) as in COLUMNS with NaN for what is not known, events (tuple of (t,
    text)), and the number of the last line if it was cut off and left out, else None.
    Raises RecordingError, which names the file, the line, what is wrong there, and the remedy.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise RecordingError(f"cannot read the recording {path}: {error.strerror}; check the path") from None
    text = _decoded(data).rstrip("\0")  # a power cut can leave zeros at the end
    lines, header, rows, places, events, cut, separator = text.splitlines(), {}, [], [], [], None, ""
    for number, line in enumerate(lines, 1):
        place = f"{path}, line {number}"
        bare = line.strip(_PADDING)
        if number == len(lines) and not text.endswith(("\n", "\r")):
            cut = number
        elif found := _EVENT.match(line):
            events.append((_number(found[1], place), found[2].rstrip(_PADDING).strip()))
        elif bare.startswith("#") and not bare.startswith("###"):  # at the end stand statistics; ###: a narrow column
            key, colon, value = bare.lstrip("# ").partition(":")
            header |= {key.strip(): value.strip()} if colon else {}
        elif bare and not separator:
            names = bare.replace('"', "")
            separator = names[1:2]
            if separator not in (",", ";", "\t") or names != separator.join(COLUMNS):
                raise RecordingError(f"{place}: {bare[:60]!r} where the columns of a recording should be; {_FOREIGN}")
        elif bare:  # else an empty line of a spreadsheet
            rows.append(_read_row(line, separator, place))
            places.append(place)
    if not separator:
        raise RecordingError(f"{path} ends before its first sample: the run was stopped as it began; record again")
    table = np.array(rows).reshape(-1, len(COLUMNS))
    check(table, places)
    _check_unit_of_time(path, header, table[:, T])
    return {key: value for key, value in header.items() if key not in (FORMAT, "units")}, table, tuple(events), cut


def _decoded(data):
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")  # of a file that was cut off half a letter may be left
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def stated_period(header):
    """Return the period that a head states, s; NaN if it states none."""
    with contextlib.suppress(ValueError):
        return float(header.get("period_s", "nan"))
    return math.nan


def _check_unit_of_time(path, header, t):
    """Refuse times that are far from the period in the head: milliseconds, minutes."""
    stated = stated_period(header)
    step = np.median(np.diff(t)) if len(t) > 1 else stated
    if stated > 0 and not stated / 30 < step < 30 * stated:  # no loop is late all the time by so much
        said = f"{path}: t goes up by {step:g} a line, but period_s: {stated:g} in its head"
        raise RecordingError(f"{said}: t is in s; divide it by {step / stated:.4g}, or correct the head")


def _read_row(line, separator, place):
    quoted = '"' in line[1:-1]  # cell by cell
    cells = next(csv.reader([line], delimiter=separator)) if quoted else line.split(separator)
    if "," in "".join(cells):
        if pointed := next((cell for cell in cells if "." in cell), ""):  # of thousands, or a date
            raise RecordingError(f"{place}: {pointed!r} beside decimal commas is not a number; repair or delete it")
        cells = [cell.replace(",", ".") for cell in cells]
    if len(cells) < len(COLUMNS) or "".join(cells[len(COLUMNS) :]).strip():  # a spreadsheet may add empty ones
        said = f"{place}: {len(cells)} values for {len(COLUMNS)} columns"
        raise RecordingError(f"{said} (cut off, or decimal commas?); repair or delete that line")
    return [_number(cell, place) for cell in cells[: len(COLUMNS)]]


def _number(cell, place):
    """A cell as a number; NaN for an empty one."""
    try:
        return float(cell.strip(' "') or "nan")
    except ValueError:
        raise RecordingError(f"{place}: {cell.strip()!r} is not a number; repair or delete that line") from None


def check(table, places):
    """Raise RecordingError for the first row of table (n, 15) with impossible values. places: what to call each row."""
    t, repair = table[:, T], "; repair or delete it"
    late = np.append(False, t[1:] <= t[:-1])[:, np.newaxis]
    for columns, bad, why in (
        (slice(0, Q.stop), ~np.isfinite(table[:, : Q.stop]), "t or an angle is missing or not finite ({:g})" + repair),
        (slice(None), np.isinf(table), "a value is infinite" + repair),
        (slice(0, 1), late, "t = {:g} s is not later than the line before; sort by t, each time once"),
        (Q, np.abs(table[:, Q]) > 10.0, "an angle of {:g} rad; angles are in rad, were they degrees? Times pi/180"),
        (COUNTS, np.abs(table[:, COUNTS] - 511.5) > 511.5, "{:g} counts; the converter gives 0..1023"),
        (U, np.abs(table[:, U]) > 255, "u = {:g}; PWM counts are -255..255: record what was sent, after limits"),
    ):
        if bad.any():
            row, column = np.argwhere(bad)[0]
            raise RecordingError(f"{places[row]}: {why.format(table[row, columns][column])}")
