"""Figures of notebook 14 and what 2.1.2 prints: what is drawn is what was computed; the misprints are misprints."""

import numpy as np
import pytest
from printed_law import PrintedLaw

from ir50p_lab.controllers import (
    ComputedTorque,
)
from ir50p_lab.course.printed import control as printed
from ir50p_lab.course.torque import views
from ir50p_lab.modelling import THESIS_C, THESIS_RODS
from ir50p_lab.signals import quintic, sinusoid
from ir50p_lab.simulation import simulate

MOVE = quintic((0, 0, 0), (0.5, 0.4, -0.4), duration=1)


def test_robustness_view():
    def of(scale, speed):
        return simulate(THESIS_RODS, ComputedTorque(scale * THESIS_RODS.theta, speed**2, 2 * speed), MOVE, duration=1)

    robust = views.RobustnessView(np.array([0.8, 1.0]), np.array([5.0, 10.0]), of, duration=1, error_max=50)
    assert robust.rms.shape == (2, 2) and robust.rms[0, 0] > robust.rms[0, 1] > robust.rms[1, 1]
    said = robust.update(0.8, 5.0)
    assert f"{1e3 * of(0.8, 5.0).rms_error[0]:.3g}" in said


def test_lateness():
    swing = sinusoid(0.5, 2.0)
    t = np.arange(0, 10, 0.01)

    class Late:
        pass

    late = Late()
    late.t, late.q = t, swing.sample(t - 0.05)[:, 0]
    assert views.lateness(t, late.q[:, 0], swing, joint=0) == pytest.approx(0.05, abs=2e-3)


def test_printed_parameters_are_model_c():
    m, l, lc, Izz, Iyy, Iyz = (np.array(one) for one in printed.PARAMETERS_2_1_2.values())
    swing = m[2] * lc[2]
    inertial = m[0] * lc[0] ** 2 + sum(Izz), m[1] * lc[1] ** 2 + m[2] * l[1] ** 2, m[1] * lc[1] + m[2] * l[1]
    inertial += swing, swing * lc[2], swing * l[1], *Iyz[1:], *Iyy[1:]
    np.testing.assert_allclose(THESIS_C, np.tile([*inertial, *[0.0] * 10], (3, 1)))


def test_printed_equations_cost_more_than_parameters_20_per_cent_off():
    """Numbers: checked numerically with a second program (RMS in mrad)."""
    gains = (400, 2500, 2500), (40, 100, 100)
    for target, expected in (
        (quintic((0, 0, 0), (np.pi / 2, np.pi / 2, -np.pi / 3), duration=5), (0.304, 1.55, 2.04)),
        (sinusoid((0.8, 0.6, 0.6), (1, 1.5, 2)), (0.734, 3.48, 4.53)),
    ):
        law = PrintedLaw(*gains, period=0.01)
        q, qd, _ = target(0.0)
        found = 1e3 * simulate(THESIS_C, law, target, q0=q, qd0=qd, duration=15).rms_error
        np.testing.assert_allclose(found, expected, rtol=0.02)
