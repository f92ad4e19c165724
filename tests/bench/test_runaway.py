"""Joints that do not do what their motors make them do are cut, and no joint that does: on simulated and emulated arms."""

import dataclasses

import numpy as np
import pytest
from faulty_arm import FaultyArm

from ir50p_lab.bench import SerialBench, SimulatedBench, nominal_calibration
from ir50p_lab.bench.runaway import RunawayGuard
from ir50p_lab.bench.simulated_arm import SLOPE, SimulatedArm
from ir50p_lab.controllers import PID
from ir50p_lab.errors import RunawayError
from ir50p_lab.modelling import IR50P, IR50P_WEAK_SHOULDER
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
