"""Six broken loops: each shows what its name says, in numbers, and the cure takes it away; names get sentences."""

import numpy as np
import pytest

from ir50p_lab.course.loops import breaking
from ir50p_lab.course.loops.breaking import CASES, NAMES, broken, name_it
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P, load_arm

pytestmark = pytest.mark.filterwarnings("ignore::ir50p_lab.errors.UnstableLoopWarning")  # of loops broken on purpose
ARMS = (IR50P, load_arm("data/arm_example.toml"))


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name[:7])
def test_windup_goes_farther_and_stays_at_the_limit_longer(arm):
    wound, rested = breaking.windup(arm), breaking.windup(arm, cured=True)
    target = breaking.far_target(arm)[0]
    assert wound.q[:, 0].max() - rested.q[:, 0].max() > 0.1 and wound.q[:, 0].max() > target
    assert (wound.u[:, 0] == 255).sum() > 1.2 * (rested.u[:, 0] == 255).sum()
    passes = np.argmax(wound.q[:, 0] > target)
    assert 0 < wound.u[passes, 0] < 255 and (wound.u[passes : passes + 50, 0] > 0).all()  # pushes on for half a second


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name[:7])
def test_a_kick_is_one_push_before_anything_moved(arm):
    kicked, calm = breaking.kick(arm), breaking.kick(arm, cured=True)
    assert kicked.q[100, 0] == pytest.approx(0, abs=1e-6) and kicked.u[100, 0] == 255
    assert calm.u[100, 0] == pytest.approx(20, abs=0.1)


def test_sampling_explodes_at_10_ms_only():
    sides = [np.sign(breaking.sampling(IR50P, period=period).u[:, 2]) for period in (0.01, 0.001)]
    turns = [np.sum(np.abs(np.diff(one[len(one) // 2 :])) > 1) for one in sides]
    assert turns[0] > 40 and turns[1] < 4


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name[:7])
def test_a_late_loop_swings_and_the_same_in_time_does_not(arm):
    late, prompt = breaking.delay(arm), breaking.delay(arm, samples=3)
    assert np.ptp(late.q[-200:, 0]) > 0.3 and np.ptp(prompt.q[-100:, 0]) < 0.02


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name[:7])
def test_nothing_is_wrong_with_the_healthy_one(arm):
    run = breaking.healthy(arm)
    target = breaking.far_target(arm)[0]
    assert (np.abs(run.u[:, 0]) == 255).sum() > 30  # at its limit, like A
    assert run.q[:, 0].max() < 1.03 * target
    assert np.abs(run.error[-300:, 0]).max() < 0.005 * target


def test_friction_waits_and_noise_chatters():
    waits = breaking.friction(IR50P)
    assert 0.01 * np.sum((np.abs(waits.qd[:, 0]) < 1e-4) & (np.abs(waits.error[:, 0]) > 0.005)) > 2
    loud, quiet = (
        np.abs(np.diff(breaking.noise(IR50P, filter_hz=hz).u[200:300], axis=0)).mean() for hz in (np.inf, 10)
    )
    assert quiet < 0.6 * loud


def test_names(capsys):
    names = [case["name"] for case in CASES.values()]
    assert len(set(names)) == len(names) == len(NAMES) - 1 and set(names) < set(NAMES)  # one name is of no case
    for letter, case in CASES.items():
        name_it(letter, case["name"])
        assert "yes" in capsys.readouterr().out
        for other in set(NAMES) - {case["name"]}:
            name_it(letter, other)
            said = capsys.readouterr().out
            assert max(map(len, said.splitlines())) <= 100  # JupyterLab would break it within a word
            assert case["clue"] in said.replace("\n", " ") and case["name"] not in said  # a hint, not the answer
    name_it("A")
    assert "in place of the dots" in capsys.readouterr().out
    name_it("A", "bad luck")
    assert "none of them" in capsys.readouterr().out
    with pytest.raises(InputError, match="the cases are"):
        broken("Z")
