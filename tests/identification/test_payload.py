"""Kilograms from a known payload, and why a theta in counts cannot say them by itself."""

import dataclasses

import numpy as np
import pytest

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import fit, payload_change, regressor, scale_from_payload
from ir50p_lab.modelling import IR50P

K = np.array(IR50P.actuators.gain)
L2, L3 = IR50P.l[1], IR50P.l[2]


def estimate(arm, seed, noise=5.0, n=4000, **options):
    rng = np.random.default_rng(seed)
    q, qd, qdd = (rng.uniform(-1, 1, (n, 3)) * scale for scale in (1.5, 1.0, 3.0))
    Phi = regressor(q, qd, qdd)
    y = np.einsum("nij,ij->ni", Phi, arm.theta_pwm) + rng.normal(0, noise, (n, 3))
    return fit(Phi, y, **options)


def test_the_change_is_that_of_the_arm():
    for mass in (0.1, 0.5, 2.0):
        change = np.array(IR50P.with_payload(mass).theta[0]) - IR50P.theta[0]
        np.testing.assert_allclose(payload_change(mass, l2=L2, at=L3), change, atol=1e-12)


def test_two_arms_of_other_mass_and_gain_have_the_same_counts():
    """Half of everything, with motors of half the gain: no recording in PWM counts can tell."""
    f = IR50P.friction
    halved = {name: tuple(0.5 * np.array(getattr(f, name))) for name in ("fv", "fc", "fs", "Tf")}
    a = IR50P.actuators
    light = dataclasses.replace(
        IR50P,
        m=tuple(0.5 * np.array(IR50P.m)),
        **{name: tuple(0.5 * np.array(getattr(IR50P, name))) for name in ("Ixx", "Iyy", "Izz")},
        friction=dataclasses.replace(f, **halved),
        actuators=dataclasses.replace(a, Jm=tuple(0.5 * np.array(a.Jm)), Ra=tuple(2 * np.array(a.Ra))),
    )
    np.testing.assert_allclose(light.theta_pwm, IR50P.theta_pwm, rtol=1e-12)


@pytest.mark.parametrize("options", [{}, {"l2": L2}, {"method": "bounded", "l2": L2}])
def test_gains_and_masses_are_found(options):
    z = []
    for seed in range(25):
        found = scale_from_payload(
            estimate(IR50P, seed, **options),
            estimate(IR50P.with_payload(0.5), 100 + seed, **options),
            mass=0.5,
            l2=L2,
            at=L3,
        )
        z.append((found.K - K)[1:] / found.stderr[1:])
        assert abs(found.theta[1, 3] - 0.8 * 0.17) < 5 * found.theta_stderr[1, 3]  # m3 lc3 in kg m
        assert not any("proportions" in text for text in found.warnings)
    assert np.mean(np.abs(z) < 3) > 0.97 and 0.6 < np.std(z) < 1.3
    assert (found.stderr[1:] < 0.1 * K[1:]).all()


def test_a_wrong_mass_scales_and_a_wrong_place_is_noticed():
    bare, loaded = estimate(IR50P, 1, noise=0.5), estimate(IR50P.with_payload(0.5), 2, noise=0.5)
    right = scale_from_payload(bare, loaded, mass=0.5, l2=L2, at=L3)
    twice = scale_from_payload(bare, loaded, mass=1.0, l2=L2, at=L3)
    np.testing.assert_allclose(twice.K, 2 * right.K)
    place = scale_from_payload(bare, loaded, mass=0.5, l2=L2, at=0.5 * L3)
    assert any("proportions" in text for text in place.warnings)


@pytest.mark.parametrize("mass", [1e-6, 1e-5, 1e-4])
def test_a_payload_too_light_is_refused(mass):
    with pytest.raises(IdentificationError, match="does not show"):
        scale_from_payload(estimate(IR50P, 1), estimate(IR50P.with_payload(mass), 2), mass=mass, l2=L2, at=L3)


@pytest.mark.parametrize("name, value", [("mass", 0), ("mass", -1), ("mass", np.nan), ("l2", 200), ("at", "far")])
def test_bad_numbers(name, value):
    with pytest.raises(InputError, match=name):
        payload_change(**{"mass": 0.5, "l2": L2, "at": L3, name: value})


def test_bad_estimates():
    good = estimate(IR50P, 1)
    with pytest.raises(InputError, match="loaded is a ndarray"):
        scale_from_payload(good, good.theta, mass=1, l2=L2, at=L3)
    with pytest.raises(InputError, match="of fit with rows"):
        scale_from_payload(good, estimate(IR50P, 2, rows="shared"), mass=1, l2=L2, at=L3)
