"""A hand pushes the simulated arm: what it does to each controller, what holds against it, who is told."""

import time

import numpy as np
import pytest
from faulty_arm import FaultyArm
from file_bench import FileBench
from refusals import refused

from ir50p_lab.bench import Recording, SimulatedBench
from ir50p_lab.bench.runaway import RunawayGuard
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.controllers import PID
from ir50p_lab.errors import BenchError, RunawayError
from ir50p_lab.modelling import IR50P, Arm, forward_kinematics, frames
from ir50p_lab.signals import hold

TIP = 3, (0, 0, 0)
POSE = np.array([0.0, 0.8, -1.2])
P = {"kp": (400,) * 3}
PI = {"kp": (2000,) * 3, "ki": (2000,) * 3, "kd": (80,) * 3}
OTHER = Arm.load("data/arm_example.toml")


class Own:
    """A P controller as a student writes it."""

    unit = "PWM"

    def reset(self):
        pass

    def step(self, t, q, reference):
        return 400 * (reference[0] - q)


def pushed(force, begin=2.0, end=5.0, seconds=8.0, gains=PI, seed=0, place=TIP, pose=POSE, folder=False):
    """A run at `pose` with a hand from `begin` to `end`: t, tip (n, 3) in mm from where it rested, the bench."""
    bench = SimulatedBench(IR50P, q0=pose, seed=seed, record_to=folder).open()
    pid, tips = PID(**gains, limit_pwm=255), []
    for sample in bench.run(seconds, hold(pose)):
        bench.drive(pid.step(sample.t, sample.q, sample.reference))
        if begin <= sample.t < end:
            bench.push(*place, force)
        elif bench.plant.pushed:
            bench.push(*place, (0, 0, 0))
        tips.append(bench.plant.tip_true)
    t, tips = bench.recording.t, np.array(tips)
    return t, 1e3 * (tips - tips[np.searchsorted(t, begin) - 1]), bench


# ---- what it does


@pytest.mark.parametrize("arm", [IR50P, OTHER], ids=lambda arm: arm.name)
@pytest.mark.parametrize("link", [1, 2, 3])
def test_a_push_is_the_torque_of_its_work(arm, link):
    """F dot dp, p the place on the link, by differences; the joints behind the link feel nothing."""
    rng = np.random.default_rng(link)
    for _ in range(5):
        q = rng.uniform((-1, 0.5, -1.5), (1, 1.2, -0.3))
        point, force = rng.uniform(-0.1, 0.1, 3), rng.uniform(-5, 5, 3)
        one, other = (SimulatedArm(arm, q0=q) for _ in range(2))

        def place(q, point=point):
            return frames(arm, q)[link] @ np.append(point, 1)

        moves = np.array([(place(q + d) - place(q - d))[:3] / 2e-6 for d in 1e-6 * np.eye(3)])
        one.push(link, point, force)
        other._numbers -= np.concatenate([np.zeros(15), moves @ force / arm.actuators.gain, np.zeros(15)])
        for simulated in (one, other):
            simulated.advance((0, 0, 0), 0.01)
        np.testing.assert_allclose(one.qd_true, other.qd_true, atol=1e-6)
        assert np.abs(one.qd_true).max() > 0


@pytest.mark.parametrize("seed", range(3))
def test_p_springs_back_short_and_i_is_home_while_pushed_and_springs_the_other_way(seed):
    t, moved, _ = pushed((0, 5, 0), gains=P, seed=seed)
    assert moved[t < 5, 1].max() > 100  # mm
    assert 3 < abs(moved[-1, 1]) < 40
    t, moved, _ = pushed((0, 0, 10), seed=seed)
    assert 40 < moved[t < 5, 2].max() < 90
    assert abs(moved[t < 5, 2][-1]) < 10
    assert -90 < moved[t > 5, 2].min() < -35
    assert abs(moved[-1, 2]) < 10


def test_no_push_is_stronger_than_ten_newtons():
    moved, same = (pushed((0, force, 0), seconds=4.0)[1] for force in (10, 300))
    np.testing.assert_allclose(moved, same, atol=1e-9)


@pytest.mark.parametrize("force", [(0, 10, 0), (0, -10, 0), (0, 0, 10), (0, 0, -10), (-7, 0, 7)], ids=str)
def test_stops_and_table_hold(force):
    pose = np.array([0.0, 0.2, -0.6])
    for link in (2, 3):
        _, _, bench = pushed(force, gains={"kp": (20, 100, 100)}, pose=pose, end=8.0, place=(link, (0, 0, 0)))
        q, play = bench.truth.q, 0.01
        assert (q > np.array(IR50P.q_min) - play).all() and (q < np.array(IR50P.q_max) + play).all()
        assert forward_kinematics(IR50P, q)[:, 2].min() > -0.005


def test_a_push_is_told_as_it_grows_and_ends_a_second_after_it_was_repeated_last():
    bench = SimulatedBench(IR50P, q0=POSE, record_to=False).open()
    for sample in bench.run(2.5):
        if 0.5 <= sample.t <= 1.0:
            bench.push(*TIP, (0, 0, 8.2 * (sample.t - 0.5)))
    *grows, (ended, text) = bench.recording.events
    assert 1.95 < ended < 2.05
    assert text == "the hand has let go; it pushed with 4.1 N at most"
    assert 4 <= len(grows) <= 6  # newton by newton


def test_the_next_run_begins_without_a_hand():
    bench = SimulatedBench(IR50P, q0=POSE, record_to=False).open()
    for _ in bench.run(0.1):
        bench.push(*TIP, (0, 4, 0))
    bench.follow(PID(**PI, limit_pwm=255), hold(POSE), 0.1)
    assert not bench.plant.pushed and not bench.recording.events
    np.testing.assert_array_equal(bench.plant._numbers, SimulatedArm(IR50P)._numbers)


# ---- who is told


@pytest.mark.parametrize("force", [(0, 5, 0), (0, 10, 0), (0, 0, 10), (0, 0, -10), (6, -6, 0)], ids=str)
@pytest.mark.parametrize("gains", [P, PI], ids=["P", "PI"])
def test_the_guard_knows_the_hand(force, gains):
    t, _, _ = pushed(force, end=9.0, seconds=12.0, gains=gains)
    assert t[-1] > 11.9


def test_untold_it_ends_the_run_as_that_of_a_real_arm_does(monkeypatch):
    monkeypatch.setattr(RunawayGuard, "begin_anew", lambda guard: None)
    refused("", pushed, (0, 5, 0), end=8.0, error=RunawayError)


def test_the_guard_looks_again_when_the_hand_has_let_go():
    bench = SimulatedBench(IR50P, q0=(0.0, 0.6, -0.6), record_to=False).open()
    bench.plant = FaultyArm(bench.plant, 0, "motor")
    pid = PID(kp=(120, 225, 270), kd=(40, 30, 30), limit_pwm=255)
    with pytest.raises(RunawayError, match=r"joint 1 .*swapped"):
        for sample in bench.run(5.0, hold((0.8, 0.6, -0.6))):
            bench.drive(pid.step(sample.t, sample.q, sample.reference))
            if sample.t < 0.3:
                bench.push(*TIP, (0, sample.t < 0.29, 0))  # 1 N, and 0 N in the end
    assert sample.t > 0.3


def test_the_recording_says_when_and_how_hard(tmp_path):
    _, _, bench = pushed((3, 0, 4), begin=1.0, end=1.5, seconds=2.0, folder=tmp_path)
    (begun, text), (ended, over) = Recording.load(bench.recording.path).events
    assert begun == pytest.approx(1.0) and text == "a hand pushes at link 3 with 5.0 N (x y z: 3.0 0.0 4.0)"
    assert ended == pytest.approx(1.5) and over == "the hand has let go; it pushed with 5.0 N at most"


# ---- in the background


@pytest.mark.timing
@pytest.mark.parametrize("controller", [Own(), PID(**P, limit_pwm=255)], ids=["own", "compiled"])
def test_a_controller_in_the_background_is_pushed(controller):
    with SimulatedBench(IR50P, q0=POSE, realtime=True, record_to=False) as bench:
        run = bench.start(controller)
        deadline = time.monotonic() + 10
        while run.most_push == 0 or len(run.recent(1).t) < 10:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        assert run.most_push == 10
        before = run.recent(0.1).q[-1]
        while abs(run.recent(0.1).q[-1] - before)[0] < 0.05:
            assert time.monotonic() < deadline
            run.push(*TIP, (0, 8, 0))
            time.sleep(0.05)
        for wrong in ((0, (0, 0, 0), (0, 0, 1)), (3, (0, 0), (0, 0, 1)), (3, (0, 0, 0), (0, 0, np.nan))):
            refused("", run.push, *wrong)
        assert run.alive
        assert "with 8.0 N" in run.recording.events[0][1]
        run.cut()
        assert run.most_push == 0


@pytest.mark.timing
def test_only_a_simulated_arm_is_pushed_from_here(tmp_path):
    with FileBench(str(tmp_path / "commands.txt"), record_to=False) as bench:
        run = bench.start(PID(**P, limit_pwm=255), None)
        assert run.most_push == 0
        refused("only a simulated arm", run.push, *TIP, (0, 0, 1))
        run.cut()
    with SimulatedBench(IR50P, record_to=False) as bench, pytest.raises(BenchError, match="inside a run"):
        bench.push(*TIP, (0, 0, 1))
