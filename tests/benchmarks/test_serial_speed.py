"""Speed of SerialBench on a pseudo-terminal: `pytest tests/benchmarks/test_serial_speed.py --benchmark-enable -s`.

The board is the compiled firmware in an emulator, in real time, in a process of its own: it takes about one processor.
Targets on two quiet processors: an exchange 1.5 ms (median), the period at 100 Hz 11 ms (99 %), also with the live
panel open. Without --benchmark-enable the runs are short and the limits are only a guard: machines of CI are shared.
"""

import os
import time

import numpy as np
import pytest

from ir50p_lab.bench import SerialBench, protocol
from ir50p_lab.bench.link import Link
from ir50p_lab.bench.pace import Clock
from ir50p_lab.bench.ports import open_port
from ir50p_lab.controllers import PID
from ir50p_lab.course.at_the_bench.panel import live_panel
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold
from tests.emulator.board_process import BoardProcess


@pytest.fixture(scope="module")
def board(tmp_path_factory):
    with BoardProcess(tmp_path_factory.mktemp("board")) as board:  # opening its port restarts it
        yield board


def tell(what, seconds):
    """Median, 99 % and largest, ms; and whether the machine was quiet."""
    p50, p99, largest = 1e3 * np.quantile(seconds, (0.5, 0.99, 1.0))
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    print(
        f"\n{what}: median {p50:.2f} ms, 99 % {p99:.2f} ms, longest {largest:.2f} ms "
        f"(load {load:.1f} on {os.cpu_count()} processors)"
    )
    return p50, p99


def test_exchange(board, request):
    full = request.config.getoption("benchmark_enable")
    link, times = Link(open_port(board.port, protocol.BAUD), Clock), []
    link.ask(protocol.HELLO, patience=2.0, repeat=0.05)
    for k in range(3000 if full else 100):
        begun = time.perf_counter()
        link.ask(protocol.DRIVE, (k % 200, 0, -(k % 200)), patience=0.5)
        times.append(time.perf_counter() - begun)
    link.close()
    median, _ = tell("exchange at 500 kbaud", times)
    assert median < 1.5 or not full


@pytest.mark.parametrize("hertz", [100, 200])
def test_loop(board, request, hertz):
    """The loop of the lesson with the PID in Python and a recording on disk."""
    full = request.config.getoption("benchmark_enable")
    pid = PID(kp=(1, 1, 1), limit_pwm=255, period=1 / hertz)
    target = hold([0.0, 0.0, 0.0])
    bench = SerialBench(board.port, arm=IR50P, period=1 / hertz, record_to=os.path.dirname(board.port)).open()
    begun = []
    for sample in bench.run(20 if full else 2):
        begun.append(time.perf_counter())
        bench.drive(pid.step(sample.t, sample.q, target(sample.t)))
    statistics, missed = bench.statistics, sample.missed
    bench.abort()
    p50, p99 = tell(f"period at {hertz} Hz, {missed} late of {len(begun)}", np.diff(bench.recording.t))
    tell("  between samples at hand", np.diff(begun))
    print(f"  {statistics}")
    assert len(begun) + missed >= hertz * (20 if full else 2)
    if full:
        assert p50 == pytest.approx(1e3 / hertz, abs=1)
        assert p99 < 1e3 / hertz + (1 if hertz == 100 else 25)


def test_loop_with_the_panel(board, request):
    """The loop in its own process, with the scope drawing 25 frames a second, and a gain that a slider moves."""
    full = request.config.getoption("benchmark_enable")
    bench = SerialBench(board.port, arm=IR50P, record_to=os.path.dirname(board.port)).open()
    panel = live_panel(bench, PID(kp=(40, 40, 40), limit_pwm=255))
    try:
        panel.start()
        for k in range(200 if full else 100):
            panel.set(kp1=40 + k % 50)
            time.sleep(0.1 if full else 0.02)
        statistics = panel.run.statistics()
        assert panel.error is None and panel.run.gains["kp"][0] == 89
        panel.cut()
        board.wait_until_off()
        assert list(bench.run(0.1))  # the port is here again
    finally:
        panel.cut()
        panel.close()
        bench.abort()
    print(f"\nwith the panel: {statistics}")
    assert statistics.cycles + statistics.missed > 150
    if full:
        assert statistics.period_p50 == pytest.approx(0.01, abs=0.001)
        assert statistics.period_p99 < 0.011
