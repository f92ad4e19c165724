"""From a recording (t, q, u) to (q, qd, qdd, u) for a regression; every step is an argument, to compare variants."""

import math
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.time_series import columns_of, runs, sampling_period
from ir50p_lab.inputs import choice, number
from ir50p_lab.signals.low_pass import low_pass

BOTH = "zero-phase"  # the filter runs in both directions
_ORDER = 4  # order of the zero-phase filter; running forward and backward doubles it
_SHORTEST = 16  # samples: a shorter run without a gap is left out, for the filter cannot run backward over it
_TRIM = 2.0  # time constants 1/(2 pi cutoff) of the filter: cut off by default at both ends of a run


@dataclass(frozen=True)
class Motion:
    """A recording prepared for a regression, with k joints (for a single joint k = 1, and the arrays are (m, 1)).

    ============= ======== ============================================================================
    t             (m,)     s
    q, qd, qdd    (m, k)   rad, rad/s, rad/s^2
    u             (m, k)   command or torque that belongs to these instants, in its own unit
    use           (m, k)   bool: whether the sample of that joint is to be used (False: too near to zero speed)
    segment       (m,)     int: number of the stretch without a gap
    rate_hz       float    samples per s
    ============= ======== ============================================================================
    """

    t: np.ndarray
    q: np.ndarray
    qd: np.ndarray
    qdd: np.ndarray
    u: np.ndarray
    use: np.ndarray
    segment: np.ndarray
    rate_hz: float

    def __len__(self):
        return len(self.t)


def causal_derivatives(q, rate_hz, *, cutoff_hz=3.0):
    """Return derivatives as a running loop can take them (thesis): first-order low pass, two backward differences.

        q_f[k] = filter of q,    qd[k] = (q_f[k] - q_f[k-1]) rate,    qdd[k] = (qd[k] - qd[k-1]) rate

    The angle lags by 1/(2 pi cutoff) (53 ms at 3 Hz), the velocity by half a period more, the acceleration by a whole
    one; a u that does not lag belongs to another instant. The filter starts settled on the first sample.

    Args: q: (n,) or (n, k) rad, evenly sampled; rate_hz: samples per s; cutoff_hz: Hz, below rate_hz/2.
    Returns: q, qd, qdd like q; the first qd and the first two qdd are 0. Raises InputError as `low_pass` does.
    """
    q = low_pass(q, cutoff_hz, rate_hz)
    qd = np.diff(q, axis=0, prepend=q[:1]) * rate_hz
    return q, qd, np.diff(qd, axis=0, prepend=qd[:1]) * rate_hz


def central_derivatives(q, rate_hz, *, cutoff_hz=1.5, order=_ORDER):
    """Return derivatives without lag, for finished records: filtered forward and backward, then central differences.

        qd[k] = (q[k+1] - q[k-1]) rate/2,    qdd[k] = (q[k+1] - 2 q[k] + q[k-1]) rate^2

    Args: q: (n,) or (n, k) rad, evenly sampled; rate_hz: samples per s; cutoff_hz: of the Butterworth filter, Hz, below
    rate_hz/2, or None for no filter; order: 1..8 (applied twice). Returns: q, qd, qdd like q; the first and the last
    sample have their neighbour's derivatives. Raises InputError as `low_pass` does.
    """
    q = np.array(q, dtype=float) if cutoff_hz is None else low_pass(q, cutoff_hz, rate_hz, order=order, kind=BOTH)
    if len(q) < 3:
        raise InputError(f"q has {len(q)} samples: central differences need three or more")
    inner = np.arange(len(q)).clip(1, len(q) - 2)
    before, here, after = q[inner - 1], q[inner], q[inner + 1]
    return q, (after - before) * (rate_hz / 2), (after - 2 * here + before) * rate_hz**2


def process(
    recording, q=None, u=None, *, derivatives=BOTH, cutoff_hz=1.5, filter_u=False, delay=0, held=True, slow=0, trim=None
):
    """Prepare a recording for a regression.

        for name, options in {"thesis": {"derivatives": "causal", "cutoff_hz": 3}, "zero-phase": {}}.items():
            motion = process(recording, **options)

    What happens, in this order: the record is split where a time step is longer than 3.5 times the usual ones (nine in
    ten of them); uneven samples are put on an even grid of the median period (cubic spline for q); q is filtered and
    differentiated; u is taken at the instant when it acted; the ends, where a filter has only one side, are cut off;
    samples near zero speed are marked.

    Args:
        recording: anything with t (n,), q (n, k) and u (n, k), such as a `Recording`; or t itself, followed by q and u
            as arrays, (n,) or (n, k).
        derivatives: "zero-phase" (`central_derivatives`) or "causal" (`causal_derivatives`).
        cutoff_hz: of the low pass. It is of order 4 for "zero-phase", where cutoff_hz may be None, and 1 for "causal".
        filter_u: whether u passes through the same filter as q.
        delay: s from a sample to the moment when its u acts (notebook 11 measures it).
        held: True: u is held from its sample to the next, as a bench does; what acts around the instant t_k is then the
            mean of u_k-1 and u_k. False: u is a measurement at t_k. "causal" takes u as it stands, as the thesis does,
            only shifted by the delay.
        slow: rad/s; below it sgn(qd) is noise and a joint may stick: `use` is False there.
        trim: s cut off at both ends of each stretch without a gap; default 2/(2 pi cutoff_hz).

    Returns: Motion. Raises: InputError on bad arguments, NaN, or times that do not increase; IdentificationError if
    nothing is left.
    """
    t, q, u = columns_of(recording, q, u)
    period = sampling_period(t)
    causal = choice("derivatives", derivatives, (BOTH, "causal")) == "causal"
    number("delay", delay, ">= 0", unit="s")
    number("slow", slow, ">= 0", unit="rad/s")
    derive = causal_derivatives if causal else central_derivatives
    if trim is None and (causal or cutoff_hz is not None):
        trim = _TRIM / (2 * math.pi * number("cutoff_hz", cutoff_hz, "> 0", unit="Hz"))
    trim = number("trim", trim or 0.0, ">= 0", unit="s")
    acting = _held_around if choice("held", held, (True, False)) and not causal else _measured_at
    pieces = []
    shortest = max(_SHORTEST, math.ceil(2 * trim / period) + 4)
    for k, (first, last) in enumerate(runs(t, 3.5 * np.quantile(np.diff(t), 0.9))):
        if last - first < shortest:
            continue
        here = slice(first, last)
        grid, even_q = _on_even_steps(t[here], q[here], period)
        even_u = acting(grid, t[here] + delay, u[here])
        even_u = derive(even_u, 1 / period, cutoff_hz=cutoff_hz)[0] if filter_u else even_u
        piece = [grid, *derive(even_q, 1 / period, cutoff_hz=cutoff_hz), even_u]
        keep = (grid >= grid[0] + max(trim, delay) - 1e-9) & (grid <= grid[-1] - trim + 1e-9)
        keep[[0, -1]] = False  # their derivatives were copied from the neighbours
        pieces.append([x[keep] for x in piece] + [np.full(keep.sum(), k)])
    if sum(len(piece[0]) for piece in pieces) < 2:
        raise IdentificationError(f"nothing is left: no run of {shortest} samples; record longer, or raise cutoff_hz")
    t, q, qd, qdd, u, segment = (np.concatenate(x) for x in zip(*pieces, strict=True))
    return Motion(t, q, qd, qdd, u, np.abs(qd) >= slow, segment, 1 / period)


def _on_even_steps(t, q, period):
    """One run without gaps on an even grid of time: grid, q."""
    grid = t[0] + period * np.arange(math.floor((t[-1] - t[0]) / period + 1e-6) + 1)
    if len(grid) == len(t) and np.abs(t - grid).max() <= 0.02 * period:
        return t, q
    from scipy.interpolate import make_interp_spline

    return grid, make_interp_spline(t, q, k=3, axis=0)(np.minimum(grid, t[-1]))


def _measured_at(grid, t, u):
    """u (n, k), measured at the times t (n,), at the instants `grid`."""
    return np.column_stack([np.interp(grid, t, column) for column in u.T])


def _held_around(grid, t, u):
    """Mean of a u (n, k) that is held from its t (n,) to the next, from halfway to halfway between the instants `grid`.

    Before and after it is taken to be the same.
    """
    around = np.pad(grid, 1, mode="reflect", reflect_type="odd")
    ends = (around[1:] + around[:-1]) / 2
    edges = np.r_[min(ends[0], t[0] - 1.0), t, max(ends[-1], t[-1] + 1.0)]
    held = np.vstack([u[:1], u])
    area = np.cumsum(np.vstack([0 * u[:1], held * np.diff(edges)[:, None]]), axis=0)
    return np.diff(_measured_at(ends, edges, area), axis=0) / np.diff(ends)[:, None]
