"""Sweeps: same numbers on any executor, resumable, failures kept apart."""

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate, sweep

SMOOTH = IR50P.without_friction()
TARGET = (1.0, 0.5, -0.7)


def stiffness_error(case):
    """Error at the end of a short run, for a case {'kp': ..., 'payload': ...}."""
    if case["kp"] < 0:
        raise ValueError("negative gain on purpose")
    run = simulate(SMOOTH, PID(kp=(case["kp"],) * 3, kd=(5, 5, 5)), TARGET, duration=0.5)
    return {"error": run.error[-1], "peak": float(np.abs(run.u).max())}


CASES = [{"kp": float(kp), "payload": 0.1} for kp in (20, 30, 40, 50, 60, 70)]


@pytest.fixture(scope="module")
def expected():
    return [{"error": r["error"].tolist(), "peak": r["peak"]} for r in map(stiffness_error, CASES)]


def test_processes_threads_and_dask_give_the_same_numbers(expected):
    from distributed import Client, LocalCluster

    assert sweep(stiffness_error, CASES, progress=False).results == expected
    with ThreadPoolExecutor(2) as threads:
        assert sweep(stiffness_error, CASES, executor=threads, progress=False).results == expected
    with (
        LocalCluster(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        assert sweep(stiffness_error, CASES, executor=client.get_executor(), progress=False).results == expected


def test_functions_defined_in_a_notebook_run_too():
    offset = 3
    assert sweep(lambda case: case + offset, [1, 2], progress=False).results == [4, 5]


def test_failures_are_kept_apart(expected):
    with ThreadPoolExecutor(2) as pool:
        result = sweep(stiffness_error, [CASES[0], {"kp": -1.0, "payload": 0}, CASES[1]], executor=pool, progress=False)
    assert result.results[0] == expected[0] and result.results[1] is None and result.results[2] == expected[1]
    (failure,) = result.failures
    assert failure.index == 1 and failure.case["kp"] == -1 and failure.error == "ValueError: negative gain on purpose"


class Inline:
    """An executor that computes at once in this thread, so that an interrupt comes at a known place."""

    def submit(self, function, *args):
        from concurrent.futures import Future

        future = Future()
        try:
            future.set_result(function(*args))
        except Exception as error:
            future.set_exception(error)
        return future


def test_killed_while_writing_it_still_resumes(tmp_path):
    path = tmp_path / "sweep.jsonl"
    script = (
        "import sys, time; from concurrent.futures import ThreadPoolExecutor; from ir50p_lab.simulation import sweep\n"
        "def f(case):\n    time.sleep(0.01)\n    return case * 2\n"
        f"print(sweep(f, range(300), executor=ThreadPoolExecutor(1), progress=False, save_to={str(path)!r}).results[-1])"
    )
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    while not path.exists() or path.stat().st_size < 500:
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    whole = path.read_bytes()
    path.write_bytes(whole[:-7])  # as if the last line had been cut in the middle
    left = len(path.read_text().splitlines()) - 1
    assert left > 5
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout == "598\n"
    assert len(path.read_text().splitlines()) == 300
    for line in path.read_text().splitlines():
        json.loads(line)


def test_a_file_of_something_else_is_refused(tmp_path):
    path = tmp_path / "notes.txt"
    path.write_text("hello\nworld\n")
    refused(r"notes\.txt, line 1", sweep, stiffness_error, CASES, progress=False, save_to=path, executor=Inline())
    assert path.read_text() == "hello\nworld\n"


def test_cases_and_results_that_cannot_be_saved_are_refused(tmp_path):
    here = {"executor": Inline(), "progress": False}
    refused("cannot be named", sweep, len, [object()], **here)
    refused("cannot be saved", sweep, lambda case: object(), [1], **here, save_to=tmp_path / "x.jsonl")
