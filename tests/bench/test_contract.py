"""What every bench promises, the same tests on each: simulated, replayed, and a board behind a serial port.

The board is there twice on virtual time: a stand-in in Python, and the compiled firmware in an emulated processor with
the simulated arm behind its pins. A smoke run in real time, on a pseudo-terminal, is in test_real_time.py.
"""

import math
import signal
from importlib import import_module

import numpy as np
import pytest
from benches import GAINS, RIGS
from refusals import refused

from ir50p_lab.bench import Recording, Sample, nominal_calibration, serial_bench
from ir50p_lab.bench.calibration import JointCalibration
from ir50p_lab.bench.ports import Port
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.controllers import PID
from ir50p_lab.errors import BenchError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold

REST = rest_pose(IR50P)
# The loop of the lesson, as a student types it
EXPERIMENT = """
from ir50p_lab.bench import connect
from ir50p_lab.controllers import PID
from ir50p_lab.signals import hold
pid = PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255)
target = hold([1.57, 1.57, -1.05])
with connect() as bench:                         # Arduino if one answers, else the simulated arm; says which and why
    for sample in bench.run(seconds=30, reference=target):   # every 10 ms: sample.t, .q, .reference, .counts, .missed
        applied_pwm = bench.drive(pid.step(sample.t, sample.q, sample.reference))
bench.recording.plot()
"""


class Failing:
    """A number that is none, and says so in its own way."""

    def __float__(self):
        raise RuntimeError("no number")


STRANGE = [["1", "2", "3"], [1j, 0, 0], [Failing(), 0, 0], np.zeros(3, "m8[s]"), [True, False, True]]


@pytest.fixture
def ctrl_c():
    """Ctrl-C raises KeyboardInterrupt, as in a terminal; programs started in the background ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(params=RIGS)
def rig_at(request, tmp_path):
    """A rig with the arm at a pose: rig_at(q0)."""
    made = []

    def make(q0):
        made.append(RIGS[request.param](tmp_path, q0))
        return made[-1]

    yield make
    for rig in made:
        if rig.made is not None:
            rig.made.abort()


@pytest.fixture
def rig(rig_at):
    """The arm stands in its rest pose: closing takes no long way."""
    return rig_at(REST)


def is_off(rig):
    return (rig.drive_on_the_arm() == 0).all()


class TestContract:
    # ---- open and closed

    def test_it_is_opened_by_with_and_closed_after_it(self, rig):
        bench = rig.bench()
        refused("is closed: open it with", bench.run, 1, error=BenchError)
        with bench as same:
            assert same is bench
            assert len(list(bench.run(0.05))) == 5
        refused("is closed", bench.run, 1, error=BenchError)
        assert is_off(rig)
        bench.close()
        bench.abort()  # once more does no harm

    def test_opening_twice_does_no_harm(self, rig):
        bench = rig.bench().open()
        assert bench.open() is bench
        with bench:
            assert len(list(bench.run(0.05))) == 5

    def test_opening_drives_nothing(self, rig):
        rig.bench().open()
        assert is_off(rig)

    # ---- a run

    @pytest.mark.parametrize("period", [0.01, 0.02])
    def test_a_sample_every_period(self, rig, period):
        bench = rig.bench(period=period) if rig.moves else rig.bench()
        bench.open()
        samples = list(bench.run(0.5))
        assert len(samples) == round(0.5 / bench.period)
        t = np.array([sample.t for sample in samples])
        grid = np.arange(len(t)) * bench.period
        if rig.exact:
            np.testing.assert_array_equal(t, grid)
        else:
            np.testing.assert_allclose(t, grid, atol=0.5e-3)
        assert samples[-1].missed == 0

    def test_samples(self, rig):
        bench = rig.bench().open()
        for sample in bench.run(0.1):
            assert isinstance(sample, Sample)
            assert isinstance(sample.t, float)
            assert isinstance(sample.missed, int)
            assert sample.q.shape == sample.counts.shape == (3,)
            assert sample.q.dtype == sample.counts.dtype == float
            assert ((sample.counts >= 0) & (sample.counts <= 1023)).all()
            np.testing.assert_allclose(sample.q, bench.calibration.radians(sample.counts), atol=1e-5)
            np.testing.assert_allclose(sample.q, REST, atol=0.2)  # the unit is not as its calibration says

    @pytest.mark.parametrize("seconds", [0, -1, math.nan, math.inf, "ten", None])
    def test_a_run_needs_a_duration(self, rig, seconds):
        bench = rig.bench().open()
        refused("how long to run", bench.run, seconds)

    def test_a_second_run_begins_anew(self, rig):
        bench = rig.bench().open()
        first = [sample.t for sample in bench.run(0.1)]
        recording = bench.recording
        second = [sample.t for sample in bench.run(0.1)]
        np.testing.assert_allclose(first, second, atol=1e-3)
        assert bench.recording is not recording
        assert recording.path != bench.recording.path
        assert len(recording) == len(bench.recording) == 10

    def test_a_loop_left_by_break(self, rig):
        bench = rig.bench().open()
        for k, _ in enumerate(bench.run(10)):
            bench.drive((11, 0, 0))
            if k == 4:
                break
        recording = bench.recording
        again = list(bench.run(0.05))
        assert len(recording) == 5
        assert recording.u[-1, 0] == 11
        assert len(Recording.load(recording.path)) == 5
        assert len(again) == 5 and again[0].t < 1e-3

    # ---- drive

    def test_drive_returns_what_was_sent(self, rig):
        bench = rig.bench().open()
        for _ in bench.run(0.03):
            sent = bench.drive([300, -1000.4, 2.6])
            assert isinstance(sent, np.ndarray) and sent.shape == (3,)
            assert sent.tolist() == [255, -255, 3]
        assert bench.recording.u.tolist() == [[255, -255, 3]] * 3

    def test_drive_reaches_the_arm(self, rig):
        bench = rig.bench().open()
        for k, _ in enumerate(bench.run(0.1)):
            if rig.moves and k >= 4:
                np.testing.assert_allclose(np.sign(rig.drive_on_the_arm()), [1, -1, 1])
            bench.drive([60, -40, 20])

    def test_a_command_holds_until_the_next(self, rig):
        bench = rig.bench().open()
        for k, _ in enumerate(bench.run(0.5)):
            if k == 0:
                bench.drive([30, -20, 0])
        assert bench.recording.u.tolist() == [[30, -20, 0]] * 50
        if rig.moves:
            np.testing.assert_array_equal(np.sign(rig.drive_on_the_arm()), [1, -1, 0])

    def test_a_run_begins_without_drive(self, rig):
        bench = rig.bench().open()
        for _ in bench.run(0.1):
            bench.drive([50, 50, 50])
        list(bench.run(0.1))
        assert (bench.recording.u == 0).all()
        assert is_off(rig)

    @pytest.mark.parametrize(
        "pwm", [(math.nan, 0, 0), (0, math.inf, 0), (1, 2), (1, 2, 3, 4), [[1, 2, 3]], None, [10**400, 0, 0], *STRANGE]
    )
    def test_a_command_that_is_none_is_refused_and_cuts(self, rig, pwm):
        bench = rig.bench().open()
        for k, _ in enumerate(bench.run(0.06)):
            if k < 3:
                bench.drive([60, 60, 60])
            elif k == 3:
                refused("three finite numbers", bench.drive, pwm)
                assert is_off(rig)
        assert (bench.recording.u[4:] == 0).all()

    def test_drive_outside_a_run_is_refused(self, rig):
        bench = rig.bench().open()
        refused(r"only inside `for sample in bench.run", bench.drive, [50, 50, 50], error=BenchError)
        for _ in bench.run(0.05):
            bench.drive([50, 50, 50])
        refused("only inside", bench.drive, [50, 50, 50], error=BenchError)
        assert is_off(rig)

    def test_the_gripper(self, rig):
        bench = rig.bench().open()
        seen = []
        for k, _ in enumerate(bench.run(0.08)):
            seen.append(rig.gripper() if hasattr(rig, "gripper") else None)
            bench.drive([0, 0, 0], gripper={0: True, 4: False}.get(k))
        assert bench.recording.gripper.tolist() == [1, 1, 1, 1, 0, 0, 0, 0]
        if hasattr(rig, "gripper"):
            assert seen == [False, True, True, True, True, False, False, False]

    @pytest.mark.parametrize("end", ["q_max", "q_min"])
    def test_no_drive_beyond_the_end_of_the_travel(self, rig_at, end):
        """The potentiometer of joint 1 says that it is 0.1 rad beyond its limit."""
        outwards = 1 if end == "q_max" else -1
        limit = getattr(IR50P, end)[0]
        rig = rig_at([limit - 0.1 * outwards, *REST[1:]])
        nominal = nominal_calibration(IR50P)
        zero = nominal.zero[0] - 0.2 * outwards * nominal.slope[0]
        bench = rig.bench(calibration=JointCalibration(nominal.slope, (zero, *nominal.zero[1:]))).open()
        for k, sample in enumerate(bench.run(0.05)):
            assert outwards * (sample.q[0] - limit) > 0
            sent = bench.drive([100 * outwards, -5, 5] if k < 3 else [-100 * outwards, -5, 5])
            assert sent.tolist() == [0 if k < 3 else -100 * outwards, -5, 5]
            if k < 3:
                assert rig.drive_on_the_arm()[0] == 0

    # ---- cut

    def test_cut_lets_the_run_go_on_without_drive(self, rig):
        bench = rig.bench().open()
        for k, _ in enumerate(bench.run(0.06)):
            if k < 3:
                bench.drive([60, 60, 60])
            elif k == 3:
                bench.cut()
                assert is_off(rig)
        assert is_off(rig)
        assert (bench.recording.u[4:] == 0).all()

    @pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt, "Ctrl-C", GeneratorExit])
    def test_an_error_in_the_body_cuts_at_once(self, rig, error, ctrl_c):
        bench = rig.bench()
        expected = KeyboardInterrupt if error == "Ctrl-C" else error
        with pytest.raises(expected), bench:
            for k, _ in enumerate(bench.run(5)):
                bench.drive([60, -60, 60])
                if k == 5:
                    if error == "Ctrl-C":
                        signal.raise_signal(signal.SIGINT)
                    raise error
        assert is_off(rig)
        refused("is closed", bench.run, 1, error=BenchError)
        assert len(bench.recording) >= 5

    def test_an_error_leaves_the_arm_where_it_is(self, rig_at):
        """No way to the rest pose after a fault: the drive is off, and stays off."""
        rig = rig_at(REST + np.array([0.3, 0.0, 0.1]))
        bench = rig.bench()
        with pytest.raises(RuntimeError), bench:
            for _ in bench.run(1):
                raise RuntimeError
        rig.wait(0.5)
        assert is_off(rig)
        if rig.moves:
            assert abs(rig.q()[0] - 0.3) < 0.05  # joint 1 does not know gravity

    # ---- leaving in order

    def test_leaving_moves_to_the_rest_pose_then_lets_go(self, rig_at):
        rig = rig_at(REST + np.array([0.6, -0.6, 0.6]))
        bench = rig.bench()
        with bench:
            for _ in bench.run(0.05):
                bench.drive([0, 0, 0])
            seen = bench.recording
        assert is_off(rig)
        assert bench.recording is seen  # the way back is not what the student wants to see
        if rig.moves:
            np.testing.assert_allclose(rig.q(), REST, atol=0.15)
            left = rig.q()
            rig.wait(2.0)
            np.testing.assert_allclose(rig.q(), left, atol=0.02)  # it does not sink

    def test_leaving_without_having_run_moves_nothing(self, rig_at):
        rig = rig_at(REST + np.array([0.3, 0.0, 0.0]))
        with rig.bench():
            pass
        assert is_off(rig)
        if rig.moves:
            assert abs(rig.q()[0] - 0.3) < 0.05

    # ---- recording

    def test_the_recording_is_what_was_seen(self, rig):
        bench = rig.bench().open()
        seen, sent = [], []
        for k, sample in enumerate(bench.run(0.3, note="contract", kp="289 225 270")):
            seen.append(sample)
            sent.append(bench.drive([k, -k, 0.4 * k], reference=[0.01 * k, 0, 1]))
        recording, loaded = bench.recording, Recording.load(bench.recording.path)
        for record in (recording, loaded):
            np.testing.assert_allclose(record.t, [s.t for s in seen], atol=1e-6)
            np.testing.assert_allclose(record.q, [s.q for s in seen], atol=1e-6)
            np.testing.assert_allclose(record.counts, [s.counts for s in seen], atol=1e-6)
            np.testing.assert_array_equal(record.u, sent)
            np.testing.assert_allclose(record.reference[:, 0], 0.01 * np.arange(30), atol=1e-9)
            np.testing.assert_array_equal(record.missed, [s.missed for s in seen])
            assert record.header["note"] == "contract"
            assert record.header["arm"] == IR50P.name
            assert float(record.header["period_s"]) == 0.01
            assert record.header["simulated"] == str(bench.simulated).lower()
        assert bench.recording.path.parent == rig.folder

    def test_who_writes_into_a_sample_changes_no_recording(self, rig):
        bench = rig.bench().open()
        seen = []
        for sample in bench.run(0.05, reference=hold(REST)):
            seen.append(sample.q.copy())
            sample.reference[0] -= sample.q
            sample.q[:] = 9.0
            bench.drive([0, 0, 0])
        np.testing.assert_allclose(bench.recording.q, seen, atol=1e-6)
        np.testing.assert_allclose(bench.recording.reference, np.tile(REST, (len(seen), 1)), atol=1e-9)

    def test_a_run_without_recording(self, rig):
        bench = rig.bench().open()
        list(bench.run(0.05, record=False))
        assert bench.recording is None
        assert not list(rig.folder.glob("*.csv"))

    # ---- the loop of the lesson

    def test_follow_is_the_loop_in_one_call(self, rig):
        bench = rig.bench().open()
        pid = PID(**GAINS, limit_pwm=255)
        recording = bench.follow(pid, hold(REST), 0.3)
        assert recording is bench.recording and len(recording) == 30
        np.testing.assert_allclose(recording.reference, np.tile(REST, (30, 1)), atol=1e-9)
        again = PID(**GAINS, limit_pwm=255)
        target = hold(REST)(0.0)
        for t, q, u in zip(recording.t, recording.q, recording.u, strict=True):
            np.testing.assert_allclose(np.rint(again.step(t, q, target)), u, atol=1)

    def test_the_experiment_of_the_lesson_unchanged(self, rig_at, monkeypatch, tmp_path, capsys):
        rig = rig_at(np.zeros(3))
        monkeypatch.setenv("IR50P_RECORDINGS", str(tmp_path / "lesson"))
        monkeypatch.delenv("IR50P_ARM", raising=False)
        monkeypatch.chdir(tmp_path)
        if rig.device() is None:  # a board is plugged in
            plugged_in(monkeypatch, rig.board)
            monkeypatch.delenv("IR50P_BENCH", raising=False)
        else:
            monkeypatch.setenv("IR50P_BENCH", rig.device())
        lesson = {}
        exec(EXPERIMENT, lesson)
        recording = lesson["bench"].recording
        assert len(recording) == 3000
        said = capsys.readouterr().out
        assert said.count("\n") == 2 and "Bench: " in said  # one sentence in two lines, and nothing more
        assert np.abs(lesson["applied_pwm"]).max() <= 255
        if rig.moves:
            np.testing.assert_allclose(recording.q[-500:].mean(axis=0), [1.57, 1.57, -1.05], atol=0.1)
            assert recording.missed[-1] == 0


def plugged_in(monkeypatch, board):
    """Let the computer find this board on a serial port, with a clock of its own."""
    finder = import_module("ir50p_lab.bench.connect")
    monkeypatch.setattr(finder, "list_ports", lambda: [Port("/dev/ttyACM7", "Arduino Mega 2560")])
    monkeypatch.setattr(serial_bench, "open_port", lambda name, baud: board)
    monkeypatch.setattr(serial_bench, "Clock", board)
