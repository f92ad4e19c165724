"""Joints that do not do what their motors make them do are cut, and no joint that does: on simulated and emulated arms."""

import contextlib
import dataclasses

import numpy as np
import pytest
from faulty_arm import FaultyArm

from ir50p_lab.bench import SerialBench, SimulatedBench, nominal_calibration
from ir50p_lab.bench.arm_instance import UNIT
from ir50p_lab.bench.bench_test import _drive
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.runaway import RunawayGuard
from ir50p_lab.bench.simulated_arm import BOW, SLOPE, ZERO, SimulatedArm
from ir50p_lab.controllers import PID
from ir50p_lab.errors import RunawayError
from ir50p_lab.modelling import IR50P, IR50P_WEAK_SHOULDER, forward_kinematics, frames, gravity, load_arm
from ir50p_lab.signals import hold
from ir50p_lab.simulation.plant import TF

GAINS = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30)}  # Tables 4.1-4.3
TARGET = (1.57, 1.57, -1.05)
NEAR = (1.0, 1.57, -1.05)  # a runaway is seen before the arm is 2 rad away
SAID = {"motor": "swapped", "pot": "swapped", "stuck": "stood still", "floating": "torn"}


def drive(bench, seconds, target=TARGET):
    pid, reference = PID(**GAINS, limit_pwm=255), hold(target)
    for sample in bench.run(seconds):
        bench.drive(pid.step(sample.t, sample.q, reference(sample.t)))


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize("fault", SAID)
def test_a_faulty_joint_is_cut_on_the_simulated_arm(fault, joint):
    """It may turn by 0.7 rad until then: joint 2, whose payload could be the reason, the farthest."""
    for seed in range(4):
        bench = SimulatedBench(seed=seed, q0=(0.0, 0.6, -0.6), record_to=False).open()
        bench.plant = FaultyArm(bench.plant, joint, fault, seed)
        with pytest.raises(RunawayError, match=rf"joint {joint + 1} .*{SAID[fault]}"):
            drive(bench, 5.0, target=(1.57, 1.57, -1.57))
        assert abs(bench.plant.q_true[joint] - (0.0, 0.6, -0.6)[joint]) < 0.7
        bench.abort()


@pytest.mark.parametrize("fault", SAID)
def test_a_faulty_joint_is_cut_on_the_emulated_board(fault):
    from tests.emulator.virtual import VirtualBoard

    joint = list(SAID).index(fault) % 3
    arm = SimulatedArm(IR50P, q0=(0.0, 0.6, -0.6))
    board = VirtualBoard(FaultyArm(arm, joint, fault))
    bench = SerialBench(board, arm=IR50P, clock=board, record_to=False).open()
    with pytest.raises(RunawayError, match=rf"joint {joint + 1} .*{SAID[fault]}"):
        drive(bench, 3.0, target=(1.57, 1.57, -1.57))
    assert not any(board.pins().pwm)
    bench.abort()


def test_the_compiled_loop_is_guarded_by_the_same_code():
    """A potentiometer with swapped ends, in the tables that the compiled loop reads."""
    ran = {}
    for compiled in (True, False):
        bench = SimulatedBench(record_to=False).open()
        bench.plant._w[SLOPE, 0] *= -1
        pid = PID(**GAINS, limit_pwm=255)
        with pytest.raises(RunawayError, match="joint 1 ran") as error:
            if compiled:
                bench.follow(pid, hold(NEAR), 5.0)
            else:
                drive(bench, 5.0, target=NEAR)
        ran[compiled] = str(error.value), bench.plant.q_true.tolist()
    assert ran[True] == ran[False]


def mirrored(arm, joint, **options):
    """An open bench with the ends of a potentiometer swapped, in the tables of the compiled loop; its measured pose."""
    bench = SimulatedBench(arm, record_to=False, **options).open()
    numbers = bench.plant._w
    numbers[[SLOPE, BOW], joint] *= -1
    numbers[ZERO, joint] = 1023 - numbers[ZERO, joint]
    return bench, np.clip(bench.calibration.radians(bench.plant.counts()), arm.q_min, arm.q_max)


def strong_drive(arm, recording, joint):
    """For how long |u| was above the largest gravity at any angle of the joint and its breakaway, s."""
    q = np.tile(recording.q[:, None], (1, 180, 1))
    q[:, :, joint] = np.linspace(-np.pi, np.pi, 180)
    largest = np.abs(gravity(arm, q.reshape(-1, 3))[:, joint]).reshape(-1, 180).max(axis=1)
    enough = (largest + arm.friction.fs[joint]) / arm.actuators.gain[joint]
    return 0.01 * (np.abs(recording.u[:, joint]) > enough).sum()


@pytest.mark.parametrize("arm", [IR50P, IR50P_WEAK_SHOULDER], ids=lambda arm: arm.name)
@pytest.mark.parametrize("more", [0.1, 0.2, 0.4])
def test_a_mirrored_shoulder_in_the_rest_pose_is_named_soon(arm, more):
    """Its measured pose is possible; joint 3 lies at its stop, and its gravity is reckoned with the wrong shoulder."""
    for seed in range(3):
        bench, q = mirrored(arm, 1, seed=seed, q0=rest_pose(arm))
        with pytest.raises(RunawayError, match=r"^joint 2 .*bench-test"):
            bench.follow(PID(**GAINS, limit_pwm=255), hold(q + np.array([0, more, 0])), 60.0)
        assert strong_drive(arm, bench.recording, 1) < 5.0


@pytest.mark.parametrize(("drift", "swing", "alarm"), [(0.0, 0.0, True), (-0.02, 0.0, True), (0.0, 0.15, False)])
def test_a_strong_drive_that_leads_nowhere_is_named_though_it_comes_and_goes(drift, swing, alarm):
    """The drive scatters from sample to sample, its mean is strong for half a second, weak for another.

    drift, rad/s: against the drive; swing, rad: up while it is strong, back while it is weak.
    """
    sample = dataclasses.make_dataclass("Sample", ["t", "q"])
    guard, strong = RunawayGuard(IR50P, nominal_calibration(IR50P), 0.01), 0
    with pytest.raises(RunawayError, match=r"^joint 2") if alarm else contextlib.nullcontext():
        for k in range(1500):
            up = 1 - abs(1 - (k % 100) / 50)  # 0 to 1 and back in a second
            q = np.array([0.0, -0.3 + drift * 0.01 * k + swing * up, -2.4])
            u = (20.0, 220.0)[k % 2] if k % 100 < 50 else 20.0
            strong += u > 84
            guard.check(sample(0.01 * k, q), np.array([0.0, u, 0.0]))
    assert not alarm or strong < 500


@pytest.mark.parametrize("size", [80, 110, 150, 200])
def test_a_command_that_swings_to_and_fro_may_leave_a_joint_where_it_is(size):
    """Ten times a second, as with a noisy derivative: the joint trembles by less than its potentiometer's noise."""
    with SimulatedBench(q0=(0, 0.5, -1), record_to=False) as bench:
        for k, sample in enumerate(bench.run(seconds=4, reference=hold((0, 0.5, -1)))):
            u = 2000 * (sample.reference[0] - sample.q)
            u[0] = size if k % 10 < 5 else -size
            bench.drive(u)
        assert np.ptp(bench.recording.q[200:, 0]) < 0.1


UNDER = (0.0, 1.7, -0.3)  # with a mirrored shoulder 15 cm under the table


@pytest.mark.parametrize("way", ["loop", "compiled", "background"])
def test_nothing_is_driven_from_under_the_table(way):
    bench, q = mirrored(IR50P, 1, q0=UNDER)
    for _ in bench.run(3.0):
        bench.drive([0, 0, 0])  # to look at it is no alarm
    said = r"^the tip is measured 1\d cm under the table.*joint 2.*swapped.*bench-test"
    pid, reference = PID(**GAINS, limit_pwm=255), hold(q + np.array([0, 0.2, 0]))
    if way == "loop":
        for sample in bench.run(1.0):
            for _ in range(2):  # also if the loop's body catches it
                with pytest.raises(RunawayError, match=said):
                    bench.drive(pid.step(sample.t, sample.q, reference(sample.t)))
    else:
        with pytest.raises(RunawayError, match=said):
            bench.follow(pid, reference, 1.0) if way == "compiled" else bench.start(pid, None).join(10.0)
    assert not bench.recording.u.any()
    assert bench.plant.q_true == pytest.approx(UNDER, abs=2e-3)


@pytest.mark.parametrize(("depth", "drive", "alarm"), [(0.03, 20, False), (0.08, 0, False), (0.08, 20, True)])
def test_a_tip_far_under_the_table_is_an_alarm_while_driven(depth, drive, alarm):
    sample = dataclasses.make_dataclass("Sample", ["t", "q"])
    guard = RunawayGuard(IR50P, nominal_calibration(IR50P), 0.01)
    q2 = [np.arcsin((z - IR50P.l[0]) / (IR50P.l[1] + IR50P.l[2])) for z in (0.0, -depth)]
    steps = np.repeat([0, 1, 0, 1], [30, 20, 30, 50])  # the first visit is too short
    with pytest.raises(RunawayError, match="8 cm under the table") if alarm else contextlib.nullcontext():
        for k, place in enumerate(steps):
            guard.check(sample(0.01 * k, np.array([0.01 * k, q2[place], 0.0])), np.array([drive, 0.0, 0.0]))
    assert not alarm or 105 <= k <= 120


def test_a_table_elsewhere_is_known():
    bench = SimulatedBench(IR50P, unit=dataclasses.replace(UNIT, table=-0.3), q0=(0, -0.8, 0.0), record_to=False).open()
    assert forward_kinematics(IR50P, bench.plant.q_true)[2] < -0.1
    bench.follow(PID(**GAINS, limit_pwm=255), hold((0, -0.7, 0.1)), 2.0)


def test_the_bench_test_of_a_joint_does_not_trip_over_the_potentiometer_of_another():
    bench, _ = mirrored(IR50P, 1, q0=UNDER)
    assert "breaks away" in _drive(bench, 0, True, {})
    with pytest.raises(RunawayError, match="under the table"):
        bench.follow(PID(**GAINS, limit_pwm=255), hold((0, 0, 0)), 1.0)


@pytest.mark.parametrize(
    "arm", [IR50P, IR50P_WEAK_SHOULDER, load_arm("data/arm_example.toml")], ids=lambda arm: arm.name
)
def test_no_false_alarm_in_long_ordinary_runs(arm):
    """From rest and from anywhere, far enough to end at stops and on the table, with 0.3 kg that the guard ignores."""
    for seed in range(12):
        rng = np.random.default_rng(seed)
        loaded = arm.with_payload(0.3) if seed % 2 else arm
        q = rest_pose(arm)
        while seed % 3 and (q is rest_pose(arm) or frames(arm, q)[2:, 2, 3].min() < 0.02):
            q = rng.uniform(arm.q_min, arm.q_max)
        bench = SimulatedBench(loaded, seed=seed, q0=q, record_to=False).open()
        bench._make_guard = lambda bench=bench: RunawayGuard(arm, bench.calibration, bench.period)
        scale = rng.uniform((0.3, 0.0, 0.0), (1.5, 4.0, 1.5))
        pid = PID(**{name: k * np.array(GAINS[name]) for name, k in zip(GAINS, scale, strict=True)}, limit_pwm=255)
        for far in (0.5, 1.9):
            goal = np.clip(q + rng.uniform(-far, far, 3), arm.q_min, arm.q_max)
            bench.follow(pid, hold(goal), 20.0)
            q = np.clip(bench.last.q, arm.q_min, arm.q_max)


class Pushed:
    """A SimulatedArm whose joints are pushed with a torque of time, (3,) PWM counts of each motor."""

    def __init__(self, plant, push):
        self._plant, self._push, self._t = plant, push, 0.0
        self._offset = plant._numbers[TF : TF + 3].copy()

    def __getattr__(self, name):
        return getattr(self._plant, name)

    def advance(self, pwm, seconds):
        self._t += seconds
        self._plant._numbers[TF : TF + 3] = self._offset - self._push(self._t)
        self._plant.advance(pwm, seconds)


@pytest.mark.parametrize("arm", [IR50P, IR50P_WEAK_SHOULDER], ids=lambda arm: arm.name)
def test_no_false_alarm_with_payload_and_hand(arm):
    """Random gains, set points beyond the travel and into the table, up to 0.3 kg at the tip, a hand at every joint.

    The hand pushes for up to 2 s with up to 8 N at the tip, but with no more than the motor's stall torque.
    """
    lever = np.array([arm.l[1] + arm.l[2], arm.l[1] + arm.l[2], arm.l[2]])
    strongest = np.minimum(8.0 * lever / arm.actuators.gain, 255)
    for seed in range(20):
        rng = np.random.default_rng(seed)
        payload = rng.uniform(0, 0.3)
        m3 = arm.m[2] + payload
        lc3 = (arm.m[2] * arm.lc[2] + payload * arm.l[2]) / m3
        loaded = dataclasses.replace(arm, m=(*arm.m[:2], m3), lc=(*arm.lc[:2], lc3))
        bench = SimulatedBench(loaded, seed=seed, record_to=False).open()
        bench._make_guard = lambda bench=bench: RunawayGuard(arm, bench.calibration, bench.period)
        begin, length, size = rng.uniform(0.5, 3, 3), rng.uniform(0.3, 2, 3), rng.uniform(-1, 1, 3) * strongest

        def push(t, begin=begin, length=length, size=size):
            return size * np.sin(np.pi * np.clip((t - begin) / length, 0, 1)) ** 2

        bench.plant = Pushed(bench.plant, push)
        scale = rng.uniform((0.3, 0.0, 0.3), (2.0, 4.0, 1.5))
        pid = PID(**{name: k * np.array(GAINS[name]) for name, k in zip(GAINS, scale, strict=True)}, limit_pwm=255)
        reference = hold(rng.uniform(np.array(arm.q_min) - 0.1, np.array(arm.q_max) + 0.1))
        for sample in bench.run(4.0):
            bench.drive(pid.step(sample.t, sample.q, reference(sample.t)))
        assert sample.t > 3.9
        bench.abort()


def test_one_disturbed_sample_is_no_alarm():
    guard = RunawayGuard(IR50P, nominal_calibration(IR50P), 0.01)
    sample = dataclasses.make_dataclass("Sample", ["t", "q"])
    for k in range(200):
        q = np.array([1.5 if k % 10 == 3 else 0.0, 0.0, 0.0])
        guard.check(sample(0.01 * k, q), np.zeros(3))


def test_an_arm_without_actuators_is_not_guarded():
    bare = dataclasses.replace(IR50P, actuators=None)
    bench = SerialBench("COM3", arm=bare, calibration=nominal_calibration(bare))
    assert bench._make_guard() is None
