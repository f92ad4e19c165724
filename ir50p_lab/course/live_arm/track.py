"""Runs as rows of float32, which is what the view in the browser plays."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.modelling.chain import forward_kinematics

_MOST = 600  # rows: 40 kB in a saved notebook, 20 rows a second for half a minute; the view interpolates


def pack(runs, labels):
    """Rows of one or two runs on a common time, and what stands in their columns.

    Args: runs: each with t (n,) s and q (n, 3) rad; optional reference (n, 3) or (n, 3, 3) rad, u (n, 3), unit,
    simulated (bool). labels: a name for each.
    Returns: bytes of float32 (rows, columns), time first; dict for the browser. Raises InputError for runs that
    cannot be shown.
    """
    if not 1 <= len(runs) <= 2 or len(labels) != len(runs):
        raise InputError(f"{len(runs)} runs and {len(labels)} labels: give one or two runs, and a label for each")
    times = [np.asarray(run.t, dtype=float) for run in runs]
    if min(map(len, times)) < 2:
        raise InputError("a run of less than two samples has no motion to play")
    t = times[0]
    if len(runs) == 2 or len(t) > _MOST:
        t = np.linspace(min(one[0] for one in times), max(one[-1] for one in times), min(_MOST, max(map(len, times))))
    columns, places = [t], []
    for run, time, label in zip(runs, times, labels, strict=True):
        place = {"label": label}
        held = np.clip(np.searchsorted(time, t, side="right") - 1, 0, len(time) - 1)
        for name, values in (("q", run.q), ("reference", _reference(run)), ("u", getattr(run, "u", None))):
            known = values is not None and np.isfinite(values).any()
            place[name] = len(columns) if known else None
            if known:
                columns += [values[held, i] if name == "u" else np.interp(t, time, values[:, i]) for i in range(3)]
        places.append(place)
    source = {True: "simulated", False: "measured"}.get(getattr(runs[0], "simulated", None), "")
    shape = {"columns": len(columns), "runs": places, "unit": getattr(runs[0], "unit", "PWM"), "source": source}
    return np.column_stack(columns).astype("<f4").tobytes(), shape


def _reference(run):
    reference = getattr(run, "reference", None)
    return reference[:, 0] if reference is not None and np.ndim(reference) == 3 else reference


def path_of(arm, rows, shape):
    """Path of the tip (n, 3) m of the first packed run."""
    first = shape["runs"][0]["q"]
    return forward_kinematics(arm, np.frombuffer(rows, "<f4").reshape(-1, shape["columns"])[:, first : first + 3])
