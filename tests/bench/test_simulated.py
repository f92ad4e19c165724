"""The simulated bench: the loop of the lesson, its compiled twin, its clock, and what happens when things go wrong."""

import dataclasses

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.bench import ArmInstance, Recording, ReplayBench, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.errors import ArmError
from ir50p_lab.modelling import IR50P, THESIS_A, Arm
from ir50p_lab.signals import hold, sinusoid

OTHER = Arm.load("data/arm_example.toml")
TARGET = hold([0.8, 0.9, -0.6])


def pid(**options):
    return PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255, **options)


def in_python(bench, controller, reference, seconds):
    controller.reset()
    for sample in bench.run(seconds, **controller.header()):
        target = reference(sample.t)
        bench.drive(controller.step(sample.t, sample.q, target), reference=target[0])
    return bench.recording


@pytest.fixture
def bench(tmp_path):
    with SimulatedBench(IR50P, seed=1, record_to=tmp_path) as bench:
        yield bench


@pytest.mark.parametrize("arm", [IR50P, OTHER], ids=lambda arm: arm.name)
@pytest.mark.parametrize("delay", [0, 2])
def test_compiled_and_python_loop_agree_to_the_last_bit(arm, delay):
    recordings, truths, benches = [], [], []
    for run in (in_python, SimulatedBench.follow):
        bench = SimulatedBench(arm, unit=ArmInstance(delay=delay), seed=4, record_to=False).open()
        for reference in (sinusoid([0.3, 0.2, 0.2], [1.0, 1.5, 2.0]), hold([0.2, 0.3, -0.2])):
            recording = run(bench, pid(position_filter_hz=3), reference, 11)  # more than a block
        recordings.append(recording)
        truths.append(bench.truth)
        benches.append(bench)
    first, second = recordings
    assert len(first) == len(second) == 1100
    for name in ("t", "q", "counts", "u", "reference", "gripper", "missed"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name), err_msg=name)
    for name in ("t", "q", "qd"):
        np.testing.assert_array_equal(getattr(truths[0], name), getattr(truths[1], name), err_msg=name)
    assert first.header.items() >= {**second.header, "date": first.header["date"]}.items()
    # and both leave the bench in the same state for what comes next
    np.testing.assert_array_equal(*(in_python(bench, pid(), TARGET, 0.5).q for bench in benches))


def test_a_recording_keeps_its_truth_when_the_arm_drives_to_rest(tmp_path):
    with SimulatedBench(IR50P, record_to=tmp_path) as bench:
        recording = bench.follow(pid(), TARGET, 0.5)
    assert len(recording.truth.q) == len(recording) and np.abs(recording.truth.q - recording.q).max() < 0.1
    assert len(bench.truth.q) > len(recording)


def test_simulated_stands_everywhere(bench):
    recording = bench.follow(pid(), TARGET, 0.1)
    assert bench.simulated and "simulated" in bench.name
    assert recording.header["simulated"] == "true" and "simulated" in recording.header["bench"]
    assert recording.header["seed"] == "1"
    assert "simulated" in recording.path.name
    assert "simulated" in recording.plot().get_suptitle().lower()


@pytest.mark.parametrize("delay", [0, 2, 5])
def test_a_command_acts_so_many_periods_after_its_sample(delay):
    unit = ArmInstance(delay=delay, spread=0, noise=0, backlash=(0, 0, 0))
    bench = SimulatedBench(IR50P, unit=unit, q0=(0, np.pi / 2, 0), record_to=False).open()
    for k, _ in enumerate(bench.run(0.2)):
        bench.drive([200, 0, 0] if k == 3 else [0, 0, 0])
    moving = np.abs(bench.truth.qd[:, 0]) > 0
    assert np.argmax(moving) == 3 + delay + 1  # it acts from sample 3 + delay on, so the next one sees motion


def test_no_drive_further_out_at_the_end_of_the_travel():
    for run in (in_python, SimulatedBench.follow):
        bench = SimulatedBench(IR50P, seed=2, q0=(1.6, 1.5, 0.0), record_to=False).open()
        winding = PID(kp=(10, 225, 270), ki=(500, 10, 50), kd=(0, 30, 30), limit_pwm=255)  # pushes on at the end
        recording = run(bench, winding, hold([IR50P.q_max[0], 1.5, 0.0]), 3)
        out = recording.q[:, 0] >= IR50P.q_max[0]
        assert out.any() and (recording.u[out, 0] == 0).all() and (recording.u[~out, 0] > 0).all()
        assert bench.truth.q[:, 0].max() < IR50P.q_max[0] + 0.002


def test_by_an_error_it_sinks_from_where_it_was():
    controller = pid()
    with pytest.raises(ZeroDivisionError), SimulatedBench(IR50P, seed=5, record_to=False) as bench:
        for sample in bench.run(5):
            bench.drive(controller.step(sample.t, sample.q, TARGET(sample.t)))
            if sample.t > 3:
                height = bench.plant.tip_true[2]
                raise ZeroDivisionError
    assert abs(bench.plant.tip_true[2]) < 0.002 < 0.1 < height  # it lies on the table
    np.testing.assert_allclose(bench.plant.qd_true, 0, atol=0.02)  # the table has no friction
    with bench:  # opened again, it is found where it lies
        sample = next(iter(bench.run(0.1)))
    assert abs(sample.q[1] - bench.truth.q[0, 1]) < 0.06


class Breaks:
    """A reference that fails in its second block."""

    def __init__(self, error=None):
        self.error = error

    def sample(self, t):
        r = TARGET.sample(t)
        if t[0] > 0 and self.error:
            raise self.error
        if t[0] > 0:
            r[57] = np.nan
        return r


def test_a_reference_that_is_no_number_cuts_the_drive(bench):
    refused(r"(?s)reference gives .*nan.* at t = 10.570 s.*finite", bench.follow, pid(), Breaks(), 30)
    assert len(bench.recording) == 1057
    assert len(Recording.load(bench.recording.path)) == 1057
    assert (bench.command == 0).all() and (bench._queue == 0).all()


def test_ctrl_c_in_a_compiled_run_keeps_what_was_recorded(bench):
    refused("", bench.follow, pid(), Breaks(KeyboardInterrupt()), 30, error=KeyboardInterrupt)
    assert len(Recording.load(bench.recording.path)) == 1000
    assert (bench.command == 0).all()


def test_follow_takes_any_controller_and_reference(bench):
    class Plain:
        def step(self, t, measured, reference):
            return 200 * (np.array(reference[0]) - measured)

    def plain_reference(t):
        return np.array([0.5, 0.5, -0.5]), np.zeros(3), np.zeros(3)

    assert len(bench.follow(Plain(), plain_reference, 1)) == 100
    compiled = bench.follow(pid(), plain_reference, 1)
    np.testing.assert_array_equal(compiled.reference, np.tile([0.5, 0.5, -0.5], (100, 1)))
    assert bench.follow(pid(), TARGET, 1, record=False) is None
    assert bench.recording is compiled


class Clock:
    def __init__(self):
        self.t = 0.0

    def now(self):
        return self.t

    def sleep(self, seconds):
        self.t += seconds + 0.0003  # a sleep is never quite right


def on_a_clock():
    """A bench in real time on a virtual clock, and the clock."""
    bench = SimulatedBench(IR50P, realtime=True, record_to=False)
    bench._clock = clock = Clock()
    return bench.open(), clock


def test_realtime_keeps_the_pace_of_the_clock_without_drift():
    bench, clock = on_a_clock()
    t = []
    for k, sample in enumerate(bench.run(20)):
        assert 0 <= clock.now() - sample.t < 0.001 or 500 <= k <= 502
        clock.sleep(0.050 if k == 500 else 0.002)
        t.append(sample.t)
    assert clock.now() == pytest.approx(1999 * 0.01, abs=0.003)
    assert sample.missed == 4 and len(t) == 1996  # of the 50 ms: left out, not caught up
    assert sample.t == 1999 * 0.01


def test_pot_errors_of_a_unit_show_in_the_angles_and_a_calibration_takes_them_out():
    unit = ArmInstance(
        spread=0, noise=0, pot_bow=(0, 0, 0), pot_shift=(3, 3, 3), pot_slope=(1.01, 1, 1), backlash=(0, 0, 0)
    )
    bench = SimulatedBench(IR50P, unit=unit, q0=(1.0, 0.5, 0.0), record_to=False).open()
    off = next(iter(bench.run(0.1))).q - bench.plant.q_true
    np.testing.assert_allclose(off, [3 / 189.1 + 0.01, 3 / 122.1, 3 / 191.7], atol=0.5 / 122)
    right = dataclasses.replace(
        bench.calibration,
        slope=tuple(np.array(bench.calibration.slope) * unit.pot_slope),
        zero=tuple(np.array(bench.calibration.zero) + 3),
    )
    bench.calibration = right
    np.testing.assert_allclose(next(iter(bench.run(0.1))).q, bench.plant.q_true, atol=0.5 / 122)


def test_what_cannot_be_is_refused():
    refused("no actuators", SimulatedBench, THESIS_A, error=ArmError)
    refused("whole milliseconds", SimulatedBench, IR50P, period=0.0105)
    refused("travel", SimulatedBench, IR50P, q0=(0, 5, 0))


def test_default_arm_is_the_students(monkeypatch, tmp_path):
    OTHER.save(tmp_path / "mine.toml")
    monkeypatch.setenv("IR50P_ARM", str(tmp_path / "mine.toml"))
    with SimulatedBench(record_to=False) as bench:
        assert bench.arm == OTHER
        recording = bench.follow(pid(), hold([0.4, 0.6, 0.2]), 5)
        assert np.isfinite(recording.q).all() and np.ptp(recording.q[:, 1]) > 0.1


def test_each_copy_and_its_recording_say_which_bench_it_is():
    bench = SimulatedBench(seed=3, record_to=False)
    assert bench.bench_id == "simulated-unit-3"
    with bench:
        bench.follow(PID(kp=(9, 9, 9), limit_pwm=255), hold([0, 0, 0]), 0.1)
        assert ReplayBench(bench.recording).bench_id == "simulated-unit-3"
