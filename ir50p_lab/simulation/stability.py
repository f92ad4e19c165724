"""Does a finished run look unstable? The drive's limits keep the numbers finite, so that being finite does not tell."""

import numpy as np

_FEW = 40  # samples; a shorter run shows no habit
_JUMPS = 3  # from limit to limit in a quarter of the run: more than a loop needs that is about to settle
_TURN = 2 * np.pi


def looks_unstable(t, r, q, u, limit, *, follows=True):
    """Return what looks unstable in a run, in one sentence; "" if nothing does.

    The last quarter of the run is inspected, joint by joint, for two signs:

    - From limit to limit: the set point rests, yet the command goes from one limit to the other at least three times.
      If no limit is known, the largest command of the last quarter is taken for it, provided that it is at least half
      of the largest of the run and that the command is that large at least half of the time: a square wave, as a limit
      hidden in the controller makes it. (An undamped swing is a sine: it is near its peaks a fifth of the time.)
    - Running away: the error grew by more than a turn over its start. This is not looked for if `follows` is False (no
      reference was given: nobody asked the arm to be anywhere).

    Args: t (n,) s; r (n, 3, 3) reference; q (n, 3) rad; u (n, 3) applied command, and its limit (3,), infinite where
        none is known. Everything else must be finite.
    """
    if len(t) < _FEW:
        return ""
    last = slice(3 * len(t) // 4, None)
    span = f"in the last {t[-1] - t[last][0]:.3g} s of the run"
    for i in range(3):
        rests = (r[last, 0, i] == r[-1, 0, i]).all() and not r[last, 1, i].any()
        jumps = _jumps(u[:, i], last, limit[i]) if rests else 0
        if jumps >= _JUMPS:
            return f"{span} the command of joint {i + 1} goes {jumps} times from limit to limit"
        e = np.abs(r[:, 0, i] - q[:, i])
        if follows and e[last].max() > e[0] + _TURN:
            return f"{span} the error of joint {i + 1} is {e[last].max():.3g} rad, at its start it was {e[0]:.3g} rad"
    return ""


def _jumps(u, last, limit):
    """How often u goes from one limit to the other in the part `last`."""
    known = np.isfinite(limit)
    top = limit if known else np.abs(u[last]).max()
    if not known and top < max(0.5 * np.abs(u).max(), 1e-9):
        return 0
    extreme = np.abs(u[last]) >= 0.95 * top
    if not known and 2 * extreme.sum() < extreme.size:
        return 0
    sides = np.sign(u[last][extreme])
    return int((sides[1:] != sides[:-1]).sum())
