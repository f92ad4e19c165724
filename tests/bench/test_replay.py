"""A recording plays the arm: its samples, your command, its end."""

import numpy as np
import pytest

from ir50p_lab.bench import ReplayBench, SimulatedBench
from ir50p_lab.bench.recording import Recording
from ir50p_lab.controllers import PID
from ir50p_lab.errors import RecordingError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold

TARGET = hold([0.4, 0.5, -0.6])


def pid(factor=1.0):
    return PID(kp=np.multiply(factor, (289, 225, 270)), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255)


def drive_all(bench, seconds, controller):
    samples = []
    for sample in bench.run(seconds):
        samples.append(sample)
        bench.drive(controller.step(sample.t, sample.q, TARGET(sample.t)), reference=TARGET(sample.t)[0])
    return samples


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    with SimulatedBench(IR50P, seed=3, record_to=tmp_path_factory.mktemp("recordings")) as bench:
        drive_all(bench, 1.0, pid())
        return bench.recording


def test_samples_are_the_recorded_ones(recording):
    with ReplayBench(recording, arm=IR50P) as bench:
        samples = drive_all(bench, 1.0, pid())
    np.testing.assert_array_equal([s.t for s in samples], recording.t)
    np.testing.assert_array_equal([s.q for s in samples], recording.q)
    np.testing.assert_array_equal([s.counts for s in samples], recording.counts)
    assert bench.simulated and bench.kind == "replay" and bench.period == recording.period


def test_the_same_controller_sends_the_same_again(recording):
    """From the file: its q is rounded to a microradian, which moves few commands by a count."""
    with ReplayBench(recording.path, arm=IR50P) as bench:
        drive_all(bench, 1.0, pid())
    difference = np.abs(bench.recording.u - recording.u)
    assert difference.max() <= 1 and (difference > 0).mean() < 0.02
    np.testing.assert_array_equal(bench.original.u, recording.u)


def test_yours_stands_beside_what_was_sent(recording):
    with ReplayBench(recording, arm=IR50P) as bench:
        drive_all(bench, 1.0, pid(0.5))
    assert np.abs(bench.recording.u - bench.original.u).max() > 10
    assert (bench.recording.u == np.rint(bench.recording.u)).all()
    head = bench.recording.header
    assert head["kind"] == "replay" and head["simulated"] == "true"
    assert head["original"] == str(recording.path)


def test_a_run_ends_with_the_recording_and_says_so(recording, capsys):
    with ReplayBench(recording, arm=IR50P) as bench:
        assert len(drive_all(bench, 30.0, pid())) == 100
        assert capsys.readouterr().out == "The recording ends at t = 0.99 s, and with it this run.\n"
        assert len(bench.recording) == 100
        assert len(drive_all(bench, 0.5, pid())) == 50  # from its beginning again
        assert capsys.readouterr().out == ""


def test_leaving_moves_nothing_and_writes_nothing(recording, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with ReplayBench(recording, arm=IR50P) as bench:
        drive_all(bench, 0.2, pid())
        bench.go_to_rest()
    assert len(bench.recording) == 20 and not list(tmp_path.iterdir())
    with ReplayBench(recording, arm=IR50P, record_to=tmp_path) as bench:
        drive_all(bench, 0.2, pid())
    assert len(Recording.load(next(tmp_path.glob("*replay*.csv")))) == 20


def test_a_file_of_another_program_of_any_rate():
    t = 0.5 + 0.02 * np.arange(50)
    original = Recording.from_arrays(t, np.outer(np.sin(t), [1, 0.5, -0.5]), u=np.zeros((50, 3)))
    with ReplayBench(original, arm=IR50P) as bench:
        samples = drive_all(bench, 1.0, pid())
        assert bench.period == pytest.approx(0.02) and not bench.simulated
    np.testing.assert_array_equal([s.q for s in samples], original.q)
    np.testing.assert_allclose(bench.calibration.radians(np.array([s.counts for s in samples])), original.q)
    assert samples[0].missed == 0 and samples[0].t == 0.5


def test_realtime_keeps_the_recorded_pace(recording, monkeypatch):
    clock = [100.0]
    monkeypatch.setattr("ir50p_lab.bench.replay.time.perf_counter", lambda: clock[0])
    monkeypatch.setattr("ir50p_lab.bench.replay.time.sleep", lambda s: clock.__setitem__(0, clock[0] + s))
    with ReplayBench(recording, arm=IR50P, realtime=True) as bench:
        for sample in bench.run(0.5):
            assert clock[0] - 100.0 == pytest.approx(sample.t)
            clock[0] += 0.003


def test_nothing_to_replay(tmp_path):
    with pytest.raises(RecordingError, match="check the path"):
        ReplayBench(tmp_path / "none.csv")
    with pytest.raises(RecordingError, match="no sample to replay"):
        ReplayBench(Recording.from_arrays([], np.zeros((0, 3))))
