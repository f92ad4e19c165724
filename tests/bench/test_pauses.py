"""A program that pauses in its loop: what the arm does meanwhile, what is said, and what the recording keeps of it."""

import contextlib
import gc
import os
import subprocess
import sys

import numpy as np
import pytest
from benches import CLOCKED

from ir50p_lab.bench import Recording, protocol
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.errors import BenchError, InputError, PauseError
from ir50p_lab.modelling import IR50P

REST = rest_pose(IR50P)
PUSH = np.array([60.0, 0.0, 0.0])  # of joint 1, which does not know gravity


@pytest.fixture(params=CLOCKED)
def rig(request, tmp_path):
    made = CLOCKED[request.param](tmp_path, REST)
    yield made
    if made.made is not None:
        made.made.abort()


def is_off(rig):
    return (rig.drive_on_the_arm() == 0).all()


@pytest.mark.parametrize("order", ["pause, then drive", "drive, then pause"])
def test_a_long_pause_ends_the_run_and_only_a_new_one_drives(rig, order):
    bench = rig.bench().open()
    with pytest.raises(PauseError, match=r"no command for 2\.\d s, from t = 0\.[12]\d s on.*new run") as caught:
        for k, _ in enumerate(bench.run(10)):
            if k == 20 and order.startswith("pause"):
                rig.pause(2.0)
            bench.drive(PUSH)
            if k == 20 and order.endswith("pause"):
                rig.pause(2.0)
                assert is_off(rig) or not hasattr(rig, "board")  # the simulated arm's time passes when it is asked
    assert isinstance(caught.value, BenchError) and k == 20
    assert is_off(rig)
    with pytest.raises(BenchError, match="only inside"):
        bench.drive(PUSH)
    rig.pause(0.05)
    assert is_off(rig)
    for recording in (bench.recording, Recording.load(bench.recording.path)):
        assert recording.u[-1].tolist() == [0, 0, 0] and recording.t[-1] > 2.0  # measured on waking, driven by nothing
        assert (recording.u[1:20] == PUSH).all()
        ((when, said),) = recording.events
        assert 0.28 < when < 0.32 and "the drive was cut" in said and "the run was ended" in said
        assert recording.header["watchdog_trips"] == "1"
    assert [bench.drive(PUSH)[0] for _ in bench.run(0.05)] == [60] * 5
    assert not is_off(rig)


def test_a_caught_error_does_not_let_the_run_go_on(rig):
    bench = rig.bench().open()
    refused = 0
    with pytest.raises(PauseError):
        for k, _ in enumerate(bench.run(10)):
            if k == 5:
                rig.pause(0.8)
            for _ in range(2):
                try:
                    bench.drive(PUSH)
                except PauseError:
                    refused += 1
    assert refused == 2 and is_off(rig)


def test_short_pauses_are_events_and_the_run_goes_on_in_its_time(rig, capsys):
    bench = rig.bench().open()
    pauses, begun = 0, rig.now()
    for k, _ in enumerate(bench.run(3)):
        assert bench.drive(PUSH).tolist() == PUSH.tolist()
        if k % 5 == 4 and pauses < 8:
            pauses += 1
            rig.pause(0.3)
    assert 2.95 < rig.now() - begun < 3.05
    said = capsys.readouterr().out
    assert said.count("\n") == 1 and "the drive was cut: no command for 0.3" in said
    assert not is_off(rig)
    for recording in (bench.recording, Recording.load(bench.recording.path)):
        assert len(recording.events) == pauses == 8
        assert (recording.header["watchdog_trips"], int(recording.header["late_cycles"]) > 200) == ("8", True)
        late = np.flatnonzero(np.diff(recording.t) > 0.2)
        assert len(late) == 8
        for k, (when, _) in zip(late, recording.events, strict=True):
            assert recording.t[k] < when < recording.t[k + 1]  # the cut, 0.1 s after the last command
            assert when == pytest.approx(recording.t[k] + 0.1, abs=0.012)
            assert recording.u[k : k + 3, 0].tolist() == [60, 0, 60]  # measured first, driven again in the next cycle
        assert (np.diff(recording.t) > 0).all()


def test_a_command_for_another_moment_is_not_sent(rig):
    bench = rig.bench().open()
    for k, _ in enumerate(bench.run(1)):
        if k == 20:
            rig.pause(0.3)
        sent = bench.drive(PUSH)
        assert sent.tolist() == ([0, 0, 0] if k == 20 else PUSH.tolist())
        assert k != 20 or is_off(rig)
    assert len(bench.recording.events) == 1
    assert 29 <= bench.recording.missed[-1] <= 32  # the cycles of the pause are counted


def test_the_first_frame_after_a_pause_asks_for_a_measurement(tmp_path):
    rig = CLOCKED["board in Python"](tmp_path, REST)
    bench = rig.bench().open()
    for k, _ in enumerate(bench.run(1)):
        bench.drive(PUSH)
        if k == 20:
            rig.pause(0.3)
            sent = len(rig.board.commands)
    first, second = (command for _, command in rig.board.commands[sent : sent + 2])
    assert first.type == protocol.STOP and first.pwm == (0, 0, 0)
    assert second.type == protocol.DRIVE and second.pwm == (0, 0, 0)  # measured before the program is asked again


def test_a_first_step_that_compiles_lets_the_run_begin_when_it_is_done(rig):
    bench = rig.bench().open()
    t = []
    for sample in bench.run(1):
        t.append(sample.t)
        if sample.t < 1e-3:
            rig.pause(9.0)
        bench.drive(PUSH)
    assert len(t) >= 98 and t[1] < 0.03
    assert bench.recording.events == [] and bench.recording.header["watchdog_trips"] == "0"
    assert bench.recording.u[0].tolist() == [0, 0, 0] and (bench.recording.u[1:] == PUSH).all()


def test_a_period_longer_than_the_watchdog_allows_is_refused(rig):
    bench = rig.bench(period=0.2).open()
    with pytest.raises(InputError, match=r"give 0\.05 s at most"):
        next(bench.run(1))


@pytest.mark.timing
def test_with_cold_caches_all_is_compiled_before_the_clock_starts(tmp_path):
    """A run whose functions were never compiled on this machine misses nothing: the arm's drive is not cut."""
    program = """
from ir50p_lab.bench import SimulatedBench

with SimulatedBench(realtime=True) as bench:
    for sample in bench.run(0.3):
        bench.drive([0, 0, 0])
print(bench.recording.header["watchdog_trips"])
"""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "IR50P_HOME": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split()[-1] == "0"


def test_a_run_on_a_clock_does_not_wait_for_what_the_notebook_holds(tmp_path):
    """A garbage collection passes them over in a run: of half a million it takes longer than the watchdog allows."""
    bench, heap = CLOCKED["board in Python"](tmp_path, REST).bench().open(), [[] for _ in range(100_000)]
    for end in ("over", "break", "error"):
        with contextlib.suppress(KeyboardInterrupt):
            for k, _ in enumerate(bench.run(0.1)):
                if k == 5:
                    assert gc.get_freeze_count() > len(heap)
                    if end == "break":
                        break
                    if end == "error":
                        raise KeyboardInterrupt
        assert gc.get_freeze_count() == 0
