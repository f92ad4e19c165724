"""The simulated arm: each thing that hurts on a real one, by itself, against a value known from elsewhere."""

import dataclasses
import pickle

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.bench import ArmInstance
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.modelling import IR50P, IR50P_WEAK_SHOULDER, Arm, gravity
from ir50p_lab.simulation import simulate

NO_PLAY = {"backlash": (0, 0, 0), "spread": 0}
IDEAL = ArmInstance(**NO_PLAY, dead_zone=(0, 0, 0), noise=0, pot_bow=(0, 0, 0))
OTHER = Arm.load("data/arm_example.toml")
STRAIGHT_UP = (0.0, np.pi / 2, 0.0)  # no gravity on any joint


class Fixed:
    """A controller that sends the same PWM counts for ever."""

    def __init__(self, pwm):
        self.pwm = np.array(pwm, dtype=float)

    def step(self, t, measured, reference):
        return self.pwm


@pytest.mark.parametrize("arm", [IR50P, IR50P_WEAK_SHOULDER, OTHER], ids=lambda arm: arm.name)
def test_an_ideal_unit_moves_as_the_simulation_does(arm):
    simulated = SimulatedArm(arm, IDEAL)
    q = [simulated.q_true]
    for _ in range(100):
        simulated.advance((120, 100, -60), 0.01)
        q.append(simulated.q_true)
    expected = simulate(arm, Fixed((120, 100, -60)), duration=1.0, unit="PWM", stops=True, table=0.0)
    np.testing.assert_allclose(q, expected.q, atol=1e-12)


def test_breakaway_sticks_below_and_moves_above():
    arm = SimulatedArm(IR50P, IDEAL, q0=STRAIGHT_UP)
    # breakaway of joint 1 is 36 counts, its offset 4 counts against positive drive
    arm.advance((39, 0, 0), 2.0)
    assert arm.q_true[0] == 0.0
    arm.advance((41, 0, 0), 2.0)
    assert arm.q_true[0] > 0.1


def test_supply_saturates():
    full, beyond = (SimulatedArm(IR50P, IDEAL, q0=STRAIGHT_UP) for _ in range(2))
    full.advance((255, -255, 255), 0.3)
    beyond.advance((900, -900, 900), 0.3)
    np.testing.assert_array_equal(full.q_true, beyond.q_true)


def test_dead_zone_swallows_short_pulses_only():
    slick = IR50P.without_friction()
    arm = SimulatedArm(slick, ArmInstance(**NO_PLAY, dead_zone=(3, 3, 3)), q0=STRAIGHT_UP)
    arm.advance((2.9, 0, 0), 1.0)
    assert arm.q_true[0] == 0.0
    free = SimulatedArm(slick, IDEAL, q0=STRAIGHT_UP)
    for one in (arm, free):
        one.advance((10, 0, 0), 1.0)
    assert arm.q_true[0] == free.q_true[0] > 0.01  # a longer pulse counts in full


def test_motor_gain_is_torque_per_count():
    weak = SimulatedArm(IR50P, ArmInstance(**NO_PLAY, noise=0, motor_gain=(0.5, 1, 1)), q0=STRAIGHT_UP)
    weak.advance((79, 0, 0), 1.0)
    assert weak.q_true[0] == 0.0  # 79 halves to 39.5 < 40
    weak.advance((81, 0, 0), 1.0)
    assert weak.q_true[0] > 0


def test_backlash_loses_the_play_when_the_motion_turns_and_no_more():
    play = 0.02
    arm = SimulatedArm(IR50P, ArmInstance(spread=0, backlash=(play,) * 3, noise=0), q0=STRAIGHT_UP)
    gap = []
    for pwm in (100, -100, 100):
        arm.advance((pwm, 0, 0), 0.6)
        gap.append(arm._x[0] - arm.q_true[0])
    np.testing.assert_allclose(gap, [play / 2, -play / 2, play / 2], atol=1e-12)


def test_gravity_presses_the_teeth_of_joints_2_and_3_together():
    arm = SimulatedArm(IR50P, ArmInstance(spread=0, backlash=(0.02,) * 3, noise=0))  # stretched out, horizontal
    for pwm in (200, 100):  # up, then down: the link hangs on the lower flank both times
        arm.advance((0, pwm, 57), 0.5)
        assert arm._x[1] - arm.q_true[1] == pytest.approx(0.01)
    assert arm._x[0] == arm.q_true[0] == 0.0  # no gravity on joint 1: it stays where it is


def test_without_drive_the_stretched_arm_sinks_and_stays_in_its_rest_pose():
    arm = SimulatedArm(IR50P, seed=1)
    assert np.abs(gravity(IR50P, arm.q_true))[1] > 3 * IR50P.friction.fs[1]
    arm.advance((0, 0, 0), 1.0)
    assert arm.q_true[1] < -0.2
    arm.place(rest_pose(IR50P))
    arm.advance((0, 0, 0), 5.0)
    np.testing.assert_allclose(arm.q_true, rest_pose(IR50P), atol=0.035)  # the way to the end stop beside it


def test_time_left_over_is_kept():
    whole, pieces = (SimulatedArm(IR50P, IDEAL) for _ in range(2))
    whole.advance((50, 50, 50), 0.1)
    for _ in range(250):
        pieces.advance((50, 50, 50), 0.0004)
    np.testing.assert_array_equal(whole.q_true, pieces.q_true)


def test_noise_is_one_count_rms_before_rounding():
    arm = SimulatedArm(IR50P, ArmInstance(spread=0, pot_bow=(0, 0, 0)))
    after = np.array([arm.counts() for _ in range(4000)])
    np.testing.assert_array_equal(after, np.rint(after))
    np.testing.assert_allclose(after.std(axis=0), np.sqrt(1 + 1 / 12), rtol=0.04)  # rounding adds 1/12
    np.testing.assert_allclose(after.mean(axis=0), arm.nominal.counts(arm.q_true), atol=0.06)


def test_bow_is_its_number_in_the_middle_and_nothing_at_the_ends():
    unit = ArmInstance(spread=0, noise=0, pot_bow=(8.0, -4.0, 2.0), table=-1.0)
    low, high = np.array(IR50P.q_min), np.array(IR50P.q_max)
    for q, share in ((low, 0), (high, 0), ((low + high) / 2, 1), (low + (high - low) / 4, 0.75)):
        arm = SimulatedArm(IR50P, unit, q0=q)
        straight = arm.nominal.counts(q)
        np.testing.assert_array_equal(arm.counts(), np.rint(straight + share * np.array(unit.pot_bow)))


def test_the_converter_ends_at_0_and_1023():
    arm = SimulatedArm(IR50P, ArmInstance(spread=0, pot_shift=(900, -900, 0)))
    assert arm.counts()[:2].tolist() == [1023, 0]


def test_noise_is_the_same_however_it_is_taken():
    one, many = SimulatedArm(IR50P, seed=2), SimulatedArm(IR50P, seed=2)
    np.testing.assert_array_equal(
        np.vstack([one.noise(1) for _ in range(2500)]), np.vstack([many.noise(n) for n in (3, 1500, 997)])
    )


def test_where_it_cannot_stand():
    refused("q0 of joint 1 is 3", SimulatedArm, IR50P, q0=(3, 0, 0))
    refused("table", SimulatedArm, IR50P, q0=(0, -0.8, -1.0))
    refused("shape", SimulatedArm, IR50P, q0=(0, 0))


def test_an_arm_that_cannot_stand_at_zero_starts_at_rest():
    arm = dataclasses.replace(IR50P, q_min=(-1, 0.2, -2), q_max=(1, 1.5, -0.1))
    np.testing.assert_array_equal(SimulatedArm(arm).q_true, rest_pose(arm))


@pytest.mark.parametrize("mass", [0.1, 0.3, 0.5])
def test_a_payload_is_taken_up_in_the_rest_pose_of_the_bare_arm(mass):
    loaded = IR50P.with_payload(mass)
    np.testing.assert_array_equal(rest_pose(loaded), rest_pose(IR50P))
    np.testing.assert_array_equal(rest_pose(loaded.with_payload(0.1)), rest_pose(IR50P))
    assert pickle.loads(pickle.dumps(loaded)) == loaded


def test_an_arm_with_a_payload_keeps_its_rest_pose_when_it_is_changed_or_saved(tmp_path):
    loaded = IR50P.with_payload(0.3)
    loaded.save(tmp_path / "arm.toml")
    assert Arm.load(tmp_path / "arm.toml") == loaded
    for other in (Arm.load(tmp_path / "arm.toml"), dataclasses.replace(loaded, name="another")):
        np.testing.assert_array_equal(rest_pose(other), rest_pose(IR50P))
    for number in ("m", "lc", "Iyy", "Izz"):
        np.testing.assert_allclose(getattr(loaded.bare, number), getattr(IR50P, number), rtol=1e-12)
