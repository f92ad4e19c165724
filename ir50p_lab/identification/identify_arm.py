"""From recordings to a model in one function: process, fit within physical bounds, give the errors."""

from dataclasses import replace

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.fitting import fit
from ir50p_lab.identification.processing import process
from ir50p_lab.identification.recording_checks import Warnings, check_signals
from ir50p_lab.identification.time_series import columns_of

_CONTRADICT = 1.3  # residual of a recording with the common model over that with its own: if more, it contradicts
_ALIKE = 0.02  # share of the spread of u: a difference between models that does not matter
TURN = 0.05  # rad/s: tanh(qd/TURN) stands for sgn(qd), which noise would let jump too early or late at a reversal


def identify(
    recordings, *, l2=None, delay=0.02, slow=0.05, method="bounded", cutoff_hz=1.2, held=True, unit="PWM", anyway=False
):
    """Identify the arm from one or several recordings: the recipe of the course in one call.

        motion = optimise_excitation(arm, margin=0.2, table=0.15, standing=30).reference   # and drive it for a minute
        model = identify(recording, l2=0.2)
        print(model.score(another_recording))                                              # Table 4.4

    1. `process`: zero-phase low pass at 1.2 Hz and central differences; u taken at the moment when it acted;
    2. samples of a joint slower than `slow` are left out: there it may stick, and u may be anything;
    3. `regressor` with tanh(qd/0.05) for sgn(qd);
    4. `fit` joint by joint, inertial and friction terms >= 0, and theta6 = l2 theta4 if l2 is given.

    Args:
        recordings: a Recording (t, q, u), or a list of them: other motions of the same arm under the same load. One
            that contradicts the others is named, and the errors are widened to cover what each says.
        l2: length of the upper arm, m, or None. delay: s from a sample to the moment when its u acts. slow: rad/s.
        method: as in `fit`.
        cutoff_hz: Hz, above the frequencies of the motion; held: as in `process`; unit: of u.
        anyway: go on where the data are refused.

    The model is made for prediction. Noise of the angles, the low cut-off and the soft sign bias single parameters by
    some per cent. In a record of this length that is more than the standard errors, which do not include it. If the
    parameters themselves or Stribeck friction matter, go on with `output_error`.

    Returns: Estimate, whose `score` processes other recordings in the same way.
    Raises: InputError, IdentificationError as `process` and `fit` do, and if a joint is constant, its angle clipped,
    or its angle or u wrapped. Angles that look like degrees, and a u that is often at its limit, are in `warnings`.
    """
    recordings = list(recordings) if isinstance(recordings, (list, tuple)) else [recordings]
    if not recordings:
        raise InputError("no recording given: give one, or a list of them")
    processing = {"cutoff_hz": cutoff_hz, "delay": delay, "held": held}
    notes, parts = [], []
    for recording in recordings:
        t, q, u = columns_of(recording)
        for joint in range(q.shape[1]):
            warned = Warnings(anyway, f"joint {joint + 1}: ")
            check_signals(warned, t, q[:, joint], u[:, joint])
            share = np.isin(u[:, joint], (u[:, joint].min(), u[:, joint].max())).mean()
            if share > 0.05:
                warned.add(f"u is at its largest or smallest value in {share:.0%}: if clipped, record a wider range")
            notes += warned
        motion = process(recording, slow=slow, **processing)
        parts.append((regressor(motion.q, motion.qd, motion.qdd, sign=TURN), motion.u, motion.use))
    Phi, y, use = map(np.concatenate, zip(*parts, strict=True))
    options = {"method": method, "l2": l2, "unit": unit}
    found = fit(Phi, y, use=use, **options)
    said, stderr = _contradiction(found, parts, options) if len(parts) > 1 else ([], found.stderr)
    warnings = (*notes, *said, *found.warnings)
    return replace(found, stderr=stderr, warnings=warnings, processing=processing | {"sign": TURN})


def _contradiction(found, parts, options):
    """A sentence about the recording that contradicts the others, if one does, and errors that reach to each, (3, 20).

    It is the one whose residual with the common model exceeds that with its own model most.
    """
    ratios, stderr = np.zeros((len(parts), 3)), found.stderr
    for k, (Phi, u, use) in enumerate(parts):
        try:
            own = fit(Phi, u, use=use, **options)
        except IdentificationError:  # too short to be fitted alone
            continue
        together, alone = (np.sqrt(np.mean(e**2, axis=0, where=use)) for e in (u - found.predict(Phi), own.residuals))
        ratios[k] = together / np.hypot(alone, _ALIKE * u.std(axis=0))
        apart = np.where(np.isfinite(own.stderr), (own.theta - found.theta) ** 2 - own.stderr**2, 0.0)
        stderr = np.sqrt(np.maximum(stderr**2, apart))
    k, joint = np.unravel_index(ratios.argmax(), ratios.shape)
    if ratios[k, joint] < _CONTRADICT:
        return [], found.stderr
    said = f"the common model leaves {ratios[k, joint]:.2g} times as much of u of joint {joint + 1} as its own model"
    return [f"recording {k + 1} contradicts the others: {said} (another load, a fresher battery?)"], stderr
