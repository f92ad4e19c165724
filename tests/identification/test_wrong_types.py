"""Any argument of any public function, and of the controllers, may be nonsense: it is taken or refused, never a crash."""

import inspect

import numpy as np
import pytest
from test_refusals import ESTIMATE, MOTION, PD, PHI, TH, Q, Run, T, U, Y

import ir50p_lab.controllers as controllers
import ir50p_lab.identification as identification
from ir50p_lab.errors import LabError
from ir50p_lab.modelling import IR50P

NONSENSE = [
    None, np.nan, np.inf, -1, True, "x", b"x", 1j, 10**400, [], {}, object(), [np.nan] * 3, [[1, 2], [3]],
    np.empty((0, 3)), np.zeros((2, 2, 2)), np.array(["a", "b"]), lambda: 0,
]  # fmt: skip
LOOP = {"controller": PD, "references": MOTION}
STEP = {"t": T, "u": (T > 1) * 1.0, "y": np.where(T > 1, 1 - np.exp(-(T - 1) / 0.5), 0)}
MODEL = {"model": IR50P, "kp": 25, "kd": 10}
GOOD = {
    "regressor": {"q": Q, "qd": Q, "qdd": Q},
    "base_parameters": {"Phi": PHI},
    "estimate_delay": {"recording": Run()},
    "regressor_condition": {"reference": MOTION},
    "load_excitations": {},
    "fit": {"Phi": PHI, "y": Y},
    "fit_fopdt": STEP,
    "fit_joint": {"t": T, "q": Q[:, 0], "u": U[:, 0]},
    "fit_with_instruments": {"first": TH, "recordings": Run(), **LOOP},
    "general_parameters": {},
    "general_regressor": {"q": Q, "qd": Q, "qdd": Q, "l2": 0.2},
    "payload_change": {"mass": 0.5, "l2": 0.2, "at": 0.3},
    "scale_from_payload": {"without": ESTIMATE, "loaded": ESTIMATE, "mass": 0.5, "l2": 0.2, "at": 0.3},
    "causal_derivatives": {"q": Q, "rate_hz": 100.0},
    "central_derivatives": {"q": Q, "rate_hz": 100.0},
    "process": {"recording": Run()},
    "identify": {"recordings": Run()},
    "read_columns": {},
    "rehearse": {"reference": MOTION, "arm": IR50P, "controller": PD},
    "nrmse_fit": {"measured": Q, "predicted": Q},
    "validate": {"estimate": TH, "recording": Run()},
    "validate_ahead": {"estimate": TH, "recording": Run()},
    "validate_closed_loop": {"estimate": TH, "recording": Run(), "controller": PD, "reference": MOTION},
    "whiteness": {"residuals": Q},
    "RLS": {},
    "PID": {"kp": (1, 1, 1)},
    "ComputedTorque": MODEL,
    "FeedForward": MODEL,
    "GravityPD": MODEL,
    "AdaptiveControl": {"model": IR50P, "Lambda": 5, "K": 10, "Gamma": 1.0},
    "hurwitz": {"gains": (1, 1)},
    "routh_table": {"gains": (1, 1)},
    "gains_for_poles": {"poles": (-1, -2)},
    "saturation_forecast": {"model": TH, "reference": MOTION},
}


def public(name):
    return getattr(identification if name in identification.__all__ else controllers, name)


CASES = [(name, option) for name in GOOD for option in inspect.signature(public(name)).parameters if option != "steps"]


@pytest.mark.compiled
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name, option", CASES, ids=["-".join(case) for case in CASES])
def test_nonsense_is_taken_or_refused_but_never_crashes(name, option):
    refused = 0
    for value in NONSENSE:
        if option in ("reference", "references") and callable(value):
            continue  # a motion that cannot be called with a time: Python says so itself
        try:
            public(name)(**GOOD[name] | {option: value})
        except LabError as error:
            assert len(str(error)) > 15
            refused += 1
        except TypeError as error:
            assert "required" in str(error)  # other arguments are missing; then this one is not looked at
            return
    unused = {"weights", "bounds", "instruments", "qs", "threshold", "strength"}  # of other methods
    assert refused > 5 or option in unused
