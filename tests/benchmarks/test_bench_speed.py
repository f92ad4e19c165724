"""Speed of the simulated bench, recording to disk: `pytest tests/benchmarks --benchmark-enable -s`.

The run is that of the course: 30 s, Tables 4.1-4.3. Targets: 1000x real time compiled, 100x with the loop in Python.
"""

import os
import time

import numpy as np

from ir50p_lab.bench import Recording, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold

SECONDS = 30
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


def measure(run, folder, repeats, seconds):
    """Fastest of `repeats` runs, in simulated over real seconds, and over seconds of the processor."""
    wall, processor = [], []
    with SimulatedBench(IR50P, seed=1, record_to=folder) as bench:
        run(bench, 1.0)  # compiles
        for _ in range(repeats):
            began, worked = time.perf_counter(), time.process_time()
            run(bench, seconds)
            wall.append(time.perf_counter() - began)
            processor.append(time.process_time() - worked)
            assert len(Recording.load(bench.recording.path)) == round(seconds / bench.period)
            os.remove(bench.recording.path)
    return seconds / min(wall), seconds / min(processor)


def test_compiled_run(tmp_path, request):
    full = request.config.getoption("benchmark_enable")
    wall, processor = measure(compiled, tmp_path, 20 if full else 3, SECONDS)
    print(f"\nbench, compiled: {wall:.0f}x real time, {processor:.0f}x by processor time (target 1000x)")
    assert wall > (1000 if full else 100)  # without --benchmark-enable only a guard: machines of CI are shared


def test_python_loop(tmp_path, request):
    full = request.config.getoption("benchmark_enable")
    wall, processor = measure(in_python, tmp_path, 5 if full else 1, SECONDS if full else 5)
    print(f"\nbench, loop in Python: {wall:.0f}x real time, {processor:.0f}x by processor time (target 100x)")
    assert wall > (100 if full else 10)
