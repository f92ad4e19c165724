"""Output error: the model whose simulated closed loop is most like the recorded one, Stribeck friction included."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ir50p_lab.controllers.base import check_reference, is_compiled
from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.parameters import FREE_OF_SIGN, NAMES, RIGID_ON, metres
from ir50p_lab.identification.recording_checks import at_bounds
from ir50p_lab.identification.regression import least_squares
from ir50p_lab.identification.time_series import columns_of, sampling_period
from ir50p_lab.identification.validation import compare_signals
from ir50p_lab.inputs import number, vectors3
from ir50p_lab.modelling.dynamics import STANDARD_GRAVITY, as_theta
from ir50p_lab.simulation.loops import sampled_loop
from ir50p_lab.simulation.plant import DRY, FS, LIMIT, QS, make_plant
from ir50p_lab.simulation.simulate import sampled

_STEP = 0.02  # share of a parameter's scale, step of numerical derivatives: with less, stiction makes the output jump
# Share of a parameter's scale: nearer to its bound than this counts as at the bound: the search stops just short
_AT = 0.02
_AT_ERRORS = 0.1  # of its standard error: the same
_QS = (0.005, 0.5)  # rad/s, bounds of the Stribeck speed
_THETA4, _THETA6 = NAMES.index("theta4"), NAMES.index("theta6")
_COULOMB = [0, 1, 2], [NAMES.index(name) for name in ("fc1", "fc2", "fc3")]
_FREE = np.isin(NAMES, FREE_OF_SIGN)


@dataclass(frozen=True, kw_only=True, eq=False)
class OutputError:
    """What `output_error` found.

    theta: (3, 20) in PWM counts, with its stderr (nan: not part of the fit); fs: breakaway friction, (3,) PWM counts,
    and qs: Stribeck speed, (3,) rad/s (1.117), with fs_stderr and qs_stderr; delay: s; warnings: tuple of str.
    """

    theta: np.ndarray
    stderr: np.ndarray
    fs: np.ndarray
    qs: np.ndarray
    fs_stderr: np.ndarray
    qs_stderr: np.ndarray
    delay: float
    warnings: tuple
    unit: str = "PWM"

    def score(self, recording, controller, reference=None):
        """Simulate the loop of another recording; return (Validation of "q", Validation of "u")."""
        run = ClosedLoopRun(recording, controller, reference, delay=self.delay)
        q, u = run.simulate(self.theta, self.fs, self.qs)
        return compare_signals(run.t, run.q, q, "q"), compare_signals(run.t, run.u, u, "u")


class ClosedLoopRun:
    """A recording and everything that is needed to repeat it in simulation; the arguments are those of `output_error`.

    Attributes: t (m,) s, q (m, 3) rad, u (m, 3) PWM counts, the reference r (m, 3, 3), the pose at the start (3,) rad,
    period, s.
    """

    def __init__(self, recording, controller, reference=None, *, delay=0.0, seconds=np.inf):
        t, q, u = columns_of(recording)
        self.period, self.controller = sampling_period(t), controller
        n = int(min(len(t), np.round(number("seconds", seconds, "> 0 or inf", unit="s") / self.period)))
        if q.shape[1] != 3 or n < 50:
            raise InputError(f"{n} samples of {q.shape[1]} joint(s): give 50 or more of all three joints")
        if np.abs(np.diff(t) - self.period).max() > 0.1 * self.period:
            raise InputError("the times are uneven or have gaps, which no simulated loop has: cut with between(t0, t1)")
        if not is_compiled(controller):
            raise InputError(f"controller is a {type(controller).__name__}: give the PID (or other) of the run")
        if reference is not None:
            check_reference(reference, sampled=True)
            rows = sampled(reference, t)
        elif (angles := getattr(recording, "reference", None)) is None:
            raise InputError("the recording holds no reference: give reference=, the motion that was asked for")
        else:
            angles = vectors3("reference of the recording", angles)
            qd = np.gradient(angles, self.period, axis=0)
            rows = np.stack([angles, qd, np.gradient(qd, self.period, axis=0)], axis=1)
        self.t, self.q, self.u, self.r = (np.ascontiguousarray(x[:n]) for x in (t, q, u, rows))
        self.start = q[:5].mean(axis=0)  # the arm has hardly moved by then
        self.late = round(number("delay", delay, ">= 0", unit="s") / self.period)

    def simulate(self, theta, fs=None, qs=None, *, step=0.001):
        """Return q and u (PWM), (m, 3) each, of the loop with this model; fs, qs (3,): breakaway and Stribeck speed."""
        plant = make_plant(theta, unit="PWM", g=STANDARD_GRAVITY)
        plant.numbers[LIMIT : LIMIT + 3] = 255.0
        if fs is not None:
            plant.numbers[FS : FS + 3], plant.numbers[QS : QS + 3], plant.numbers[DRY] = fs, qs, 1.0
        law = self.controller.parameters, np.zeros_like(self.controller.state)
        x, (q, qd, u) = np.r_[self.start, 0.0, 0.0, 0.0], np.empty((3, *self.q.shape))
        steps = max(1, round(self.period / step))
        h = self.period / steps
        sampled_loop(plant.theta, plant.numbers, *law, self.t, self.r, x, self.late, h, steps, q, qd, u)
        return q, u


def output_error(
    estimate, recording, controller, reference=None, *, delay=0.02, l2=None, seconds=30, iterations=12, progress=True
):
    """Refine an estimate by least squares on the q and u of the simulated closed loop.

    Nothing is differentiated, and noise in the angles does no harm: the model is driven by the same controller on the
    same reference from the same start. The simulated arm may stick, so that breakaway friction fs and the Stribeck
    speed qs can be found, which no linear theta has (the thesis's closing complaint). Inertial and friction terms stay
    >= 0, and fs >= fc.

    Args:
        estimate: Estimate or theta (3, 20) to start from, as `identify` gives it. recording; reference: its motion
        (None: as recorded, differentiated); controller: that of the run, a compiled one such as PID. delay: s, rounded
        to whole periods. l2: m, keeps theta6 = l2 theta4. seconds: how much of the recording is used, s. iterations: at
        most. progress: whether a bar is shown.

    Returns: OutputError. A value left at a bound (0; for qs 0.005 and 0.5 rad/s) is named, and its error is inf. Raises
    InputError on bad arguments; IdentificationError if the first model's loop runs away.
    """
    theta, _ = as_theta(getattr(estimate, "theta", estimate))
    if getattr(estimate, "unit", "PWM") != "PWM":
        raise InputError(f"the estimate is in {estimate.unit}: the loop is simulated in PWM counts")
    from scipy.optimize import least_squares as minimise
    from tqdm.auto import tqdm

    run = ClosedLoopRun(recording, controller, reference, delay=delay, seconds=seconds)
    l2 = None if l2 is None else metres("l2", l2)
    fitted = np.array([np.isin(range(20), columns) for columns in RIGID_ON])
    fitted[1:, _THETA6] &= l2 is None
    start, size = theta[fitted], np.broadcast_to(np.abs(theta).max(axis=1)[:, None], theta.shape)[fitted]
    scale = np.maximum(0.3 * np.abs(start), 1e-3 * size)
    free = np.broadcast_to(_FREE, theta.shape)[fitted]
    coulomb = np.maximum(theta[_COULOMB], 1e-9)
    x0 = np.r_[np.where(free, start, np.maximum(start, 1e-6 * scale)), 0.3 * coulomb, np.full(3, 0.05)]
    scale = np.r_[scale, 0.3 * coulomb, np.full(3, 0.02)]
    low = np.r_[np.where(free, -np.inf, 0.0), np.zeros(3), np.full(3, _QS[0])]
    high = np.r_[np.full(len(start) + 3, np.inf), np.full(3, _QS[1])]
    names = [f"joint {j + 1}: {NAMES[k]}" for j, k in np.argwhere(fitted)]
    names += [f"joint {j}: {what}" for what in ("fs - fc", "qs") for j in (1, 2, 3)]

    def spread_out(base, x):
        """A copy of base (3, 20) with the entries of x in it."""
        base = base.copy()
        base[fitted] = x[:-6]
        if l2 is not None:
            base[1:, _THETA6] = l2 * base[1:, _THETA4]
        return base

    def model_of(x):
        whole = spread_out(theta, x)
        return whole, whole[_COULOMB] + x[-6:-3], x[-3:]

    measured, first = np.hstack([run.q, run.u]), np.hstack(run.simulate(*model_of(x0), step=0.002))
    if not np.isfinite(first).all():
        raise IdentificationError("the loop with the first estimate runs away: fit it with method='bounded' first")
    # noise, from third differences (variance 20 sigma^2; slow motion has none), and a tenth of the first misfit
    noise = np.sqrt(np.mean(np.diff(measured, 3, axis=0) ** 2, axis=0) / 20)
    weights = 1 / np.maximum(np.hypot(noise, 0.1 * np.std(measured - first, axis=0)), 1e-6 * measured.std(axis=0))

    def residuals(x):
        left = weights * (measured - np.hstack(run.simulate(*model_of(x), step=0.002)))
        return np.nan_to_num(left, nan=1e3, posinf=1e3, neginf=-1e3).ravel()

    bar = tqdm(total=iterations, disable=not progress, unit="step", desc="output error")

    def slopes(x):
        bar.update(1)
        moves = np.diag(np.maximum(np.minimum(_STEP * scale, 0.5 * (x - low)), 1e-4 * _STEP * scale))
        ahead, behind = np.split(np.array(list(pool.map(residuals, [*(x + moves), *(x - moves)]))), 2)
        return (ahead - behind).T / (2 * moves.diagonal())

    with bar, ThreadPoolExecutor(2) as pool:
        found = minimise(residuals, x0, slopes, bounds=(low, high), x_scale=scale, max_nfev=iterations, ftol=1e-4)
        bar.update(iterations - bar.n)  # it may have settled before
    spread = least_squares(found.jac.reshape(-1, 6, len(x0)), found.fun.reshape(-1, 6), names=names)
    known = np.where(np.isfinite(spread.stderr), spread.stderr, 0.0)
    said, at = at_bounds(names, found.x, low, high, np.maximum(_AT * scale, _AT_ERRORS * known))
    notes, stderr = [*spread.warnings, *said], np.where(at, np.inf, spread.stderr)
    if found.status == 0:
        notes.append(f"not settled after {iterations} steps: give more, or a better first estimate")
    whole, fs, qs = model_of(found.x)
    both = np.array([[name in (f"joint {j}: fc{j}", f"joint {j}: fs - fc") for name in names] for j in (1, 2, 3)])
    fs_stderr = np.sqrt(np.einsum("ij,jk,ik->i", both, spread.covariance, both))
    return OutputError(
        theta=whole,
        stderr=spread_out(np.full((3, 20), np.nan), stderr),
        fs=fs,
        qs=qs,
        fs_stderr=np.where((both & np.isinf(stderr)).any(axis=1), np.inf, fs_stderr),
        qs_stderr=stderr[-3:],
        delay=float(delay),
        warnings=tuple(notes),
    )
