"""Arms as TOML files that are easy to read, with the units in comments."""

import dataclasses
import tomllib
from pathlib import Path

import tomlkit

from ir50p_lab.errors import ArmError, LabError
from ir50p_lab.home import read_text
from ir50p_lab.modelling.actuators import Actuators
from ir50p_lab.modelling.friction import Friction

_PARTS = {"friction": Friction, "actuators": Actuators}


def write_arm(arm, path):
    """Write `arm` to `path` as TOML, every number with all its digits, so that reading gives the same arm."""
    document = tomlkit.document()
    document.add(tomlkit.comment("An arm for the IR50P lab book. SI units; joints and links 1, 2, 3 in order."))
    _fill(document, arm)
    for name in _PARTS:
        if getattr(arm, name) is not None:
            document.add(name, _fill(tomlkit.table(), getattr(arm, name)))
    Path(path).write_text(tomlkit.dumps(document), encoding="utf-8")


def _fill(table, part):
    for field in dataclasses.fields(part):
        if field.name not in _PARTS:
            table.add(field.name, getattr(part, field.name))
            if field.metadata:
                table[field.name].comment(field.metadata["comment"])
    return table


def read_arm(cls, path):
    """Read an arm, an object of class `cls`, from a TOML file.

    Raises ArmError, which names the file, if it is missing, is not TOML, lacks a field, has an unknown field (then
    the known ones are listed), or describes an impossible arm.
    """
    try:
        data = tomllib.loads(read_text(path, ArmError))
    except OSError as error:
        raise ArmError(f"cannot read the arm file {path}: {error.strerror}; check the path or IR50P_ARM") from None
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise ArmError(f"{path} is not a TOML file: {error}. Write one with Arm.save and edit it") from None
    try:
        parts = {name: _make(part, data.pop(name)) for name, part in _PARTS.items() if name in data}
        return _make(cls, {**data, **parts})
    except LabError as error:
        raise ArmError(f"{path}: {error}") from None


def _make(cls, data):
    if not isinstance(data, dict):
        raise ArmError(f"[{cls.__name__.lower()}] must be a table of values, got {data!r}")
    required = {field.name: field.default is dataclasses.MISSING for field in dataclasses.fields(cls)}
    for name in data:
        if name not in required:
            raise ArmError(f"unknown entry '{name}' for {cls.__name__}; known: {', '.join(required)}")
    missing = [name for name in required if required[name] and name not in data]
    if missing:
        raise ArmError(f"{cls.__name__} lacks {', '.join(missing)}")
    return cls(**data)
