"""Runs as rows of float32, which is what the view in the browser plays."""

import numpy as np

from ir50p_lab.errors import InputError

_MOST = 600  # rows: 40 kB in a saved notebook, 20 rows a second for half a minute; the view interpolates


def pack(runs, labels):
    """Rows of one or two runs on a common time, and what stands in their columns.

    Args: runs: each with t (n,) s and q (n, 3) rad; optional reference (n, 3) or (n, 3, 3) rad, u (n, 3), unit,
    simulated (bool). labels: a name for each.
    Returns: bytes of float32 (rows, columns), time first; dict for the browser. Raises InputError for runs that
    cannot be shown.
    """
    times = [np.asarray(run.t, dtype=float) for run in runs]
    if len(runs) > 2 or len(labels) != len(runs) or min(map(len, times)) < 2:
        raise InputError("give one or two runs of two samples or more, and a label for each")
    t = times[0]
    if len(runs) == 2 or len(t) > _MOST:
        t = np.linspace(min(one[0] for one in times), max(one[-1] for one in times), min(_MOST, max(map(len, times))))
    columns, places = [t], []
    for run, time, label in zip(runs, times, labels, strict=True):
        place = {"label": label, "reference": None, "u": None}
        held = np.clip(np.searchsorted(time, t, side="right") - 1, 0, len(time) - 1)
        for name in ("q", "reference", "u"):
            values = getattr(run, name, None)
            if values is not None and np.isfinite(values).any():
                place[name] = len(columns)
                values = np.reshape(values, (len(time), -1))  # of a reference, angles first
                columns += [values[held, i] if name == "u" else np.interp(t, time, values[:, i]) for i in range(3)]
        places.append(place)
    source = {True: "simulated", False: "measured"}.get(getattr(runs[0], "simulated", None), "")
    shape = {"columns": len(columns), "runs": places, "unit": getattr(runs[0], "unit", "PWM"), "source": source}
    return np.column_stack(columns).astype("<f4").tobytes(), shape
