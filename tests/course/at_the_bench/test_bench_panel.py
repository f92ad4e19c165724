"""The live panel without a browser: buttons, sliders, errors, frames, and what is left behind."""

import threading

import numpy as np
import pytest
import solutions
from until import until

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course.at_the_bench.panel import BenchPanel, live_panel
from ir50p_lab.errors import InputError, LabError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold


@pytest.fixture
def bench():
    with SimulatedBench(IR50P, seed=2, record_to=False, q0=(0.2, 0.5, -0.6)) as bench:
        yield bench
        bench.cut()


@pytest.fixture
def panel(bench):
    made = live_panel(bench, PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255))
    yield made
    if made.run is not None:
        made.run.cut()
    made.close()


def test_start_puts_the_set_points_where_the_arm_stands(panel):
    assert panel._stop_button.disabled or panel.run is None
    panel._start_button.click()
    until(lambda: panel.run is not None and panel.scope.frames > 3)
    shown = [panel.controls[f"q{i}"].value for i in (1, 2, 3)]
    np.testing.assert_allclose(shown, np.degrees((0.2, 0.5, -0.6)), atol=2.5)  # noise and the unit's calibration
    until(lambda: panel._start_button.disabled and not panel._stop_button.disabled)
    assert "running" in panel.statistics.value and "median" in panel.statistics.value
    assert panel.status.value == "" and panel.error is None
    panel._cut_button.click()
    assert not panel.run.alive


def test_sliders_reach_the_running_loop(panel):
    panel.start()
    panel.set(kp1=100, kd3=10, q2=20)
    np.testing.assert_array_equal(panel.run.gains["kp"], (100, 225, 270))
    np.testing.assert_array_equal(panel.run.gains["kd"], (40, 30, 10))
    until(lambda: abs(np.degrees(panel.run.recent(0.01).reference[-1][1]) - 20) < 1e-9)
    panel.controls["kp2"].value = 250.0
    np.testing.assert_array_equal(panel.run.gains["kp"], (100, 250, 270))


def test_what_sliders_lead_to_is_said_in_the_status_line(panel):
    panel.start()
    panel.controls["q2"].value = -40.0
    panel.controls["q3"].value = -80.0
    assert "below the table" in panel.status.value and isinstance(panel.error, InputError)
    assert panel.run.alive
    panel.controls["q2"].value = 50.0
    assert panel.status.value == "" and panel.error is None
    with pytest.raises(InputError, match="no slider"):
        panel.set(kp9=1)


def test_starting_twice_is_said_and_harms_nothing(panel):
    panel.start()
    with pytest.raises(LabError, match="runs already"):
        panel.start()
    panel.start(wait=False)
    until(lambda: "runs already" in panel.status.value)
    assert panel.run.alive


def test_an_error_of_the_loop_appears_in_the_status_line(bench):
    def broken(t):
        if t > 0.1:
            raise ZeroDivisionError("a broken reference")
        return np.array([0.2, 0.5, -0.6]), np.zeros(3), np.zeros(3)

    panel = live_panel(bench, PID(kp=100, limit_pwm=255), broken)
    panel.start()
    until(lambda: "a broken reference" in panel.status.value)
    assert not panel.run.alive and isinstance(panel.error, ZeroDivisionError)
    panel.close()


def test_a_cell_that_is_run_again_takes_over_the_loop(panel, bench):
    panel.start()
    panel.set(kp1=123)
    again = live_panel(bench, PID(kp=(289, 225, 270), limit_pwm=255))
    assert again.run is panel.run and again.run.alive
    assert again.controls["kp1"].value == 123
    frames = again.scope.frames
    until(lambda: again.scope.frames > frames + 3)
    assert panel not in BenchPanel.panels and again in BenchPanel.panels
    again.run.cut()
    again.close()


def test_close_leaves_no_thread_and_no_loop(bench):
    before = set(threading.enumerate())
    panel = live_panel(bench, PID(kp=(289, 225, 270), limit_pwm=255))
    panel.start()
    bench.live_run.cut()
    panel.close()
    until(lambda: not set(threading.enumerate()) - before)
    assert not panel.run.alive


def test_a_students_class_is_tuned_where_it_keeps_its_gains(bench):
    mine = solutions.load().PID(kp=289, ki=(50, 10, 50))
    panel = live_panel(bench, mine)
    panel.start()
    panel.set(kp2=300, kd3=10)
    count = panel.run.statistics().cycles
    until(lambda: panel.run.statistics().cycles > count + 5, timeout=60)
    panel.run.cut()
    np.testing.assert_array_equal(panel.run.gains["kp"], (289, 300, 289))
    assert panel.run.error is None
    panel.close()
    recording = bench.follow(mine, hold([0.2, 0.5, -0.6]), 0.1)
    assert recording.header["ki"] == "50 10 50"
