"""Arms that nobody has seen are arms; the world of one keeps the rules, whoever asks."""

from dataclasses import replace

import numpy as np
import pytest

from ir50p_lab.course.unknown.arms import ABOVE, START, Drawn, drawn
from ir50p_lab.course.unknown.far_bench import FarBench
from ir50p_lab.course.unknown.world import PICTURES, World
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P, forward_kinematics, inverse_kinematics, mass_matrix

SEEDS = (*range(20), 2**127 + 5)


@pytest.mark.parametrize("seed", SEEDS)
def test_an_arm_is_physical_bears_its_weight_and_reaches_its_balls(seed):
    given = drawn(seed)
    arm = given.arm
    rng = np.random.default_rng(seed % 1000)
    for q in rng.uniform(arm.q_min, arm.q_max, (5, 3)):
        M = mass_matrix(arm, q)
        assert np.allclose(M, M.T) and np.linalg.eigvalsh(M).min() > 0
    assert np.all(np.array(arm.friction.fs) >= arm.friction.fc)
    factor = arm.actuators.stall_torque / IR50P.actuators.stall_torque
    assert np.all(factor > 0.5 - 1e-9) and np.all(factor < 2.5 + 1e-9)
    weight = arm.g * np.array([0, arm.theta[1, 2] + arm.theta[1, 3], arm.theta[2, 3]])
    assert np.all(weight + arm.friction.fs < 0.55 * arm.actuators.stall_torque)
    assert 5 <= given.delay <= 7
    for k, ball in enumerate(given.balls):
        assert np.all(np.linalg.norm(np.delete(given.balls, k, axis=0) - ball, axis=1) > 0.11)
        assert inverse_kinematics(arm, ball + np.array([0, 0, ABOVE])).q.shape == (4, 3)


def test_a_seed_is_one_arm_and_another_is_another():
    assert drawn(3).arm == drawn(3).arm and drawn(3).arm != drawn(4).arm
    motors = np.array([drawn(seed).arm.actuators.stall_torque for seed in SEEDS]) / IR50P.actuators.stall_torque
    assert motors.min() < 0.8 and motors.max() > 2  # they differ as much as they are said to


class Puppet:
    """An arm that stands where it is put, with the counts that reach it."""

    def __init__(self, places):
        self.places, self.k, self.pushed, self.nominal = places, 0, [], IR50P_COUNTS

    def noise(self, n):
        """Nothing."""

    def counts(self):
        """Something."""
        return np.zeros(3)

    def advance(self, pwm, seconds):
        """The next place, twice a period."""
        self.k += 1
        self.pushed.append(np.array(pwm))

    @property
    def q_true(self):
        """Where it is put."""
        return self.places(self.k / 2 * 0.01)


class IR50P_COUNTS:  # noqa: N801
    """A calibration."""

    slope, zero = (100.0,) * 3, (500.0,) * 3


@pytest.fixture
def puppet(monkeypatch):
    """function(places): the world of arm 1, in which the arm is at places(t), and the puppet."""

    def make(places):
        made = Puppet(places)
        monkeypatch.setattr(Drawn, "machine", lambda given: made)
        return World(1), made

    return make


def over(world, ball, up=ABOVE):
    """A pose with the tip over a ball."""
    poses = inverse_kinematics(world.given.arm, world.given.balls[ball] + [0, 0, up]).q
    return next(q for q in poses if q[2] < 0)


def race(world, drive=(0, 0, 0)):
    bench = FarBench(world.answer)
    for _ in bench.race():
        bench.drive(drive)
    return bench


@pytest.mark.parametrize(("seconds", "touched"), [(0.28, 0), (0.31, 1)])
def test_a_touch_lasts(puppet, seconds, touched):
    world, _ = puppet(lambda t: over(world, 1) if 1 < t <= 1 + seconds else START)
    race(world)
    assert np.sum(~np.isnan(world.touched)) == touched and not world.knocked.any()
    assert world.score == 20 + 10 * (3 - touched) and not world.complete


def test_two_short_touches_are_none(puppet):
    world, _ = puppet(lambda t: over(world, 1) if 1 < t <= 1.2 or 2 < t <= 2.2 else START)
    race(world)
    assert np.isnan(world.touched).all()


def test_all_three_end_the_race_at_the_last(puppet):
    world, _ = puppet(lambda t: over(world, min(int(t / 0.5), 2)))
    bench = race(world)
    assert world.complete and world.score == pytest.approx(world.touched.max()) and 1.2 < world.score < 1.5
    assert bench.ended == "all are touched" and len(bench.recording.t) == pytest.approx(100 * world.score, abs=1)


def test_a_knocked_ball_is_lost(puppet):
    world, _ = puppet(lambda t: over(world, 0, up=0.015) if 0.5 < t < 0.6 else over(world, 0))
    race(world)
    assert world.touched[0] < 0.5 and not world.knocked[0]  # touched before: it may be pushed
    world, _ = puppet(lambda t: over(world, 0, up=0.015) if 0.1 < t < 0.2 else over(world, 0))
    race(world)
    assert world.knocked[0] and np.isnan(world.touched[0])


def test_under_the_table_a_run_ends(puppet):
    world, _ = puppet(lambda t: np.array([0, -0.9, -0.5]) if t > 0.5 else START)
    bench = race(world)
    assert bench.ended == "it was under the table" and bench.recording.t[-1] < 0.6


def test_a_command_acts_late_whole_and_bounded(puppet):
    world, made = puppet(lambda t: START)
    bench = FarBench(world.answer)
    for sample in bench.run(0.3):
        bench.drive([sample.t * 1000 + 0.4, 1e6, -1e6])
    acts = made.pushed[::2]  # one a period
    late = world.given.delay
    assert bench.delay == pytest.approx(0.01 * late)
    assert not np.any(acts[:late]) and np.array_equal(acts[late + 3], [30, 255, -255])


def test_practice_pictures_and_races_are_counted(puppet):
    world, _ = puppet(lambda t: START)
    bench = FarBench(world.answer)
    for seconds in (100, 100):
        for _ in bench.run(seconds):
            bench.drive([0, 0, 0])
    assert bench.left == pytest.approx(0, abs=1e-9) and bench.recording.t[-1] == pytest.approx(19.99)
    assert list(bench.run(10)) == []
    for _ in range(PICTURES):
        assert bench.look().shape == (480, 640, 3)
    with pytest.raises(InputError, match="all are taken"):
        bench.look()
    next(bench.race())
    with pytest.raises(InputError, match="one race an arm"):
        next(bench.race())


def test_what_is_no_command_is_told():
    bench = FarBench(World(1).answer)
    run = bench.run(1)
    next(run)
    with pytest.raises(InputError, match=r"u has shape \(2,\)"):
        bench.drive([1, 2])
    with pytest.raises(InputError, match="must be finite"):
        bench.drive([1, 2, np.nan])
    with pytest.raises(InputError, match="cannot answer"):
        World(1).answer({"op": "score"})


def test_the_nominal_numbers_are_those_of_an_ir50p_as_long():
    given = drawn(2)
    same = replace(IR50P, l=given.arm.l, lc=np.array(IR50P.lc) * given.arm.l / IR50P.l)
    assert np.allclose(given.nominal[:, 2:4], same.theta_pwm[:, 2:4])
    assert np.allclose(forward_kinematics(given.arm, [0, 0, 0])[0], sum(given.arm.l[1:]))
