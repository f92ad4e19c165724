"""The loop in the background: gains, set points and stops reach it; nothing that dies leaves the drive on."""

import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from contextlib import contextmanager

import numpy as np
import pytest
from file_bench import FileBench, lines
from refusals import refused
from until import until

from ir50p_lab.bench import SimulatedBench, background, rest
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.controllers import PID
from ir50p_lab.errors import BenchError, PortError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold

GAINS = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30)}


def pid(**changes):
    return PID(**{**GAINS, **changes}, limit_pwm=255)


class Failing:
    """A controller that fails in its fifth step."""

    def __init__(self, error):
        self.error, self.steps = error, 0

    def step(self, t, measured, reference):
        self.steps += 1
        if self.steps == 5:
            raise self.error
        return np.array([10.0, 20.0, 30.0])


@contextmanager
def opened(kind, folder):
    """A bench whose loops run in a thread, or in a process of their own."""
    if kind == "thread":
        made = SimulatedBench(IR50P, seed=3, record_to=folder, q0=(0.1, 0.2, -0.3))
    else:
        made = FileBench(str(folder / "commands.txt"), record_to=str(folder))
    with made:
        yield made
        if made.live_run is not None:
            made.live_run.cut()


KINDS = ["thread", "process"]


@pytest.fixture(params=KINDS)
def bench(request, tmp_path):
    with opened(request.param, tmp_path) as made:
        yield made


@pytest.fixture(scope="module", params=KINDS)
def holding(request, tmp_path_factory):
    """A bench and its loop, which holds the pose: one for all tests that leave it running."""
    with opened(request.param, tmp_path_factory.mktemp("holding")) as bench:
        run = bench.start(pid(), None)
        until(lambda: run.statistics().cycles > 10)
        yield bench, run
        assert run.alive and run.error is None


GOAL = np.array([0.3, 0.3, -0.2])


@pytest.fixture(scope="module", params=KINDS)
def led_in(request, tmp_path_factory):
    """A run that is over: it was led to a goal and held it."""
    with opened(request.param, tmp_path_factory.mktemp("led_in")) as bench:
        run = bench.start(pid(), hold(GOAL))
        until(lambda: run.statistics().cycles > 3)
        assert run.phase == "leading in"
        until(lambda: run.phase == "running" and run.recent(80).t[-1] > 1.4)
        run.cut()
        yield run


class Dozing:
    """A controller that takes 0.25 s for its 20th step."""

    steps = 0

    def step(self, t, measured, reference):
        self.steps += 1
        if self.steps == 20:
            time.sleep(0.25)
        return np.full(3, 20.0)


# ---- the contract, the same in a thread and in a process


def test_it_holds_the_measured_pose_and_leaves_the_caller_free(holding):
    _, run = holding
    assert run.alive and run.phase == "running" and run.error is None
    samples = run.recent(80)
    assert samples.q.shape == samples.u.shape == samples.reference.shape == (len(samples.t), 3)
    assert (np.diff(samples.t) > 0).all() and samples.t[-1] >= 0.099  # late cycles are left out, none is early
    assert (samples.reference[:10] == samples.reference[0]).all()  # the pose of the first sample
    assert np.abs(samples.reference[0] - (0.1, 0.2, -0.3)).max() < 0.05


def test_a_loop_in_the_background_has_the_bench(holding):
    bench, run = holding
    for other in (lambda: bench.run(1), lambda: bench.start(pid(), None)):
        refused(r"stop\(\) or cut\(\)", other, error=BenchError)
    assert run.alive


def test_a_set_point_moves_the_reference_smoothly(holding):
    _, run = holding
    start = run.recent(10).reference[-1]
    run.set_point([start[0], 0.35, start[2]])
    until(lambda: run.recent(0.01).reference[-1][1] == 0.35)
    r = run.recent(80).reference
    np.testing.assert_array_equal(r[-1, [0, 2]], start[[0, 2]])
    assert 0 < np.diff(r[:, 1]).max() < 0.8 * 0.05 and np.diff(r[:, 1]).min() >= -1e-3
    for bad, said in (((0, 3.0, 0), "travel is -50 to 110 deg"), ((0, -0.8, -1.0), "below the table")):
        refused(said, run.set_point, bad)


def test_the_reference_is_led_in_from_where_the_arm_stands(led_in):
    samples = led_in.recent(80)
    r = samples.reference
    np.testing.assert_allclose(r[0], (0.1, 0.2, -0.3), atol=0.05)
    np.testing.assert_allclose(r[-1], GOAL)
    assert (np.abs(np.diff(r, axis=0)).max(axis=1) <= 0.8 * np.diff(samples.t) + 1e-4).all()  # 0.8 rad/s
    way = np.abs(GOAL - r[0]).max() / 0.8 + 0.8 / 3.0  # the trapezoid's time
    assert samples.t[np.argmax((r == GOAL).all(axis=1))] == pytest.approx(way, abs=0.1)


def test_the_recording_is_on_disk_with_gains_and_reference(led_in):
    recording, samples = led_in.recording, led_in.recent(80)
    assert recording.header["controller"] == "PID" and recording.header["kp"] == "289 225 270"
    n = len(samples.t)
    assert n <= len(recording.t) <= n + 1  # the last cycle has found the order to cut
    np.testing.assert_allclose(recording.reference[:n], samples.reference, atol=1e-5)
    np.testing.assert_array_equal(recording.u[:n], samples.u)


def test_after_it_the_bench_is_here_again(bench):
    run = bench.start(pid(), hold(GOAL))
    until(lambda: len(run.recent(80).t) > 3)
    run.cut()
    times = []
    for sample in bench.run(0.05):
        times.append(sample.t)
        bench.drive([0, 0, 0])
    for t in (run.recent(80).t, np.array(times)):
        periods = np.floor(t / 0.01 + 0.01)  # a busy machine leaves some out, none comes twice
        assert periods[0] == 0 and (np.diff(periods) > 0).all()
    assert periods[-1] <= 4  # nor too late
    for _ in bench.run(0.05):
        refused("in a cell", bench.start, pid(), None, error=BenchError)
    bench.abort()


def test_gains_change_without_a_bump_and_not_those_of_the_callers_controller(bench):
    mine = pid()
    run = bench.start(mine, None)
    until(lambda: run.statistics().cycles > 20)
    run.set_gains(kp=(100, 225, 270), kd=20)
    np.testing.assert_array_equal(run.gains["kd"], (20, 20, 20))
    count = run.statistics().cycles
    until(lambda: run.statistics().cycles > count + 10)
    refused(r"ki of joint 1 = -1.*>= 0", run.set_gains, ki=-1)
    run.cut()
    assert not run.alive and run.phase == "ended" and run.join() and run.error is None
    np.testing.assert_array_equal(mine.kp, GAINS["kp"])
    assert not mine.state.any()
    ((_, text),) = run.recording.events  # what was tuned is in the recording
    assert text == "kp = 100 225 270; ki = 50 10 50; kd = 20 20 20"


def test_a_cut_by_a_pause_is_said_with_its_time(bench):
    run = bench.start(Dozing(), None)
    until(lambda: run.statistics().trips and len(run.recent(80).t) > 30)
    bench.cut()
    assert not run.alive
    t, trips = run.recent(80).t, run.recent(80).trips
    when = t[1:][np.diff(trips) > 0][0]
    last = np.argmax(np.diff(t) > 0.2)  # sample before the pause; the cut shows at it or at the next
    assert t[last + 1] - t[last] > 0.2 and when in t[last : last + 2]


def test_an_error_of_the_controller_cuts_and_is_raised_by_join(bench):
    run = bench.start(Failing(ZeroDivisionError("by nothing")), None)
    refused("by nothing", run.join, 10, error=ZeroDivisionError)
    assert isinstance(run.error, ZeroDivisionError) and not run.alive
    assert len(run.recent(10).t) == 4


def test_an_error_of_the_reference_before_the_run_drives_nothing(bench):
    refused("", bench.start, pid(), lambda t: (np.full(3, np.nan), np.zeros(3), np.zeros(3)))
    refused("", bench.start, pid(), lambda t: 1 / 0, error=ZeroDivisionError)
    assert list(bench.run(0.05))  # and the bench is still ours
    bench.abort()


def test_an_error_of_the_reference_in_the_run_cuts_too(bench):
    run = bench.start(pid(), lambda t: (np.full(3, np.nan if t > 0.05 else 0.1), np.zeros(3), np.zeros(3)))
    refused("", run.join, 10)
    assert not run.alive


def test_an_interrupt_while_it_starts_leaves_nothing_driving(bench, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(threading.Event, "wait", lambda event, timeout=None, wait=threading.Event.wait: (
        interrupted() if timeout == background._BEGINS_WITHIN else wait(event, timeout)))  # fmt: skip
    refused("", bench.start, pid(), error=KeyboardInterrupt)
    until(lambda: not bench.live_run.alive, 60)


def test_the_trajectory_to_rest_takes_no_compiling_and_ends_by_the_clock(tmp_path, monkeypatch):
    """Made in the middle of a run, it must be there before the watchdog cuts; cycles left out do not prolong it."""
    with SimulatedBench(IR50P, q0=(0.1, 0.2, -0.3), record_to=tmp_path) as bench:
        run = bench.start(pid())
        until(lambda: run.phase == "running")
        started = time.monotonic()
        run.stop()
        _, trajectory = rest.trajectory_to_rest(IR50P, np.array([0.1, 0.2, -0.3]), bench.period)
        assert time.monotonic() - started < trajectory.duration + 3
        assert run.error is None and np.abs(bench.plant.q_true - rest_pose(IR50P)).max() < 0.15


def test_leaving_the_block_by_an_error_cuts_the_loop(bench):
    with pytest.raises(RuntimeError), bench:
        run = bench.start(pid(), None)
        raise RuntimeError("a cell fails")
    assert not run.alive and run.phase == "ended"


def test_bad_arguments(bench):
    refused("controller", bench.start, None, None)
    refused("reference", bench.start, pid(), [1, 2, 3])
    lock = threading.Lock()

    def with_a_lock(t):
        assert not lock.locked()
        return np.zeros((3, 3))

    refused("cannot be sent", bench.start, pid(), with_a_lock)
    closed = SimulatedBench(IR50P)
    refused("closed", closed.start, pid(), None, error=BenchError)


# ---- in a thread: a simulated arm


def test_stop_goes_to_the_rest_pose_first():
    bench = SimulatedBench(IR50P, seed=0, record_to=False)
    bench.plant = SimulatedBench(IR50P, seed=0, q0=rest_pose(IR50P) + np.array([0.02, -0.05, 0.05])).plant
    with bench:
        run = bench.start(pid(), None)
        until(lambda: run.statistics().cycles > 5)
        run.stop(wait=False)
        until(lambda: run.phase == "moving to the rest pose")
        run.stop()
        assert not run.alive and run.error is None
        assert np.abs(run.recent(0.1).q[-1] - rest_pose(IR50P)).max() < 0.1


# ---- in a process of its own


@pytest.fixture
def commands(tmp_path):
    return str(tmp_path / "commands.txt")


def test_the_loop_is_another_process_with_the_port_and_what_a_notebook_defines(commands):
    gain = 7.0

    class Mine:
        def step(self, t, measured, reference):
            print("what a controller prints harms nobody")
            return gain * np.ones(3)

    with FileBench(commands) as bench:
        run = bench.start(Mine(), lambda t: (np.zeros(3),) * 3)
        assert bench._file is None
        until(lambda: run.statistics().cycles > 3)
        run.cut()
        assert (run.recent(10).u == 7).all()
        child = [pid for _, pid, words in lines(commands) if words[0] == "drive"]
        assert set(child) == {run._process.pid} != {os.getpid()}
        assert lines(commands)[-1][2] == ["cut"]
        refused("no gains", run.set_gains, kp=1)


def test_a_port_that_the_child_cannot_open_is_raised_by_start(commands):
    with FileBench(commands, busy=True) as bench:
        refused("busy", bench.start, pid(), None, error=PortError)
        bench.abort()


def test_a_killed_loop_is_noticed(commands):
    with FileBench(commands) as bench:
        run = bench.start(pid(), None)
        until(lambda: run.statistics().cycles > 3)
        os.kill(run._process.pid, signal.SIGKILL)
        refused("has died", run.join, 10, error=BenchError)
        assert not run.alive


def test_the_last_words_of_a_loop_that_dies_are_told(commands):
    class Dying:
        def step(self, t, measured, reference):
            if t > 0.02:
                os.write(2, b"x" * 3000 + b"Segmentation fault")
                os._exit(3)
            return np.zeros(3)

    with FileBench(commands) as bench:
        run = bench.start(Dying(), lambda t: (np.zeros(3),) * 3)
        refused(r"has died \(exit code 3\).*; it said: x{1482}Segmentation fault$", run.join, 10, error=BenchError)


def test_the_last_words_of_a_loop_that_does_not_begin_are_told(commands, monkeypatch):
    monkeypatch.setattr("ir50p_lab.bench.loop_process.START", "raise SystemExit('no memory')")
    with FileBench(commands) as bench, pytest.raises(BenchError, match=r"has died .*; it said: no memory"):
        bench.start(pid(), None)


def test_a_controller_that_hangs_is_killed_by_cut(commands):
    class Hanging:
        def step(self, t, measured, reference):
            time.sleep(3600 if t > 0.02 else 0)
            return np.ones(3)

    with FileBench(commands) as bench:
        run = bench.start(Hanging(), None)
        until(lambda: run.statistics().cycles >= 2)
        time.sleep(0.05)
        begun = time.monotonic()
        run.cut()
        assert not run.alive and time.monotonic() - begun < 2.0


def test_the_drive_is_cut_when_the_notebook_dies(commands):
    notebook = textwrap.dedent(f"""
        import time
        from file_bench import FileBench
        from ir50p_lab.controllers import PID
        bench = FileBench({commands!r}).open()
        run = bench.start(PID(kp=100, limit_pwm=255), None)
        while run.statistics().cycles < 20:
            time.sleep(0.01)
        print("running", flush=True)
        time.sleep(60)
    """)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen([sys.executable, "-c", notebook], stdout=subprocess.PIPE, env=environment) as parent:
        assert parent.stdout.readline().strip() == b"running"
        killed = time.monotonic()
        parent.kill()
    until(lambda: lines(commands)[-1][2] == ["cut"])
    cut = next(t for t, _, words in lines(commands) if words == ["cut"] and t > killed)
    driven = max(t for t, _, words in lines(commands) if words[0] == "drive")
    assert driven < cut and cut - killed < 0.1


def test_a_loop_in_a_thread_does_not_wait_for_what_the_notebook_holds():
    heap = [[] for _ in range(100_000)]
    with SimulatedBench(record_to=False) as bench:
        run = bench.start(pid())
        until(lambda: run.phase == "running")
        assert gc.get_freeze_count() > len(heap)
        run.cut()
        assert gc.get_freeze_count() == 0
