"""The file of a recording: lines `# key: value`, a line of column names, one line per sample; a spreadsheet opens it.

t in s; q and r (the reference) in rad; counts of the 10-bit converter; u in PWM counts; gripper 1 closed, 0 open;
missed: cycles late so far. An empty cell is a value that is not known. Files of other programs need only the columns
t, q1, q2, q3; they may be separated by ';' or tabs, and have decimal commas then.
"""

import math
import re

import numpy as np

from ir50p_lab.errors import RecordingError

FORMAT = "ir50p_lab recording"
COLUMNS = ("t", "q1", "q2", "q3", "counts1", "counts2", "counts3", "u1", "u2", "u3", "r1", "r2", "r3")
COLUMNS += ("gripper", "missed")
T, Q, COUNTS, U, R, GRIPPER, MISSED = 0, slice(1, 4), slice(4, 7), slice(7, 10), slice(10, 13), 13, 14
_ROW = "%.6f,%.6f,%.6f,%.6f,%g,%g,%g,%g,%g,%g,%.6f,%.6f,%.6f,%d,%d\n"
_CELLS = _ROW.strip().split(",")
_REQUIRED = COLUMNS[:4]
_GROUPS = (("counts1", "counts2", "counts3"), ("u1", "u2", "u3"), ("r1", "r2", "r3"))
_EVENT = re.compile(r"[ \"]*#\W*event: (-?[\d.]+) s: (.*)")
_UNITS = "t s; q rad; counts of the 10-bit converter; u PWM counts; r (reference) rad; gripper 1 closed; missed cycles"


def head_text(header):
    """The lines before the first sample. header: dict of str."""
    lines = [f"# {FORMAT}: 1", f"# units: {_UNITS}"]
    return "\n".join(lines) + "\n" + told_text(header) + ",".join(COLUMNS) + "\n"


def told_text(header):
    """Lines of the head that are known only at the end of a run, or all of them: dict of str."""
    return "".join(f"# {key}: {_one_line(value)}\n" for key, value in header.items())


def rows_text(table, events=()):
    """The lines of samples. table: (n, 15), columns as COLUMNS, NaN where not known; events: [(t, text), ...]."""
    if events:
        places = np.searchsorted(table[:, T], [t for t, _ in events], side="left")
        parts, begin = [], 0
        for (t, text), end in zip(events, places, strict=True):
            parts += [rows_text(table[begin:end]), event_text(t, text)]
            begin = end
        return "".join([*parts, rows_text(table[begin:])])
    if not np.isnan(table).any():
        return "".join([_ROW % tuple(row) for row in table.tolist()])
    return "".join(map(row_text, table.tolist()))


def row_text(row):
    """The line of one sample: 15 numbers as COLUMNS, NaN where not known."""
    return ",".join(["" if x != x else form % x for form, x in zip(_CELLS, row, strict=True)]) + "\n"


def _one_line(value):
    """A header value in plain ASCII on one line; `_as_written` brings other letters back."""
    text = re.sub(r"\\(?=[xuU])", r"\\x5c", " ".join(str(value).split()))
    return text.encode("ascii", "backslashreplace").decode("ascii")


def _as_written(text, place):
    escapes = r"\\(?:x([0-9a-f]{2})|u([0-9a-f]{4})|U([0-9a-f]{8}))"
    try:
        return re.sub(escapes, lambda found: chr(int(found[1] or found[2] or found[3], 16)), text)
    except (ValueError, OverflowError):
        raise RecordingError(f"{place}: an escape in {text:.60} stands for no letter; repair or delete it") from None


def read(path):
    """Read a recording.

    Returns: header (dict of str), table (n, 15) as COLUMNS with NaN where nothing is known, notes (tuple of str),
    events (tuple of (t, text)).
    Raises RecordingError that names the file, the line, what is wrong there, and the remedy.
    """
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise RecordingError(f"cannot read the recording {path}: {error.strerror}; check the path") from None
    return parse(data, str(path))


def parse(data, name):
    """The same from the bytes of a file; name: for messages."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise RecordingError(f"{name} is UTF-16 text: save it as plain CSV (not 'Unicode text')")
    try:
        text = data.rstrip(b"\0").decode("utf-8-sig")  # a power cut can leave zeros at the end
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if "\0" in text:
        raise RecordingError(f"{name} is no text file; a recording is a CSV file")
    lines = text.splitlines()
    header, first = _read_header(lines, name)
    ours = FORMAT in header
    if first == len(lines) or (first == len(lines) - 1 and not text.endswith("\n")):
        raise RecordingError(f"{name} ends before its first sample: the run was stopped as it began; record again")
    delimiter, places = _read_columns(lines[first], first + 1, name)
    notes, body = [], lines[first + 1 :]
    width = lines[first].count(delimiter) + 1
    if body and not text.endswith(("\n", "\r")) and (ours or body[-1].count(delimiter) + 1 != width):
        notes.append(f"its last line ({len(lines)}) is not complete and was left out: the program stopped as it wrote")
        body = body[:-1]
    table = _read_rows(body, first + 2, name, delimiter, places, width)
    header.pop(FORMAT, None), header.pop("units", None)
    events = tuple(_events(body, first + 2, name))
    told = [line for line in body if line.lstrip(' "').startswith("#") and not _EVENT.match(line)]
    header.update(_read_header(told, name)[0])  # statistics, which stand at the end
    return header, table, tuple(notes), events


def event_text(t, text):
    """The line that says what was changed at t (s) in the middle of a run."""
    return f"# event: {t:.3f} s: {_one_line(text)}\n"


def _events(lines, number, name):
    for k, line in enumerate(lines):
        found = _EVENT.match(line)
        place = f"{name}, line {number + k}"
        if found and not _is_number(found[1]):
            raise RecordingError(f"{place}: {found[1]} s is no time; repair or delete that line")
        if found:
            yield float(found[1]), _as_written(found[2].rstrip(';,\t" '), place)


def _read_header(lines, name):
    """Header and the index of the line behind it."""
    header = {}
    for k, line in enumerate(lines):
        line = line.strip().rstrip(";,\t").strip('"')  # spreadsheets pad and quote
        if line and not line.startswith("#"):
            return header, k
        key, colon, value = line.lstrip("# ").partition(":")
        if colon:
            header[key.strip()] = _as_written(value.strip(), f"{name}, line {k + 1}")
    return header, len(lines)


def _read_columns(line, number, name):
    """Delimiter, and the column of the file for each of COLUMNS (None: not there)."""
    delimiter = next((d for d in ";\t" if d in line), ",")
    names = [cell.strip().strip('"').lower() for cell in line.split(delimiter)]
    need = "the first line after the '#' lines names the columns: t,q1,q2,q3 at least, then u1,u2,u3 and others"
    missing = [column for column in _REQUIRED if column not in names]
    if missing:
        raise RecordingError(f"{name}, line {number}: no column {', '.join(missing)} in {line.strip()[:60]!r}; {need}")
    doubled = next((column for column in COLUMNS if names.count(column) > 1), None)
    if doubled:
        raise RecordingError(f"{name}, line {number}: column {doubled} stands there twice; keep one of them")
    for group in _GROUPS:
        there = [column for column in group if column in names]
        if there and len(there) < 3:
            raise RecordingError(
                f"{name}, line {number}: of {', '.join(group)} only {', '.join(there)}; give all three"
            )
    return delimiter, [names.index(column) if column in names else None for column in COLUMNS]


def _read_rows(lines, number, name, delimiter, places, width):
    table = np.full((len(lines), len(COLUMNS)), np.nan)
    decimal_comma = delimiter != ","
    n, numbers = 0, []
    for k, line in enumerate(lines):
        if not line.strip(" ;,\t") or line.lstrip(' "').startswith("#"):
            continue  # an empty line of a spreadsheet; an event
        cells = line.replace(",", ".").split(delimiter) if decimal_comma else line.split(",")
        if len(cells) != width:
            hint = "decimal commas need ';' between the columns" if len(cells) > width else "the line is cut off"
            raise RecordingError(
                f"{name}, line {number + k}: {len(cells)} values for {width} columns ({hint}); "
                "repair or delete that line"
            )
        try:
            table[n] = [
                math.nan if place is None or not cells[place].strip() else float(cells[place]) for place in places
            ]
        except ValueError:
            bad = next(p for p in places if p is not None and cells[p].strip() and not _is_number(cells[p]))
            raise RecordingError(
                f"{name}, line {number + k}: {cells[bad].strip()!r} is no number; repair or delete that line"
            ) from None
        n += 1
        numbers.append(number + k)
    table = table[:n]
    _check(table, numbers, name)
    return table


def _is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _check(table, numbers, name):
    """Raise RecordingError for the first line whose values cannot be."""

    def refuse(bad, column, why):
        if bad.any():
            row = int(np.argmax(bad.reshape(len(table), -1).any(axis=1)))
            value = np.atleast_2d(table[row, column]).ravel()[int(np.argmax(np.atleast_1d(bad[row])))]
            raise RecordingError(f"{name}, line {numbers[row]}: {why.format(f'{value:g}')}")

    if not len(table):
        return
    t = table[:, T]
    repair = "; repair or delete that line"
    refuse(~np.isfinite(table[:, : Q.stop]), slice(0, Q.stop), "t or an angle is missing or not finite ({})" + repair)
    refuse(np.isinf(table), slice(None), "a value is infinite" + repair)
    refuse(np.r_[False, np.diff(t) <= 0], T, "t = {} s is not later than the line before; sort by t, each time once")
    if len(t) > 1 and np.median(np.diff(t)) > 1.0:
        raise RecordingError(
            f"{name}: steps of {np.median(np.diff(t)):g} s; t is in seconds, was it ms? Divide by 1000"
        )
    refuse(np.abs(table[:, Q]) > 10.0, Q, "an angle of {} rad; angles are in rad, were they degrees? Times pi/180")
    refuse((table[:, COUNTS] < 0) | (table[:, COUNTS] > 1023), COUNTS, "{} counts; the converter gives 0..1023")
    refuse(np.abs(table[:, U]) > 255, U, "u = {}; PWM counts are -255..255: record what was sent, after limits")
