"""Motions in a file: what took long to optimise is kept, together with the command that made it."""

import json
from pathlib import Path

from ir50p_lab.errors import InputError
from ir50p_lab.signals.fourier import fourier

DATA = Path(__file__).resolve().parents[2] / "data" / "excitation_ir50p.json"


def load_excitations(path=DATA):
    """Return the motions in a file, {name: Fourier}; by default those of data/excitation_ir50p.json.

    That file holds "plain" (random coefficients as large as the limits allow), "training" and "validation 1" to
    "validation 20" (optimised, tried in simulation). Raises InputError if the file cannot be read or has another form.
    """
    try:
        rows = json.loads(Path(path).read_text(encoding="ascii"))["motions"]
        return {name: fourier(**row) for name, row in rows.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise InputError(f"{path} is not a file of excitations such as {DATA.name}: {error!r:.80}") from None
