"""Parameters without the bias that noisy angles bring: instruments from a simulation of the same closed loop.

Noise of the angles is in the regressor, and through the controller in u as well: least squares is then biased, however
long the record is, and no standard error tells so. The loop simulated with a first estimate moves as the arm does, but
without its noise: what goes with its regressor goes with the motion alone (refined instrumental variables, Young 1976).
"""

import numpy as np

from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.closed_loop import runs_of
from ir50p_lab.identification.fitting import fit
from ir50p_lab.identification.processing import central_derivatives, process
from ir50p_lab.inputs import number
from ir50p_lab.modelling.dynamics import as_theta
from ir50p_lab.signals.low_pass import low_pass

_ORDER = 3  # of the filters
_WIDER = 2.0  # cut-off of the differentiation over that of the regression: what lies between is lost in both sides
# Periods of the cut-off, before and after a slow stretch, that are left out too: the arm sticks where the simulated one
# may not, so it reverses later, and filters smear what happens then. Else joint 1's friction is off by 1.5 errors.
_AROUND = 0.3


def fit_with_instruments(
    first, recordings, controller, references=None, *, delay=0.02, cutoff_hz=3.0, slow=0.1, l2=None
):
    """Estimate with standard errors that hold for noisy angles, too: to be believed, where `identify` is to be used.

    Both sides of y = Phi theta pass the same zero-phase low pass, so that the equation stays true; the direction in
    the Coulomb columns and the instruments come from the simulated loop. On 100 simulated recordings of a nominal arm
    (one count of noise, rounding, delay, 110 s) all parameters lay within three standard errors in 98, with breakaway
    friction twice Coulomb's as without; by least squares in none. Backlash, a bent potentiometer and another slope of
    it are not noise: what they do to the parameters no standard error holds.

    Args: first: Estimate or theta (3, 20) with which the loop is simulated, from `identify` or `output_error`;
    recordings, controller, references, delay: as in `output_error`, evenly sampled. cutoff_hz: of both sides, Hz.
    slow: rad/s, simulated speed below which samples of a joint, and those 0.3/cutoff_hz seconds around, are left out.
    l2: as in `fit`.
    Returns: Estimate of method "iv". Raises: InputError, IdentificationError as `fit` does.
    """
    theta, _ = as_theta(getattr(first, "theta", first))
    for name, value in (("cutoff_hz", cutoff_hz), ("slow", slow)):
        number(name, value, "> 0")
    runs = runs_of(recordings, controller, references, delay=delay)
    dry = getattr(first, "fs", None), getattr(first, "qs", None)
    parts = [_filtered(run, (theta, *dry), float(delay), cutoff_hz, slow) for run in runs]
    Phi, Z, u, use = map(np.concatenate, zip(*parts, strict=True))
    return fit(Phi, u, method="iv", instruments=Z, use=use, l2=l2)


def _filtered(run, model, delay, cutoff_hz, slow):
    """Phi, Z (m, 3, 20), u and use (m, 3) of one run."""
    from scipy.ndimage import binary_erosion

    rate = 1 / run.period
    measured = process(run.t, run.q, run.u, cutoff_hz=None, trim=0.0, delay=delay)
    first = round((measured.t[0] - run.t[0]) * rate)
    clean = run.simulate(*model)[0][first : first + len(measured)]
    speed = central_derivatives(clean, rate, cutoff_hz=None)[1]

    def smooth(x):
        return low_pass(x.reshape(len(x), -1), cutoff_hz, rate, order=_ORDER, kind="zero-phase").reshape(x.shape)

    def columns(q):
        motion = central_derivatives(q, rate, cutoff_hz=_WIDER * cutoff_hz, order=_ORDER)
        return smooth(regressor(*motion, sign=np.sign(speed)))

    around = np.ones((2 * round(_AROUND * rate / cutoff_hz) + 1, 1), dtype=bool)
    moving = binary_erosion(smooth((np.abs(speed) > slow).astype(float)) > 0.95, around, border_value=1)
    edge = int(np.ceil(rate / cutoff_hz))
    return [x[edge:-edge] for x in (columns(measured.q), columns(clean), smooth(measured.u), moving)]
