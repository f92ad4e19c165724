"""Optimised excitation: limits kept, better than chance, the same every time."""

import dataclasses

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification import load_excitations, optimise_excitation, regressor
from ir50p_lab.identification.excitation import regressor_condition
from ir50p_lab.modelling import IR50P, Arm, forward_kinematics
from ir50p_lab.signals import fourier
from ir50p_lab.signals.fourier import limits_of

OTHER = Arm(name="other", l=(0.5, 0.3, 0.2), m=(1, 1, 1), lc=(0.1, 0.1, 0.1), q_min=(-1, 0, -2), q_max=(2, 1.5, 1))
QUICK = {"harmonics": 3, "tries": 400, "progress": False}
COLUMNS = [0, 1, 4, 5, 10, 11, 16], [1, 2, 3, 4, 5, 8, 9, 12, 13, 17], [3, 4, 5, 9, 14, 15, 18, 19]


@pytest.mark.parametrize("arm", [IR50P, OTHER], ids=["IR50P", "another arm"])
def test_better_than_chance_and_inside_the_limits(arm):
    found = optimise_excitation(arm, seed=3, periods=2, **QUICK)
    assert np.prod(found.condition_before / found.condition_after) > 30
    low, high, speed, _ = limits_of(arm, margin=0.05)
    for target in (found.reference, found.before):
        rows = target.sample(np.linspace(0, target.duration, 20001))
        assert (rows[:, 0] >= low - 1e-9).all() and (rows[:, 0] <= high + 1e-9).all()
        assert (np.abs(rows[:, 1]) <= speed + 1e-9).all()
        assert forward_kinematics(arm, rows[:, 0])[:, 2].min() >= 0
        np.testing.assert_allclose(rows[[0, -1], 1:], 0, atol=1e-9)
    assert found.reference.duration == 20.0


def test_condition_and_spread_of_the_estimates_by_another_route():
    """numpy.linalg.cond of the scaled columns; what it is for: the same noise on u gives a smaller spread of theta."""
    found = optimise_excitation(IR50P, seed=1, **QUICK)
    spread = []
    for motion, condition in ((found.before, found.condition_before), (found.reference, found.condition_after)):
        Phi = regressor(*np.swapaxes(motion.sample(np.arange(1000) * 0.01), 0, 1))
        parts = [Phi[:, joint, columns] for joint, columns in enumerate(COLUMNS)]
        parts = [A / np.linalg.norm(A, axis=0) for A in parts]
        np.testing.assert_allclose([np.linalg.cond(A) for A in parts], condition, rtol=0.02)
        spread.append(np.linalg.norm(np.linalg.pinv(parts[1])))
    assert spread[1] < 0.5 * spread[0]


def test_the_same_seed_gives_the_same_motion():
    first, again, other = (optimise_excitation(IR50P, seed=seed, **{**QUICK, "tries": 40}) for seed in (5, 5, 6))
    assert first.reference == again.reference != other.reference


def standing_share(motion):
    """Share of a period near standstill, of 1/(1 + (qd/0.1 rad/s)^2)."""
    qd = motion.sample(np.linspace(0, motion.period, 500, endpoint=False))[:, 1]
    return (1 / (1 + (qd / 0.1) ** 2)).mean()


def test_a_price_on_standing_buys_motion():
    free, priced = (optimise_excitation(IR50P, standing=price, **QUICK).reference for price in (0.0, 30.0))
    assert standing_share(priced) < 0.8 * standing_share(free)
    motions = load_excitations()
    plain = standing_share(motions.pop("plain"))
    assert max(map(standing_share, motions.values())) < 0.6 * plain


def test_a_bar_is_shown(capsys):
    optimise_excitation(IR50P, tries=5)
    assert "excitation" in capsys.readouterr().err


def test_condition_of_a_motion_that_says_nothing():
    still = fourier(np.zeros((3, 2)), np.zeros((3, 2)), period=5.0, q0=(0, 0.5, -1))
    assert (regressor_condition(still) > 1e15).all()


def test_impossible_limits():
    low = dataclasses.replace(IR50P, q_min=(-1, -1.1, -0.2), q_max=(1, -0.8, 0.2))
    refused("no motion was found inside the limits", optimise_excitation, low, **QUICK, error=IdentificationError)
    refused("lower the table", optimise_excitation, IR50P, table=1.0, **QUICK, error=IdentificationError)


@pytest.mark.parametrize(
    "arm, options, words",
    [
        ("IR50P", {}, "arm = .IR50P.: give an Arm"),
        (Arm(l=(1, 1, 1), m=(1, 1, 1), lc=(0, 0, 0)), {}, "has no joint limits"),
        (IR50P, {"period": 0}, "period = 0"),
        (IR50P, {"harmonics": 1}, "harmonics = 1"),
        (IR50P, {"max_joint_speed": -1}, "max_joint_speed"),
        (IR50P, {"margin": -1}, "margin = -1"),
        (IR50P, {"standing": np.nan}, "standing = nan"),
        (IR50P, {"tries": 0.5}, "tries = 0.5"),
    ],
)
def test_bad_arguments(arm, options, words):
    refused(words, optimise_excitation, arm, **{"progress": False, **options})
