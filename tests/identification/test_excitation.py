"""Optimised excitation: the kernel against the plain regressor, limits kept, better than chance, the same every time."""

import dataclasses

import numpy as np
import pytest

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import excitation as module
from ir50p_lab.identification import load_excitations, optimise_excitation, regressor
from ir50p_lab.modelling import IR50P, Arm, forward_kinematics
from ir50p_lab.signals import fourier
from ir50p_lab.signals.fourier import limits_of

pytestmark = pytest.mark.numeric
OTHER = Arm(name="other", l=(0.5, 0.3, 0.2), m=(1, 1, 1), lc=(0.1, 0.1, 0.1), q_min=(-1, 0, -2), q_max=(2, 1.5, 1))
QUICK = {"harmonics": 3, "starts": 1, "iterations": 25, "progress": False}  # from every start to a good optimum


def problem(arm=IR50P, table=0.0, standing=0.0):
    return module._Problem(arm, 10.0, 4, limits_of(arm, table=table), standing)


@pytest.mark.parametrize("seed", range(4))
def test_value_and_room_by_another_route(seed):
    """Second route: Fourier motion sampled, regressor called, columns scaled, numpy.linalg.cond."""
    p = problem()
    x = p.start(np.random.default_rng(seed))
    a, b, q0 = p.split(x)
    n = module._PER_HARMONIC * 4
    q, qd, qdd = np.swapaxes(
        fourier(a, b, period=10.0, q0=q0, ends="adjust").sample((np.arange(n) + 0.5) * 10 / n), 0, 1
    )
    Phi = regressor(q, qd, qdd, sign=module._TURN)
    sets = [[0, 1, 4, 5, 10, 11, 16], [1, 2, 3, 4, 5, 8, 9, 12, 13, 17], [3, 4, 5, 9, 14, 15, 18, 19]]
    parts = [Phi[:, i, s] for i, s in enumerate(sets)]
    logs = [np.log(np.linalg.cond(A / np.linalg.norm(A, axis=0))) for A in parts]
    found = p.evaluate(x)
    assert found[0] == pytest.approx(np.mean(logs), abs=1e-6)
    low, high, speed, _ = limits_of(IR50P)
    assert (found[1:10:3] <= high - q.max(axis=0)).all() and (found[1:10:3] > high - q.max(axis=0) - 0.02).all()
    assert (found[2:10:3] <= q.min(axis=0) - low).all()
    assert found[3:10:3] == pytest.approx(speed - np.abs(qd).max(axis=0), abs=0.01)
    heights = forward_kinematics(IR50P, q)[:, 2]
    assert heights.min() - 0.01 < found[11] <= heights.min()


@pytest.mark.parametrize("arm", [IR50P, OTHER], ids=["IR50P", "another arm"])
def test_better_than_chance_and_inside_the_limits(arm):
    found = optimise_excitation(arm, seed=3, periods=2, **{**QUICK, "iterations": 40})
    assert np.prod(found.condition_before / found.condition_after) > 30
    low, high, speed, _ = limits_of(arm, margin=0.05)
    for target in (found.reference, found.before):
        rows = target.sample(np.linspace(0, target.duration, 20001))
        assert (rows[:, 0] >= low - 1e-9).all() and (rows[:, 0] <= high + 1e-9).all()
        assert (np.abs(rows[:, 1]) <= speed + 1e-9).all()
        assert forward_kinematics(arm, rows[:, 0])[:, 2].min() >= 0
        np.testing.assert_allclose(rows[[0, -1], 1:], 0, atol=1e-9)
    assert found.reference.duration == 20.0
    again = module.regressor_condition(found.reference)
    np.testing.assert_allclose(again, found.condition_after, rtol=0.02)


def test_the_same_seed_gives_the_same_motion():
    first, second = (optimise_excitation(IR50P, seed=5, **{**QUICK, "iterations": 6}) for _ in range(2))
    assert first.reference == second.reference
    assert optimise_excitation(IR50P, seed=6, **{**QUICK, "iterations": 6}).reference != first.reference


def test_estimates_are_surer_with_the_better_motion():
    """What it is for: the same noise on u, a smaller spread of theta relative to each column's part in u."""
    found = optimise_excitation(IR50P, seed=1, **{**QUICK, "iterations": 40})
    spread = []
    for target in (found.before, found.reference):
        rows = target.sample(np.arange(1000) * 0.01)
        Phi = regressor(*np.swapaxes(rows, 0, 1))[:, 1][:, [1, 2, 3, 4, 5, 8, 9, 12, 13, 17]]
        A = Phi / np.sqrt((Phi**2).mean(axis=0))
        spread.append(np.sqrt(np.trace(np.linalg.inv(A.T @ A))))
    assert spread[1] < 0.5 * spread[0]


def standing_share(motion):
    """Share of a period near standstill, of 1/(1 + (qd/0.1 rad/s)^2), from the sampled motion."""
    n = module._PER_HARMONIC * len(motion.a[0])
    qd = motion.sample(motion.start + (np.arange(n) + 0.5) * motion.period / n)[:, 1]
    return (1 / (1 + (qd / 0.1) ** 2)).mean()


@pytest.mark.parametrize("seed", range(4))
def test_standing_has_the_price_that_was_asked(seed):
    """Second route: the same motion by `fourier`."""
    free, priced = problem(), problem(standing=8.0)
    x = free.start(np.random.default_rng(seed))
    a, b, q0 = free.split(x)
    share = standing_share(fourier(a, b, period=10.0, q0=q0, ends="adjust"))
    assert priced.evaluate(x)[0] - free.evaluate(x)[0] == pytest.approx(8.0 * share, abs=1e-9)


def test_a_price_on_standing_buys_motion():
    """The kept motions were optimised with a price of 8, whatever way the optimiser went."""
    motions = load_excitations()
    plain = standing_share(motions.pop("plain"))
    assert max(map(standing_share, motions.values())) < 0.6 * plain


def test_a_bar_is_shown(capsys):
    optimise_excitation(IR50P, starts=1, iterations=5)
    assert "excitation" in capsys.readouterr().err


def test_condition_of_a_motion_that_says_nothing():
    still = fourier(np.zeros((3, 2)), np.zeros((3, 2)), period=5.0, q0=(0, 0.5, -1))
    assert np.isinf(module.regressor_condition(still)).all()


def test_impossible_limits():
    low = dataclasses.replace(IR50P, q_min=(-1, -1.1, -0.2), q_max=(1, -0.8, 0.2))
    with pytest.raises(IdentificationError, match="no motion was found inside the limits in 1 starts"):
        optimise_excitation(low, **QUICK)
    for table in (0.7, 1.0, 10.0):
        with pytest.raises(IdentificationError, match="lower the table"):
            optimise_excitation(IR50P, table=table, **QUICK)


@pytest.mark.parametrize(
    "arm, options, words",
    [
        ("IR50P", {}, "arm = .IR50P.: give an Arm"),
        (Arm(l=(1, 1, 1), m=(1, 1, 1), lc=(0, 0, 0)), {}, "has no joint limits"),
        (IR50P, {"period": 0}, "period = 0"),
        (IR50P, {"harmonics": 1}, "harmonics = 1"),
        (IR50P, {"harmonics": 2.0}, "harmonics"),
        (IR50P, {"max_joint_speed": -1}, "max_joint_speed"),
        (IR50P, {"margin": -1}, "margin = -1"),
        (IR50P, {"standing": -1}, "standing = -1"),
        (IR50P, {"standing": np.nan}, "standing = nan"),
    ],
)
def test_bad_arguments(arm, options, words):
    with pytest.raises(InputError, match=words):
        optimise_excitation(arm, **{"progress": False, **options})
