"""Recordings of other people's machines: t, q and u from a text table of whatever program wrote it."""

import math
import os
import re
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import RecordingError

_TIME = ("t", "time", "timestamp", "seconds", "sec", "clock")
_ANGLE = ("q", "angle", "pos", "position", "theta", "phi", "joint_position", "actual_q", "q_actual")
_DRIVE = ("u", "tau", "torque", "pwm", "current", "i", "effort", "voltage", "command", "cmd", "load")
_TIMES = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9}
_ANGLES = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180, "degrees": math.pi / 180, "°": math.pi / 180}
_ANGLES |= {"rev": 2 * math.pi, "turns": 2 * math.pi}


@dataclass(frozen=True, kw_only=True, eq=False)
class Columns:
    """t (n,) s, q (n, k) rad and u (n, k) in its own unit, as `fit_joint`, `identify` and `process` take them.

    names: of the columns of the file; notes: which were taken, and what their units were taken for.
    """

    t: np.ndarray
    q: np.ndarray
    u: np.ndarray
    names: tuple
    notes: tuple


def read_columns(path, *, t=None, q=None, u=None, time_unit=None, angle_unit=None):
    """Read t, q and u from a table of text, with one joint or several.

        fit_joint(read_columns("servo.csv"))                              # columns t, q, u, or names like these
        identify(read_columns("log.txt", t="stamp", q=("a1", "a2", "a3"), u=("i1", "i2", "i3"), angle_unit="deg"))

    Separated by comma, semicolon, tab or spaces (decimal commas where the separator is none); lines of comment (#, %,
    //), lines before the column names, a line of units below them and further columns do not matter.

    Args:
        t, q, u: names of the columns (case does not matter) or their numbers from 0; several joints: a tuple each.
            None: t or time..., q, angle, position..., u, torque, current, pwm...; q1, q2, q3 for joints.
        time_unit: "s", "ms", "us", "ns"; angle_unit: "rad", "mrad", "deg", "rev". None: as the column's name or the
            line of units says (time_us, q [deg]), else s and rad.

    Returns: Columns; empty cells are NaN. Raises RecordingError that names the file, what is wrong, and the remedy.
    """
    lines = _lines(path)
    names, units, table, skipped = _table(lines, path)
    places = {
        "t": _places(t, names, _TIME, "t", path, table.shape[1]),
        "q": _places(q, names, _ANGLE, "q", path, table.shape[1]),
        "u": _places(u, names, _DRIVE, "u", path, table.shape[1]),
    }
    if len(places["t"]) != 1 or len(places["q"]) != len(places["u"]):
        counts = ", ".join(f"{len(at)} of {name}" for name, at in places.items())
        raise RecordingError(f"{path}: {counts} given or found; name one t, and one u for each q")
    seconds = _unit(time_unit, _TIMES, "time_unit", "s", places["t"][0], names, units)
    radians = [_unit(angle_unit, _ANGLES, "angle_unit", "rad", at, names, units) for at in places["q"]]
    label = [f"column {k}" if not names else f"'{names[k]}'" for k in range(table.shape[1])]
    notes = [f"t from {label[places['t'][0]]} in {seconds[0]}"]
    notes += [f"q from {label[at]} in {unit}" for at, (unit, _) in zip(places["q"], radians, strict=True)]
    notes += [f"u from {label[at]}" for at in places["u"]]
    notes += [f"{skipped} line(s) without numbers left out"] if skipped else []
    return Columns(
        t=table[:, places["t"][0]] * seconds[1],
        q=table[:, places["q"]] * [factor for _, factor in radians],
        u=table[:, places["u"]],
        names=tuple(names),
        notes=tuple(notes),
    )


def _lines(path):
    try:
        with open(os.fspath(path), "rb") as file:  # fspath: a number would be an open file's
            data = file.read()
    except (OSError, TypeError, ValueError) as error:
        raise RecordingError(f"cannot read {path!r}: {getattr(error, 'strerror', error)}; check the path") from None
    for encoding in ("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", "latin-1"):
        try:
            text = data.decode(encoding)
            break
        except UnicodeDecodeError:
            continue
    if "\0" in text:
        raise RecordingError(f"{path} is no text file: save the recording as CSV")
    return [line.strip() for line in text.splitlines() if line.strip()]


def _table(lines, path):
    """Names, units ([] if there are none), numbers (n, m), and how many lines inside held none."""
    comments = [line for line in lines if line.startswith(("#", "%", "//"))]
    lines = [line for line in lines if not line.startswith(("#", "%", "//"))]
    separator = next((s for s in (";", "\t", ",") if sum(s in line for line in lines) > len(lines) / 2), None)
    cells = [_split(line, separator) for line in lines]
    rows = [_numbers(row, separator) for row in cells]
    first = next((k for k, row in enumerate(rows) if row is not None and len(row) > 1), None)
    if first is None:
        raise RecordingError(f"{path} holds no line of numbers: give a table of text with columns t, q and u")
    width = len(rows[first])
    kept = [row for row in rows[first:] if row is not None and len(row) == width]
    above = [row for row in cells[max(first - 2, 0) : first] if len(row) == width]
    if not above and comments:  # as numpy.savetxt writes its header
        above = [row for row in (_split(comments[-1].lstrip("#%/ "), separator),) if len(row) == width]
    names = above[0] if above else []
    return names, above[1] if len(above) > 1 else [], np.array(kept), len(rows) - first - len(kept)


def _split(line, separator):
    return [cell.strip().strip('"') for cell in line.split(separator)]


def _numbers(row, separator):
    """The numbers of a line, NaN for an empty cell; None if a cell holds a word."""
    found = []
    for cell in row:
        cell = cell.replace(",", ".") if separator != "," else cell
        try:
            found.append(float(cell) if cell else math.nan)
        except ValueError:
            return None
    return None if all(map(math.isnan, found)) else found


def _plain(name):
    """A column's name without its unit: 'q1 [deg]' and 'q1_deg' are 'q1'."""
    name = re.sub(r"[\[(].*", "", name.lower()).strip().replace(" ", "_")
    head, _, tail = name.rpartition("_")
    return head if head and tail in _TIMES | _ANGLES | {"pwm": 1, "nm": 1, "a": 1, "ma": 1} else name


def _places(asked, names, usual, what, path, width):
    """Numbers of the columns that were asked for, or that have a usual name."""
    here = f"{path} has the columns {', '.join(names)}" if names else f"{path} names no columns, there are {width}"
    if asked is not None:
        asked, found = asked if isinstance(asked, (tuple, list)) else (asked,), []
        lower = [name.lower() for name in names]
        for one in asked:
            if isinstance(one, str) and one.lower() in lower:
                found.append(lower.index(one.lower()))
            elif isinstance(one, (int, np.integer)) and not isinstance(one, bool) and 0 <= one < width:
                found.append(int(one))
            else:
                raise RecordingError(f"{what} = {one!r}: {here}; give one of these names, or a number from 0")
        return found
    plain = [_plain(name) for name in names]
    for name in usual:
        if plain.count(name) == 1:
            return [plain.index(name)]
        joints = [plain.index(f"{name}{i}{k}") for i in ("", "_") for k in range(10) if f"{name}{i}{k}" in plain]
        if joints:
            return joints
    raise RecordingError(f"{here}: none is called {usual[0]} or {usual[1]}; say which with {what}=, a name or a number")


def _unit(asked, known, option, default, place, names, units):
    """(name, factor) of the unit of a column."""
    if asked is not None:
        if asked not in known:
            raise RecordingError(f"{option} = {asked!r}: choose {', '.join(known)}")
        return asked, known[asked]
    said = [units[place]] if units else []
    if names:
        bracket = re.search(r"[\[(](.*?)[\])]", names[place])
        said += [bracket[1]] if bracket else [names[place].rpartition("_")[2]]
    for one in said:
        one = one.strip().strip("[]()").lower()
        if one in known:
            return one, known[one]
    return default, known[default]
