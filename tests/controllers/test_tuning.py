"""Tuning rules: numbers worked out by hand, and the margins that each rule is known for."""

import math

import numpy as np
import pytest

from ir50p_lab.controllers.tuning import (
    amigo,
    simc,
    simc_integrating,
    ziegler_nichols,
)
from ir50p_lab.errors import InputError
from ir50p_lab.identification import FOPDT

RATIOS = (0.1, 0.2, 0.5, 1.0, 2.0)  # L/T
# fmt: off
RULES = {
    "ZN PI": lambda m: ziegler_nichols(m, kind="PI"),
    "ZN PID": ziegler_nichols,
    "SIMC PI": simc,
    "SIMC PID": lambda m: simc(m, kind="PID"),
    "AMIGO PI": lambda m: amigo(m, kind="PI"),
    "AMIGO PID": amigo,
}
# least gain margin, least phase margin in degrees, largest sensitivity, for L/T from 0.1 to 2; source: the rules' own
# claims (SIMC 3.14/61.4 deg/1.59 at best, 2.96/46.9 at worst; AMIGO sensitivity 1.4), Ziegler-Nichols measured here
PROMISES = {
    "ZN PI": (1.5, 24, 3.5),
    "ZN PID": (1.4, 36, 3.5),
    "SIMC PI": (2.95, 46, 1.71),
    "SIMC PID": (2.95, 46, 1.71),
    "AMIGO PI": (3.0, 60, 1.45),
    "AMIGO PID": (3.0, 55, 1.45),
}
# fmt: on


def frequency_response(model, gains, integrating=False):
    """w, loop gain C G with the exact dead time."""
    w = np.geomspace(1e-2, 60, 20000) / model.L
    s = 1j * w
    plant = model.K * np.exp(-s * model.L) / (model.T * s + 1) / (s if integrating else 1)
    return w, (gains.kp + gains.ki / s + gains.kd * s) * plant


def margins(model, gains, integrating=False):
    """Gain margin, phase margin in degrees, largest sensitivity."""
    _, loop = frequency_response(model, gains, integrating)
    size, phase = np.abs(loop), np.unwrap(np.angle(loop))
    across_one = np.flatnonzero((size[:-1] - 1) * (size[1:] - 1) < 0)
    turns = np.floor((phase + np.pi) / (2 * np.pi))
    across_180 = np.flatnonzero(np.diff(turns) != 0)
    phase_margin = np.degrees((phase[across_one] + np.pi).min())
    return 1 / size[across_180].max(), phase_margin, (1 / np.abs(1 + loop)).max()


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("name", RULES)
@pytest.mark.parametrize("K, T", [(2.0, 1.0), (-1e-3, 30.0)])
def test_closed_loop_is_stable_with_the_margins_of_the_rule(name, ratio, K, T):
    model = FOPDT(K=K, T=T, L=ratio * T)
    gains = RULES[name](model)
    assert np.sign(gains.kp) == np.sign(K) and all(math.isfinite(g) for g in (gains.kp, gains.ki, gains.kd))
    gain_margin, phase_margin, sensitivity = margins(model, gains)
    least_gain, least_phase, most_sensitive = PROMISES[name]
    assert gain_margin > least_gain and phase_margin > least_phase and sensitivity < most_sensitive


def test_simc_for_an_integrating_plant_has_its_known_margins():
    """Skogestad's values: 2.96 and 46.9 degrees with integral action; without it, those of the ideal loop."""
    for T, L in ((1.0, 0.1), (0.5, 0.5), (0.1, 2.0)):
        model = FOPDT(K=4.0, T=T, L=L)
        assert margins(model, simc_integrating(model), True) == pytest.approx((2.96, 46.9, 1.70), rel=3e-3)
        assert margins(model, simc_integrating(model, kind="PD"), True) == pytest.approx((3.14, 61.4, 1.59), rel=3e-3)
    slow = FOPDT(K=1.0, T=1000.0, L=1.0)  # an ordinary FOPDT so slow that it integrates
    assert margins(slow, simc(slow)) == pytest.approx((2.96, 46.9, 1.70), rel=5e-3)


# Worked out by hand from the printed tables, not by this code.
HAND = [
    # a = K L/T = 2 * 0.5/4 = 0.25
    (ziegler_nichols(FOPDT(K=2, T=4, L=0.5), kind="P"), 4.0, math.inf, 0.0),
    (ziegler_nichols(FOPDT(K=2, T=4, L=0.5), kind="PI"), 3.6, 1.6666667, 0.0),
    (ziegler_nichols(FOPDT(K=2, T=4, L=0.5), kind="PID"), 4.8, 1.0, 0.25),
    # kp = 4/(2 * (0.5 + 0.5)); 4 (0.5 + 0.5) = 4 = T
    (simc(FOPDT(K=2, T=4, L=0.5)), 2.0, 4.0, 0.0),
    (simc(FOPDT(K=2, T=4, L=0.5), tau_c=0.1), 3.3333333, 2.4, 0.0),
    (simc(FOPDT(K=2, T=4, L=0), tau_c=0.8), 2.5, 3.2, 0.0),
    # series 2, 4, 1/6: kp = 2 (1 + 1/24), Ti = 4 + 1/6, Td = 4/25
    (simc(FOPDT(K=2, T=4, L=0.5), kind="PID"), 2.0833333, 4.1666667, 0.16),
    # 1/(0.1 s + 1)/s without dead time, tau_c = 0.25: series 4, 1, 0.1
    (simc_integrating(FOPDT(K=1, T=0.1, L=0), tau_c=0.25), 4.4, 1.1, 0.0909091),
    (simc_integrating(FOPDT(K=1, T=0.1, L=0), tau_c=0.25, kind="PD"), 4.0, math.inf, 0.1),
    # T = 2.9, L = 1.42, the usual approximation of 1/(s + 1)^4
    (amigo(FOPDT(K=1, T=2.9, L=1.42), kind="PI"), 0.414, 2.66, 0.0),
    (amigo(FOPDT(K=1, T=2.9, L=1.42), kind="PID"), 1.12, 2.40, 0.619),
    # T = L = 1: 0.15 + 0.35 - 0.25; 0.35 + 13/20; 0.65; 1.2/1.1; 0.5/1.3
    (amigo(FOPDT(K=1, T=1, L=1), kind="PI"), 0.25, 1.0, 0.0),
    (amigo(FOPDT(K=1, T=1, L=1), kind="PID"), 0.65, 1.0909091, 0.3846154),
]


@pytest.mark.parametrize("gains, kp, Ti, Td", HAND, ids=[f"kp = {kp}" for _, kp, *_ in HAND])
def test_table_values(gains, kp, Ti, Td):
    digits = 3e-3 if kp in (0.414, 1.12) else 1e-6
    assert gains.kp == pytest.approx(kp, rel=digits)
    assert gains.ki == pytest.approx(0 if Ti == math.inf else kp / Ti, rel=2 * digits)
    assert gains.kd == pytest.approx(kp * Td, rel=2 * digits)


@pytest.mark.parametrize("name", RULES)
def test_gains_scale_with_units(name):
    """Output in other units and time in other units: kp by 1/K, ki also by 1/time, kd by time."""
    one, other = RULES[name](FOPDT(K=2, T=1, L=0.3)), RULES[name](FOPDT(K=0.5, T=1000, L=300))
    assert (other.kp, other.ki, other.kd) == pytest.approx((4 * one.kp, 4e-3 * one.ki, 4e3 * one.kd))


@pytest.mark.parametrize("rule", [ziegler_nichols, amigo])
def test_no_dead_time_no_rule(rule):
    with pytest.raises(InputError, match=r"L = .* > 0"):
        rule(FOPDT(K=1, T=1, L=0))


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: simc(FOPDT(K=1, T=1, L=0)), "tau_c = 0"),
        (lambda: simc(FOPDT(K=1, T=1, L=1), tau_c=-1), "finite number > 0"),
        (lambda: simc(FOPDT(K=1, T=1, L=1), tau_c=math.nan), "finite number > 0"),
        (lambda: simc(FOPDT(K=1, T=1, L=1), kind="PD"), "'PI' or 'PID'"),
        (lambda: simc_integrating(FOPDT(K=1, T=1, L=0)), "tau_c = 0"),
        (lambda: simc_integrating(FOPDT(K=1, T=1, L=1), kind="PI"), "'PD' or 'PID'"),
        (lambda: amigo(FOPDT(K=1, T=1, L=1), kind="P"), "'PI' or 'PID'"),
        (lambda: ziegler_nichols(FOPDT(K=1, T=1, L=1), kind="pid"), "'pid'"),
    ],
)
def test_bad_input_gets_a_sentence(make, words):
    with pytest.raises(InputError) as caught:
        make()
    assert words in str(caught.value)
