"""Output error: the model whose simulated closed loop is most like the recorded one; it can tell Stribeck friction."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.closed_loop import ClosedLoopRun, runs_of
from ir50p_lab.identification.parameters import ACTS_ON, FREE_OF_SIGN, NAMES, ONLY_THESIS
from ir50p_lab.identification.regression import long_run_sum
from ir50p_lab.identification.validation import compared
from ir50p_lab.inputs import number, whole
from ir50p_lab.modelling.dynamics import as_theta

_STEP = 0.02  # of a parameter's scale, for differences: stiction makes the output jump on smaller ones
_PERIOD = 0.002  # s, of the simulation
_QS = (0.005, 0.5)  # rad/s, bounds of the Stribeck speed
_THETA4, _THETA6 = NAMES.index("theta4"), NAMES.index("theta6")
_COULOMB = [NAMES.index(name) for name in ("fc1", "fc2", "fc3")]


@dataclass(frozen=True, kw_only=True, eq=False)
class OutputError:
    """What `output_error` found; theta may be used wherever an Estimate's may.

    ============ ============================================================================== ===========
    theta        parameters                                                                      (3, 20) unit
    stderr       standard errors; nan: not part of the fit                                       (3, 20) unit
    fs, qs       breakaway friction, Stribeck speed (1.117)                                      (3,) unit, rad/s
    fs_stderr, qs_stderr                                                                         (3,)
    before, after  Validation of "q" and of "u" on the training runs, start and end              (2 each)
    warnings     tuple of str
    ============ ============================================================================== ===========
    """

    theta: np.ndarray
    stderr: np.ndarray
    fs: np.ndarray
    qs: np.ndarray
    fs_stderr: np.ndarray
    qs_stderr: np.ndarray
    before: tuple
    after: tuple
    delay: float
    warnings: tuple
    unit: str = "PWM"

    def score(self, recording, controller, reference=None):
        """Simulate the loop of another recording: (Validation of "q", Validation of "u")."""
        run = ClosedLoopRun.of(recording, controller, reference, delay=self.delay)
        return compare([run], [run.simulate(self.theta, self.fs, self.qs)])

    def __str__(self):
        lines = [f"output error; unit {self.unit}"]
        for joint in range(3):
            for k, name in enumerate(NAMES):
                if np.isfinite(self.stderr[joint, k]):
                    lines.append(f"  {joint + 1}  {name:8}{self.theta[joint, k]:12.4g} +- {self.stderr[joint, k]:.2g}")
            lines.append(f"  {joint + 1}  fs      {self.fs[joint]:12.4g} +- {self.fs_stderr[joint]:.2g}")
            lines.append(f"  {joint + 1}  qs      {self.qs[joint]:12.4g} +- {self.qs_stderr[joint]:.2g}")
        return "\n".join([*lines, *(f"after: {x}" for x in self.after), *self.warnings])


def output_error(
    estimate,
    recordings,
    controller,
    references=None,
    *,
    delay=0.02,
    l2=None,
    seconds=30.0,
    iterations=12,
    progress=True,
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
    if l2 is not None and number("l2", l2, "> 0", unit="m") >= 10:
        raise InputError(f"l2 = {l2} m: give the length of the upper arm in metres")
    whole("iterations", iterations, 1, 10**4)
    runs = runs_of(recordings, controller, references, delay=delay, seconds=seconds)
    shape = _Shape.of(estimate, np.array(theta), l2)
    from scipy.optimize import least_squares
    from tqdm.auto import tqdm

    first = [run.simulate(*shape.model(shape.x0), step=_PERIOD) for run in runs]
    if not all(np.isfinite(q).all() for q, _ in first):
        raise IdentificationError("the loop with the first estimate runs away: fit it with method='bounded' first")
    weights = _weights(runs, first)

    def residuals(x):
        found = [run.simulate(*shape.model(x), step=_PERIOD) for run in runs]
        parts = [w * np.hstack([run.q - q, run.u - u]) for run, w, (q, u) in zip(runs, weights, found, strict=True)]
        return np.nan_to_num(np.concatenate(parts), nan=1e3, posinf=1e3, neginf=-1e3).ravel()

    with (
        tqdm(total=iterations, disable=not progress, unit="step", desc="output error") as bar,
        ThreadPoolExecutor(2) as pool,
    ):

        def slopes(x):
            moves = shape.moves(x)
            ahead = list(pool.map(residuals, x + np.diag(moves)))
            behind = list(pool.map(residuals, x - np.diag(moves)))
            bar.update(1)
            return (np.array(ahead) - np.array(behind)).T / (2 * moves)

        found = least_squares(
            residuals, shape.x0, slopes, bounds=shape.bounds, x_scale=shape.scale, max_nfev=iterations, ftol=1e-4
        )
    last = [run.simulate(*shape.model(found.x), step=_PERIOD) for run in runs]
    covariance, notes = _covariance(found.jac, found.fun.reshape(-1, 6))
    values, errors = shape.model(found.x), shape.errors(covariance)
    if found.status == 0:
        notes.append(f"not settled after {iterations} steps: give more, or a better first estimate")
    return OutputError(
        theta=values[0],
        stderr=errors[0],
        fs=values[1],
        qs=values[2],
        fs_stderr=errors[1],
        qs_stderr=errors[2],
        before=compare(runs, first),
        after=compare(runs, last),
        delay=float(delay),
        warnings=tuple(notes),
    )


def compare(runs, simulated):
    """(Validation of "q", Validation of "u") of runs and their simulation."""
    t = np.concatenate([run.t for run in runs])
    out = []
    for of, index in (("q", 0), ("u", 1)):
        measured = np.concatenate([getattr(run, of) for run in runs])
        predicted = np.concatenate([pair[index] for pair in simulated])
        out.append(compared(t, measured, predicted, of))
    return tuple(out)


@dataclass(frozen=True, eq=False)
class _Shape:
    """Where the numbers x of the search stand: entries of theta, then fs - fc and qs of each joint."""

    theta: np.ndarray
    places: list  # (joint, column) of each x
    l2: float | None
    x0: np.ndarray
    scale: np.ndarray
    bounds: tuple

    @classmethod
    def of(cls, estimate, theta, l2):
        columns = getattr(estimate, "columns", None)
        places = [
            (j, k)
            for j in range(3)
            for k in ACTS_ON[j]
            if (NAMES[k] in columns[j] if columns else NAMES[k] not in ONLY_THESIS)
            and not (l2 is not None and k == _THETA6 and _THETA4 in ACTS_ON[j])
        ]
        x0 = np.array([theta[j, k] for j, k in places])
        stderr = getattr(estimate, "stderr", np.zeros((3, 20)))
        known = np.array([stderr[j, k] if np.isfinite(stderr[j, k]) else 0.0 for j, k in places])
        joint = np.array([np.abs(theta[j]).max() for j, _ in places])
        scale = np.maximum.reduce([0.3 * np.abs(x0), 3 * known, 1e-3 * joint])
        low = np.array([-np.inf if NAMES[k] in FREE_OF_SIGN else 0.0 for _, k in places])
        x0 = np.maximum(x0, np.where(np.isfinite(low), low + 1e-6 * scale, -np.inf))
        fc = np.maximum(theta[range(3), _COULOMB], 1e-9)
        x0 = np.r_[x0, 0.3 * fc, np.full(3, 0.05)]
        scale = np.r_[scale, 0.3 * fc, np.full(3, 0.02)]
        low, high = np.r_[low, np.zeros(3), np.full(3, _QS[0])], np.full(len(x0), np.inf)
        high[-3:] = _QS[1]
        return cls(theta, places, l2, x0, scale, (low, high))

    def model(self, x):
        """(theta, fs, qs) of the numbers x."""
        theta = self.theta.copy()
        for (j, k), value in zip(self.places, x, strict=False):
            theta[j, k] = value
        if self.l2 is not None:
            theta[1:, _THETA6] = self.l2 * theta[1:, _THETA4]  # the waist has no theta4
        fc = np.maximum(theta[range(3), _COULOMB], 0.0)
        theta[range(3), _COULOMB] = fc
        n = len(self.places)
        return theta, fc + x[n : n + 3], x[n + 3 :]

    def moves(self, x):
        """Steps for differences: small beside the scale, and inside the bounds on both sides."""
        return np.maximum(np.minimum(_STEP * self.scale, 0.5 * (x - self.bounds[0])), 1e-4 * _STEP * self.scale)

    def errors(self, covariance):
        """Standard errors in the shape of (theta, fs, qs)."""
        s = np.sqrt(np.maximum(np.diag(covariance), 0.0))
        theta = np.full((3, 20), np.nan)
        for (j, k), value in zip(self.places, s, strict=False):
            theta[j, k] = value
        if self.l2 is not None:
            theta[1:, _THETA6] = self.l2 * theta[1:, _THETA4]
        n = len(self.places)
        fs = np.empty(3)
        for j in range(3):  # fs = fc + x
            at = [k for k, place in enumerate(self.places) if place == (j, _COULOMB[j])] + [n + j]
            fs[j] = np.sqrt(max(covariance[np.ix_(at, at)].sum(), 0.0))
        return theta, fs, s[n + 3 :]


def _weights(runs, first):
    """1/size of the residuals of q and u of each joint, (6,) per run: their noise, and half of what is missed at first.

    Noise from third differences, which slow motion does not reach.
    """
    found = []
    for run, (q, u) in zip(runs, first, strict=True):
        signals, model = np.hstack([run.q, run.u]), np.hstack([q, u])
        noise = np.sqrt(np.mean(np.diff(signals, 3, axis=0) ** 2, axis=0) / 20)
        missed = np.sqrt(np.mean((signals - model) ** 2, axis=0))
        found.append(1 / np.maximum(np.hypot(noise, 0.1 * missed), 1e-9 + 1e-6 * signals.std(axis=0)))
    return found


def _covariance(J, residuals):
    """Sandwich covariance of the parameters, for residuals (m, 6) that are alike over time; and sentences."""
    p = J.shape[1]
    size = np.linalg.norm(J, axis=0)
    if not size.all():
        return np.full((p, p), np.inf), ["a parameter has no effect on the simulated run: its error is not known"]
    Q, R = np.linalg.qr(J / size)
    scores = (Q * residuals.ravel()[:, None]).reshape(len(residuals), 6, p).sum(axis=1)
    S = long_run_sum(scores, residuals)
    back = np.linalg.solve(R, np.eye(p))
    covariance = back @ S @ back.T / np.outer(size, size)
    condition = np.linalg.cond(R)
    notes = [f"condition {condition:.3g}: some parameters are hardly told apart"] if condition > 100 else []
    return covariance, notes
