"""Every public function refuses bad input with a typed error that says what was wrong; none lets NaN pass."""

import inspect

import numpy as np
import pytest

import ir50p_lab.identification as package
from ir50p_lab.controllers import PID
from ir50p_lab.errors import LabError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import fourier

T = np.arange(600) * 0.01
Q = np.column_stack([np.sin((k + 1) * T) for k in range(3)])
U = 30 * np.cos(Q + T[:, None])
PHI = np.random.default_rng(0).normal(size=(100, 3, 20))
Y = np.random.default_rng(1).normal(size=(100, 3))
MOTION = fourier(np.zeros((3, 2)), [[0.4, -0.1]] * 3, period=5.0, q0=(0, 0.8, -1))
PD = PID(kp=(200,) * 3, kd=(20,) * 3, limit_pwm=255)
NAN_Q = np.where(np.arange(600)[:, None] == 77, np.nan, Q)
NAN_PHI = np.where(np.arange(100)[:, None, None] == 7, np.nan, PHI)
TH = IR50P.theta_pwm


class Run:
    def __init__(self, t=T, q=Q, u=U):
        self.t, self.q, self.u = t, q, u


# name: calls that must be refused
BAD = {
    "regressor": [(NAN_Q, Q, Q), (Q, Q[:5], Q), ("a", Q, Q), (Q[:, :2], Q[:, :2], Q[:, :2])],
    "optimise_excitation": [(TH,), (None,), ("arm",)],
    "load_excitations": [("no_such_file.json",), ("/",)],
    "fit": [(NAN_PHI, Y), (PHI, Y[:5]), (PHI[:3], Y[:3]), (0 * PHI, Y), ("x", Y)],
    "least_squares": [(NAN_PHI, Y), (PHI, Y[:5]), (0 * PHI, Y), (PHI[0, :, :2], "x")],
    "output_error": [(TH, Run(q=NAN_Q), PD, MOTION), (TH, Run(), None, MOTION), (TH[:1], Run(), PD, MOTION)],
    "fit_fopdt": [(T, NAN_Q[:, 0], Q[:, 0]), (T[::-1], U[:, 0], Q[:, 0]), (T[:2], U[:2, 0], Q[:2, 0])],
    "causal_derivatives": [(NAN_Q, 100.0), (Q, -1.0), (Q, 2.0), ("x", 100.0)],
    "central_derivatives": [(NAN_Q, 100.0), (Q, -1.0), (Q, 2.0), (Q[:2], 100.0)],
    "process": [(Run(q=NAN_Q),), (Run(t=T[::-1]),), (T,), (Run(q=Q[:5]),), (Run(T[:5], Q[:5], U[:5]),)],
    "identify": [(Run(q=NAN_Q),), (Run(t=T[::-1]),), (Run(T[:5], Q[:5], U[:5]),), (Run(q=0 * Q),), ([],)],
    "fit_joint": [(T, NAN_Q[:, 0], U[:, 0]), (T[::-1], Q[:, 0], U[:, 0]), (T[:5], Q[:5, 0], U[:5, 0]), (T, Q, U)],
    "nrmse_fit": [(NAN_Q, Q), (Q, Q[:5]), (0 * Q, Q)],
    "validate": [(TH, Run(q=NAN_Q)), (TH[:1], Run()), (TH, Run(t=T[::-1]))],
}
KEYWORDS = {
    "output_error": {"progress": False},
    "optimise_excitation": {"progress": False},
}


def test_every_public_function_is_here():
    functions = {name for name in package.__all__ if inspect.isfunction(getattr(package, name))}
    assert functions <= set(BAD), functions - set(BAD)


@pytest.mark.parametrize("name, number", [(name, k) for name, calls in BAD.items() for k in range(len(calls))])
def test_bad_input_is_refused_in_words(name, number):
    with pytest.raises(LabError) as refusal:
        getattr(package, name)(*BAD[name][number], **KEYWORDS.get(name, {}))
    assert len(str(refusal.value)) > 20
