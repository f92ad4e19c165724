"""Speed of the simulated bench, recording to disk: `pytest tests/benchmarks --benchmark-enable -s`.

The run is that of the course: 30 s, Tables 4.1-4.3. Targets: 1000x real time compiled, 100x with the loop in Python.
"""

import os
import time

import numpy as np
import pytest

from ir50p_lab.bench import Recording, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold

TARGET = hold([np.pi / 2, np.pi / 2, -np.pi / 3])


def pid():
    return PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255)


def compiled(bench, seconds):
    bench.follow(pid(), TARGET, seconds)


def in_python(bench, seconds):
    """The loop of the lesson, word for word."""
    controller = pid()
    for sample in bench.run(seconds):
        bench.drive(controller.step(sample.t, sample.q, TARGET(sample.t)))


@pytest.mark.parametrize(("run", "seconds", "target"), [(compiled, 30, 1000), (in_python, 5, 100)])
def test_simulated_over_real_seconds(run, seconds, target, tmp_path, request):
    wall = []
    with SimulatedBench(IR50P, seed=1, record_to=tmp_path) as bench:
        run(bench, 1.0)  # compiles
        for _ in range(3):
            began = time.perf_counter()
            run(bench, seconds)
            wall.append(time.perf_counter() - began)
            assert len(Recording.load(bench.recording.path)) == round(seconds / bench.period)
            os.remove(bench.recording.path)
    fastest = seconds / min(wall)
    print(f"\n{run.__name__}: {fastest:.0f}x real time (target {target}x)")
    full = request.config.getoption("benchmark_enable")
    assert fastest > (target if full else target / 10)  # else only a guard: machines of CI are shared
