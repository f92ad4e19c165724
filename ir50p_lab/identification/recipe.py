"""The whole way from recordings to a model, in one function: process, fit with physical bounds, say how sure."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.arm_regressor import regressor
from ir50p_lab.identification.estimate import Estimate
from ir50p_lab.identification.fitting import fit
from ir50p_lab.identification.processing import process
from ir50p_lab.identification.validation import validate

# What `identify` and `score` have in common: the cut-off is low because this arm moves below 1 Hz and one count of its
# potentiometers is 5 to 8 mrad; a joint turns over within +-0.05 rad/s, where sgn(qd) would jump at the wrong moment.
STEPS = {"cutoff_hz": 1.2, "order": 4}
TURN = 0.05  # rad/s


@dataclass(frozen=True, kw_only=True, eq=False)
class Identified(Estimate):
    """An Estimate with the steps by which it was found: `score(recording)` judges it on another one in the same way."""

    delay: float = 0.0
    steps: dict = None
    g: float = 9.81

    def score(self, recording, q=None, u=None):
        """Validation of "u" on another recording    (Table 4.4), processed as the training was."""
        return validate(self, recording, q, u, delay=self.delay, sign=TURN, g=self.g, **self.steps)


def identify(recordings, *, l2=None, delay=0.02, slow=0.05, method="bounded", rows="joint", g=9.81, **steps):
    """Identify the arm from one or several recordings: the recipe of the course in one call.

        motion = optimise_excitation(arm, margin=0.2, table=0.1, standing=6).reference     # and drive it for a minute
        model = identify(recording, l2=0.2)
        print(model.score(another_recording))                                              # Table 4.4

    1. `process`: zero-phase low pass at 1.2 Hz and central differences; u taken at the moment it acted;
    2. samples of a joint slower than `slow` are left out: there it may stick, and u may be anything;
    3. `regressor` with tanh(qd/0.05) for sgn(qd);
    4. `fit` joint by joint, inertial and friction terms >= 0, and theta6 = l2 theta4 if l2 is given.

    Args:
        recordings: a Recording (t, q, u), or a list of them: other motions, or another load of work for the same arm.
        l2: upper arm, m, or None. delay: s from a sample to the moment its u acts. slow: rad/s.
        method: "bounded", or another of `fit`; rows, g: as in `fit`, `regressor`; steps: cutoff_hz=, order=, held=,
        trim=, max_gap= of `process`.

    Made for prediction. Noise of the angles, the low cut-off and the soft sign bias single parameters by some per
    cent, at this length of record more than the standard errors, which do not know it: where the parameters themselves
    matter, go on with `fit_with_instruments`; where Stribeck friction does, with `output_error`.

    Returns: Identified, an Estimate that can `score` other recordings.
    Raises: InputError, IdentificationError as `process` and `fit` do.
    """
    for name in ("derivatives", "decimate", "filter_u"):
        if name in steps:
            raise InputError(f"{name} is fixed in this recipe: call process, regressor and fit one by one instead")
    steps = {**STEPS, **steps}
    several = isinstance(recordings, (list, tuple))
    if several and not recordings:
        raise InputError("no recording given: give one, or a list of them")
    Phi, y, use = [], [], []
    for recording in recordings if several else [recordings]:
        motion = process(recording, delay=delay, slow=slow, **steps)
        if motion.q.shape[1] != 3:
            raise InputError(f"q has {motion.q.shape[1]} columns: give all three joints, or take fit_joint for one")
        Phi.append(regressor(motion.q, motion.qd, motion.qdd, g=g, sign=TURN))
        y.append(motion.u)
        use.append(motion.use)
    Phi, y, use = map(np.concatenate, (Phi, y, use))
    found = fit(Phi, y, method=method, rows=rows, l2=l2, use=use)
    values = {name: getattr(found, name) for name in Estimate.__dataclass_fields__}
    return Identified(**values, delay=float(delay), steps=steps, g=float(g))
