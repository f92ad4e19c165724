"""Calibrations as TOML files: readable, with units in comments, one per arm."""

import tomllib
from pathlib import Path

import tomlkit

from ir50p_lab.errors import InputError

_COMMENTS = {
    "slope": "counts/rad, joints 1 to 3",
    "zero": "counts at q = 0",
    "stderr_slope": "counts/rad, standard error",
    "stderr_zero": "counts, standard error",
}
_TEXTS = ("arm", "source")


def write_calibration(calibration, path):
    """Write `calibration`; every number with all its digits. Returns the Path; see `JointCalibration.save`."""
    document = tomlkit.document()
    document.add(
        tomlkit.comment("Calibration of the potentiometers: counts = zero + slope q (10-bit counts, q in rad).")
    )
    for name in _TEXTS:
        document.add(name, getattr(calibration, name))
    for name, comment in _COMMENTS.items():
        value = getattr(calibration, name)
        if value is not None:
            document.add(name, list(value))
            document[name].comment(comment)
    if calibration.remarks:
        document.add("remarks", list(calibration.remarks))
    for joint, (q, counts) in enumerate(calibration.points, 1):
        table = tomlkit.table()
        table.add("q", list(q))
        table["q"].comment("rad, as measured")
        table.add("counts", list(counts))
        document.add(f"joint{joint}", table)
    path = Path(path)
    try:
        path.write_text(tomlkit.dumps(document), encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot write the calibration to {path}: {error.strerror}; give another path") from None
    return path


def read_calibration(cls, path):
    """Read a calibration file as an object of `cls`; see `JointCalibration.load`."""
    path = Path(path)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(
            f"cannot read the calibration file {path}: {error.strerror}; check the path, or calibrate (notebook 10)"
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"{path} is not a TOML file: {error}. Write one with JointCalibration.save") from None
    try:
        return cls(**_fields(data))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _fields(data):
    joints = [f"joint{i}" for i in (1, 2, 3)]
    known = (*_TEXTS, *_COMMENTS, "remarks", *joints)
    for name in data:
        if name not in known:
            raise InputError(f"unknown entry '{name}'; known: {', '.join(known)}")
    missing = [name for name in ("slope", "zero") if name not in data]
    if missing:
        raise InputError(f"it lacks {' and '.join(missing)}")
    points = ()
    if any(name in data for name in joints):
        points = tuple(_points(name, data.get(name, {"q": [], "counts": []})) for name in joints)
    texts = {name: data[name] for name in _TEXTS if name in data}
    remarks = data.get("remarks", [])
    if not isinstance(remarks, list) or not all(isinstance(text, str) for text in (*texts.values(), *remarks)):
        raise InputError("arm and source must be text in quotes, remarks a list of such texts")
    numbers = {name: data[name] for name in _COMMENTS if name in data}
    return {**numbers, **texts, "remarks": tuple(remarks), "points": points}


def _points(name, table):
    try:
        q, counts = (tuple(float(x) for x in table[key]) for key in ("q", "counts"))
    except (KeyError, TypeError, ValueError):
        raise InputError(f"[{name}] must hold two lists of numbers, q (rad) and counts") from None
    if len(q) != len(counts):
        raise InputError(f"[{name}] holds {len(q)} angles but {len(counts)} counts: they belong together in pairs")
    return q, counts
