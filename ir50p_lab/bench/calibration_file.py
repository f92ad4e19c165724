"""Calibrations as TOML files: readable, one per arm."""

import tomllib
from pathlib import Path

import tomlkit

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers

_HEAD = "counts = zero + slope q, joints 1 to 3: counts of the 10-bit converter, slope in counts/rad, q in rad"
_TEXTS = ("arm", "source")
_NUMBERS = ("slope", "zero", "stderr_slope", "stderr_zero")
_JOINTS = ("joint1", "joint2", "joint3")


def write_calibration(calibration, path):
    """Write `calibration`; every number with all its digits. Returns the Path; see `JointCalibration.save`."""
    fields = {name: getattr(calibration, name) for name in (*_TEXTS, *_NUMBERS, "remarks")}
    points = [{"q": list(q), "counts": list(counts)} for q, counts in calibration.points]
    document = tomlkit.document().add(tomlkit.comment(_HEAD))
    document.update({name: list(v) if isinstance(v, tuple) else v for name, v in fields.items() if v is not None})
    document.update(zip(_JOINTS, points, strict=False))
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
        return cls(**_fields(tomllib.loads(path.read_text(encoding="utf-8"))))
    except OSError as error:
        raise InputError(
            f"cannot read the calibration file {path}: {error.strerror}; check the path, or calibrate (notebook 10)"
        ) from None
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"{path} is not a TOML file: {error}. Write one with JointCalibration.save") from None


def _fields(data):
    known = (*_TEXTS, *_NUMBERS, "remarks", *_JOINTS)
    unknown = [name for name in data if name not in known]
    missing = [name for name in ("slope", "zero") if name not in data]
    if unknown:
        raise InputError(f"unknown entry {unknown[0]!r}; known: {', '.join(known)}")
    if missing:
        raise InputError(f"it lacks {' and '.join(missing)}")
    fields = {name: data[name] for name in (*_TEXTS, *_NUMBERS) if name in data}
    remarks = data.get("remarks", [])
    texts = [fields.get(name, "") for name in _TEXTS]
    if not isinstance(remarks, list) or not all(isinstance(text, str) for text in (*texts, *remarks)):
        raise InputError("arm and source must be text in quotes, remarks a list of such texts")
    if any(name in data for name in _JOINTS):
        fields["points"] = tuple(_points(name, data.get(name, {"q": [], "counts": []})) for name in _JOINTS)
    return fields | {"remarks": tuple(remarks)}


def _points(name, table):
    if not isinstance(table, dict) or not {"q", "counts"} <= set(table):
        raise InputError(f"[{name}] must hold two lists of numbers, q (rad) and counts")
    q, counts = (numbers(f"{key} of [{name}]", table[key]) for key in ("q", "counts"))
    if q.ndim != 1 or q.shape != counts.shape:
        raise InputError(f"[{name}] holds angles {q.shape} but counts {counts.shape}: they belong together in pairs")
    return tuple(q.tolist()), tuple(counts.tolist())
