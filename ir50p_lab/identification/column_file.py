"""Recordings of other people's machines: t, q and u from a table of whatever program wrote it, by pandas."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ir50p_lab.errors import RecordingError

_TIME = ("t", "time", "timestamp", "seconds", "sec", "clock")
_ANGLE = ("q", "angle", "pos", "position", "theta", "phi", "joint_position", "actual_q", "q_actual")
_DRIVE = ("u", "tau", "torque", "pwm", "current", "i", "effort", "voltage", "command", "cmd", "load")
_TIMES = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9}
_ANGLES = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180, "degrees": math.pi / 180, "°": math.pi / 180}
_ANGLES |= {"rev": 2 * math.pi, "turns": 2 * math.pi}
_UNITS = {*_TIMES, *_ANGLES, "pwm", "nm", "a", "ma"}


@dataclass(frozen=True, kw_only=True, eq=False)
class Columns:
    """t (n,) s, q (n, k) rad and u (n, k) in its own unit, as `fit_joint`, `identify` and `process` take them.

    table: the pandas.DataFrame they are from; notes: which were taken, and what their units were taken for.
    """

    t: np.ndarray
    q: np.ndarray
    u: np.ndarray
    table: object
    notes: tuple


def read_columns(path, *, t=None, q=None, u=None, time_unit=None, angle_unit=None):
    """Read t, q and u from a table of text, with one joint or several.

        fit_joint(read_columns("servo.csv"))                              # columns t, q, u, or names like these
        identify(read_columns("log.txt", t="stamp", q=("a1", "a2", "a3"), u=("i1", "i2", "i3"), angle_unit="deg"))

    Separated by comma, semicolon, tab or spaces (decimal commas where the separator is none); lines of comment (#, %,
    //), lines before the column names, a line of units below them and further columns do not matter. What pandas reads
    otherwise (Excel, Parquet, HDF): fit_joint(table.time, table.angle, table.torque).

    Args:
        path: of the file, or a pandas.DataFrame.
        t, q, u: names of the columns (case does not matter) or their numbers from 0; several joints: a tuple each.
            None: t or time..., q, angle, position..., u, torque, current, pwm...; q1, q2, q3 for joints.
        time_unit: "s", "ms", "us", "ns"; angle_unit: "rad", "mrad", "deg", "rev". None: as the column's name or the
            line of units says (time_us, q [deg]), else s and rad.

    Returns: Columns; empty cells are NaN. Raises RecordingError that names the file, what is wrong, and the remedy.
    """
    table, units, skipped = (path, [], 0) if hasattr(path, "columns") else _table(path)
    names = [str(name) for name in table.columns]
    places = {
        "t": _places(t, names, _TIME, "t"),
        "q": _places(q, names, _ANGLE, "q"),
        "u": _places(u, names, _DRIVE, "u"),
    }
    if len(places["t"]) != 1 or len(places["q"]) != len(places["u"]):
        counts = ", ".join(f"{len(at)} of {name}" for name, at in places.items())
        raise RecordingError(f"{counts} given or found; name one t, and one u for each q")
    seconds = _unit(time_unit, _TIMES, "time_unit", "s", places["t"][0], names, units)
    radians = [_unit(angle_unit, _ANGLES, "angle_unit", "rad", at, names, units) for at in places["q"]]
    notes = [f"t from '{names[places['t'][0]]}' in {seconds[0]}"]
    notes += [f"q from '{names[at]}' in {unit}" for at, (unit, _) in zip(places["q"], radians, strict=True)]
    notes += [f"u from '{names[at]}'" for at in places["u"]]
    notes += [f"{skipped} line(s) without numbers left out"] if skipped else []
    numbers = table.to_numpy(dtype=float)
    return Columns(
        t=numbers[:, places["t"][0]] * seconds[1],
        q=numbers[:, places["q"]] * [factor for _, factor in radians],
        u=numbers[:, places["u"]],
        table=table,
        notes=tuple(notes),
    )


def _table(path):
    """DataFrame of numbers, units ([] if there are none), and how many lines inside held none."""
    import pandas as pd

    try:
        data = Path(path).read_bytes()
    except (OSError, TypeError, ValueError) as error:
        raise RecordingError(f"cannot read {path!r}: {getattr(error, 'strerror', error)}; check the path") from None
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    comments = [line.lstrip("#%/ ") for line in lines if line.startswith(("#", "%", "//"))]
    lines = [line for line in lines if not line.startswith(("#", "%", "//"))]
    separator = next((s for s in (";", "\t", ",") if sum(s in line for line in lines) > len(lines) / 2), r"\s+")
    rows = [[cell.strip().strip('"') for cell in re.split(separator, line)] for line in lines]
    longest = max(map(len, rows), default=0)
    cells = pd.DataFrame([row + [None] * (longest - len(row)) for row in rows])
    text = cells if separator == "," else cells.map(lambda x: x and x.replace(",", "."))
    numbers = text.apply(pd.to_numeric, errors="coerce")
    words = numbers.isna() & text.notna() & (text != "")
    good = numbers.notna().any(axis=1) & ~words.any(axis=1)
    if not good.any():
        raise RecordingError(f"{path} holds no line of numbers: give a table of text with columns t, q and u")
    first, width = int(good.idxmax()), int(text.loc[good].notna().sum(axis=1).mode()[0])
    above = [
        row[:width].tolist()
        for _, row in cells.iloc[max(first - 2, 0) : first].iterrows()
        if row.notna().sum() == width
    ]
    if not above and comments:  # as numpy.savetxt writes its header
        above = [row for row in [re.split(separator, comments[-1])] if len(row) == width]
    table = numbers.loc[good, : width - 1].reset_index(drop=True)
    table.columns = above[0] if above else [f"column {k}" for k in range(width)]
    return table, above[1] if len(above) > 1 else [], int((~good)[first:].sum())


def _places(asked, names, usual, what):
    """Numbers of the columns that were asked for, or that have a usual name."""
    here = f"there are the columns {', '.join(names)}"
    if asked is not None:
        found, lower = [], [name.lower() for name in names]
        for one in asked if isinstance(asked, (tuple, list)) else (asked,):
            if isinstance(one, str) and one.lower() in lower:
                found.append(lower.index(one.lower()))
            elif isinstance(one, int) and not isinstance(one, bool) and 0 <= one < len(names):
                found.append(one)
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


def _plain(name):
    """A column's name without its unit: 'q1 [deg]' and 'q1_deg' are 'q1'."""
    name = re.sub(r"[\[(].*", "", name.lower()).strip().replace(" ", "_")
    head, _, tail = name.rpartition("_")
    return head if head and tail in _UNITS else name


def _unit(asked, known, option, default, place, names, units):
    """(name, factor) of the unit of a column."""
    if asked is not None and asked not in known:
        raise RecordingError(f"{option} = {asked!r}: choose {', '.join(known)}")
    bracket = re.search(r"[\[(](.*?)[\])]", names[place])
    said = [asked, units[place] if units else "", bracket[1] if bracket else names[place].rpartition("_")[2], default]
    one = next(one for one in (str(x).strip().strip("[]()").lower() for x in said if x) if one in known)
    return one, known[one]
