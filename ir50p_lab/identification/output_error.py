"""Output error: the model whose simulated closed loop is most like the recorded one; it can tell Stribeck friction."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.closed_loop import ClosedLoopRun, runs_of
from ir50p_lab.identification.parameters import ACTS_ON, FREE_OF_SIGN, NAMES, RIGID_ON, metres
from ir50p_lab.identification.regression import least_squares
from ir50p_lab.identification.validation import compared
from ir50p_lab.modelling.dynamics import as_theta

_STEP = 0.02  # of a parameter's scale, for differences: stiction makes the output jump on smaller ones
_PERIOD = 0.002  # s, of the simulation
_QS = (0.005, 0.5)  # rad/s, bounds of the Stribeck speed
_THETA4, _THETA6 = NAMES.index("theta4"), NAMES.index("theta6")
_COULOMB = [0, 1, 2], [NAMES.index(name) for name in ("fc1", "fc2", "fc3")]


@dataclass(frozen=True, kw_only=True, eq=False)
class OutputError:
    """What `output_error` found; theta may be used wherever an Estimate's may.

    ============ ============================================================================== ===========
    theta        parameters                                                                      (3, 20) PWM
    stderr       standard errors; nan: not part of the fit                                       (3, 20) PWM
    fs, qs       breakaway friction, Stribeck speed (1.117)                                      (3,) PWM, rad/s
    fs_stderr, qs_stderr                                                                         (3,)
    warnings     tuple of str
    ============ ============================================================================== ===========
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
        """Simulate the loop of another recording: (Validation of "q", Validation of "u")."""
        run = ClosedLoopRun(recording, controller, reference, delay=self.delay)
        q, u = run.simulate(self.theta, self.fs, self.qs)
        return compared(run.t, run.q, q, "q"), compared(run.t, run.u, u, "u")


def output_error(
    estimate, recordings, controller, references=None, *, delay=0.02, l2=None, seconds=30, iterations=12, progress=True
):
    """Refine an estimate: least squares on the q and u of the simulated closed loop.

    The regression compares torques, from angles that must be differentiated; here nothing is differentiated, and noise
    in the angles does no harm. The model is driven by the same controller on the same reference from the same start.
    It may stick, so that breakaway friction fs and the Stribeck speed qs can be found, which no linear theta holds
    (the thesis' closing complaint). Residuals of q and of u are weighted by what their high frequencies show as noise
    plus what the first simulation misses; inertial and friction terms stay >= 0, fs >= fc.

    Args:
        estimate: Estimate or theta (3, 20) to start from: `identify`. Parameters not in it stay as they are.
        recordings: a Recording or a list; references: the motion of all or of each (None: as recorded,
        differentiated);
        controller: of the runs, a compiled one such as PID, with its gains. delay: s, whole periods.
        l2: m, keeps theta6 = l2 theta4. seconds: s of each recording that are used. iterations: at most.
        progress: show a bar.

    Returns: OutputError. Raises InputError on bad arguments; IdentificationError if the first model's loop runs away.
    """
    theta, _ = as_theta(getattr(estimate, "theta", estimate))
    if getattr(estimate, "unit", "PWM") != "PWM":
        raise InputError(f"the estimate is in {estimate.unit}: the loop is simulated in PWM counts")
    runs = runs_of(recordings, controller, references, delay=delay, seconds=seconds)
    search = _Search(estimate, theta, l2)
    from scipy.optimize import least_squares as minimise
    from tqdm.auto import tqdm

    measured = [np.hstack([run.q, run.u]) for run in runs]

    def simulated(x):
        return [np.hstack(run.simulate(*search.model(x), step=_PERIOD)) for run in runs]

    first = simulated(search.x0)
    if not all(np.isfinite(model).all() for model in first):
        raise IdentificationError("the loop with the first estimate runs away: fit it with method='bounded' first")
    weights = [_weights(*pair) for pair in zip(measured, first, strict=True)]

    def residuals(x):
        parts = [w * (y - model) for w, y, model in zip(weights, measured, simulated(x), strict=True)]
        return np.nan_to_num(np.concatenate(parts), nan=1e3, posinf=1e3, neginf=-1e3).ravel()

    bar = tqdm(total=iterations, disable=not progress, unit="step", desc="output error")
    with bar, ThreadPoolExecutor(2) as pool:

        def slopes(x):
            moves = np.diag(search.moves(x))
            ahead, behind = np.split(np.array(list(pool.map(residuals, [*(x + moves), *(x - moves)]))), 2)
            bar.update(1)
            return (ahead - behind).T / (2 * moves.diagonal())

        options = {"x_scale": search.scale, "max_nfev": iterations, "ftol": 1e-4}
        found = minimise(residuals, search.x0, slopes, bounds=search.bounds, **options)
    spread = least_squares(found.jac.reshape(-1, 6, len(found.x)), found.fun.reshape(-1, 6), names=search.names)
    notes = list(spread.warnings)
    if found.status == 0:
        notes.append(f"not settled after {iterations} steps: give more, or a better first estimate")
    theta, fs, qs = search.model(found.x)
    return OutputError(
        theta=theta,
        stderr=search.spread_out(np.full((3, 20), np.nan), spread.stderr),
        fs=fs,
        qs=qs,
        fs_stderr=search.breakaway_error(spread),
        qs_stderr=spread.stderr[-3:],
        delay=float(delay),
        warnings=tuple(notes),
    )


class _Search:
    """Where the numbers x of the search stand: entries of theta, then fs - fc and qs of each joint."""

    def __init__(self, estimate, theta, l2):
        columns = getattr(estimate, "columns", [[NAMES[k] for k in rigid] for rigid in RIGID_ON])
        tied = [] if l2 is None else [(1, _THETA6), (2, _THETA6)]  # the waist has no theta4
        entries = [(j, k) for j in range(3) for k in ACTS_ON[j] if NAMES[k] in columns[j] and (j, k) not in tied]
        self.theta, self.places = theta, tuple(np.transpose(entries))
        self.l2 = None if l2 is None else metres("l2", l2)
        self.names = [f"joint {j + 1}: {NAMES[k]}" for j, k in entries]
        self.names += [f"joint {j}: {what}" for what in ("fs - fc", "qs") for j in (1, 2, 3)]
        x0, stderr = theta[self.places], getattr(estimate, "stderr", np.zeros((3, 20)))[self.places]
        known = np.where(np.isfinite(stderr), stderr, 0.0)
        scale = np.maximum.reduce([0.3 * np.abs(x0), 3 * known, 1e-3 * np.abs(theta).max(axis=1)[self.places[0]]])
        free = np.isin(np.array(NAMES)[self.places[1]], FREE_OF_SIGN)
        fc = np.maximum(theta[_COULOMB], 1e-9)
        self.x0 = np.r_[np.where(free, x0, np.maximum(x0, 1e-6 * scale)), 0.3 * fc, np.full(3, 0.05)]
        self.scale = np.r_[scale, 0.3 * fc, np.full(3, 0.02)]
        low = np.r_[np.where(free, -np.inf, 0.0), np.zeros(3), np.full(3, _QS[0])]
        self.bounds = low, np.r_[np.full(len(low) - 3, np.inf), np.full(3, _QS[1])]

    def model(self, x):
        """(theta, fs, qs) of the numbers x."""
        theta = self.spread_out(self.theta, x)
        return theta, theta[_COULOMB] + x[-6:-3], x[-3:]

    def spread_out(self, theta, x):
        """A copy of theta (3, 20) with the entries of x in it."""
        theta = theta.copy()
        theta[self.places] = x[:-6]
        if self.l2 is not None:
            theta[1:, _THETA6] = self.l2 * theta[1:, _THETA4]
        return theta

    def moves(self, x):
        """Steps for differences: small beside the scale, and inside the bounds on both sides."""
        return np.maximum(np.minimum(_STEP * self.scale, 0.5 * (x - self.bounds[0])), 1e-4 * _STEP * self.scale)

    def breakaway_error(self, spread):
        """Standard errors of fs = fc + (fs - fc), (3,), from LeastSquares; inf where the data hold not both."""
        parts = [[name in (f"joint {j}: fc{j}", f"joint {j}: fs - fc") for name in self.names] for j in (1, 2, 3)]
        sums = np.array(parts, dtype=float)
        unknown = sums @ np.isinf(spread.stderr) > 0
        return np.where(unknown, np.inf, np.sqrt(np.diag(sums @ spread.covariance @ sums.T)))


def _weights(measured, model):
    """1/size of the residuals of q and u of each joint, (6,): their noise, and a tenth of what is missed at first.

    Noise from third differences, which slow motion does not reach. measured, model: (m, 6).
    """
    noise = np.sqrt(np.mean(np.diff(measured, 3, axis=0) ** 2, axis=0) / 20)
    missed = np.sqrt(np.mean((measured - model) ** 2, axis=0))
    return 1 / np.maximum(np.hypot(noise, 0.1 * missed), 1e-9 + 1e-6 * measured.std(axis=0))
