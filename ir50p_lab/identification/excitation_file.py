"""Motions in a file: what took long to optimise is kept, with the command that made it."""

import json
from os import PathLike
from pathlib import Path

from ir50p_lab.errors import InputError
from ir50p_lab.signals.fourier import Fourier, fourier

DATA = Path(__file__).resolve().parents[2] / "data" / "excitation_ir50p.json"


def save_excitations(path, motions, *, made_by):
    """Write {name: Fourier} to a JSON file, every digit kept. made_by: the command. Returns the path."""
    rows = {}
    for name, motion in motions.items():
        if not isinstance(motion, Fourier):
            raise InputError(f"{name} is a {type(motion).__name__}: only motions made by `fourier` can be kept")
        periods = round((motion.duration - motion.start) / motion.period)
        rows[name] = {"period": motion.period, "periods": periods, "q0": motion.q0, "a": motion.a, "b": motion.b}
    text = json.dumps({"made_by": made_by, "unit": "rad, s", "motions": rows}, indent=1)
    path = _path(path)
    try:
        path.write_text(text + "\n", encoding="ascii")
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}; choose another place") from None
    return path


def load_excitations(path=None):
    """Motions from a file of `save_excitations`, {name: Fourier}; default: those in data/excitation_ir50p.json.

    That file holds "plain" (random coefficients as large as the limits allow), "training" and "validation 1" to
    "validation 20" (optimised, tried in simulation). Raises InputError if the file cannot be read or is no such file.
    """
    path = DATA if path is None else _path(path)
    try:
        rows = json.loads(path.read_text(encoding="ascii"))["motions"]
        return {name: fourier(**row) for name, row in rows.items()}
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}; give a file made by save_excitations") from None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise InputError(f"{path} is no file of excitations ({error!r:.80}): make it with save_excitations") from None


def _path(path):
    if not isinstance(path, (str, PathLike)):
        raise InputError(f"path = {path!r:.60}: give the path of a file")
    return Path(path)
