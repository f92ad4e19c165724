"""Notebook 11: the three parts of a miss, faults that are made on purpose, and a figure that tells where it is from."""

import types

import numpy as np
import pytest

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course import my_robot
from ir50p_lab.course.at_the_bench import drive_views as views
from ir50p_lab.course.robot.arm_numbers import parts
from ir50p_lab.errors import BoardLostError, InputError, LabError, PauseError, RunawayError
from ir50p_lab.modelling import IR50P

CENTRE, RADIUS, SECONDS = np.array([0.42, -0.15, 0.13]), 0.06, 6.5
L, LIMITS = IR50P.l, parts(IR50P).limits
FIRST = my_robot.reach(CENTRE + np.array([RADIUS, 0, 0]), L, rest_pose(IR50P), LIMITS)


@pytest.mark.parametrize(("cutoff_hz", "seconds"), [(5, 0.027), (np.inf, 0.0)])
def test_a_filtered_controller_hears_late(cutoff_hz, seconds):
    heard = types.SimpleNamespace(reset=lambda: None, step=lambda t, q, reference: q)
    filtered = views.Filtered(heard, cutoff_hz)
    for _ in range(2):  # reset forgets
        filtered.reset()
        seen = [filtered.step(t, np.full(3, t), None)[0] for t in np.arange(0, 2, 0.01)]
        assert seen[0] == 0 and 1.99 - seen[-1] == pytest.approx(seconds, abs=2e-4)


def broken(fault):
    bench, pid = (
        views.bench_for_faults(fault, record_to=False, realtime=fault == "process"),
        my_robot.PID(2000, 2000, 80),
    )
    q0 = rest_pose(IR50P)
    bench.plant.place(q0)
    with pytest.raises(LabError) as caught, bench:
        for k, sample in enumerate(bench.run(3, lambda t: my_robot.quintic(q0, FIRST, 3, t))):
            if k == 100:
                views.cause_fault(fault, bench)
            bench.drive(pid.step(sample.t, sample.q, sample.reference))
    return caught.value, *views.after_fault(bench)


@pytest.mark.parametrize(
    ("fault", "error", "after"),
    [("motor", RunawayError, 0.7), ("potentiometer", InputError, 0.02), ("cable", BoardLostError, 0.02)],
)
def test_a_fault_ends_the_run_and_the_arm_sinks(fault, error, after):
    raised, seconds, turned, fallen = broken(fault)
    assert isinstance(raised, error) and seconds <= after and fallen > 20
    assert (turned > 10) == (fault == "motor")


@pytest.mark.timing
def test_a_process_that_stops_is_cut():
    raised, seconds, *_ = broken("process")
    assert isinstance(raised, PauseError) and seconds < 1.5


def test_a_real_arm_is_broken_only_where_the_lab_allows_it(monkeypatch, capsys):
    real = views.connect("simulated", record_to=False)
    real.caps = real.caps._replace(faults=())
    monkeypatch.setattr(views, "arm_that_answers", lambda **options: real)
    bench = views.bench_for_faults("motor", record_to=False)
    assert bench is not real and not real.is_open and "Broken on the simulated arm" in capsys.readouterr().out
    real.caps = real.caps._replace(faults=("motor",))
    assert views.bench_for_faults("motor") is real


def test_the_circle_s_figure_says_where_it_is_from():
    run = views.run_simulated(
        IR50P, my_robot.PID(2000, 2000, 80), lambda t: my_robot.quintic(FIRST, FIRST, 1, t), 0.5, q0=FIRST
    )
    tips = np.array([my_robot.forward_kinematics(q, L) for q in run.recording.q])
    figure = views.circle_figure(CENTRE, RADIUS, run.recording, tips[10:], yours=tips[10:])
    assert "simulated arm" in " ".join(text.get_text() for text in figure.texts)
    assert np.array_equal(figure.axes[1].lines[1].get_xdata(), run.recording.t[10:])


@pytest.mark.parametrize("sense", [1, -1])
def test_a_miss_has_three_parts(sense):
    turned = sense * np.linspace(0, 6, 100)
    late = turned - sense * 0.1
    wanted, tip = (CENTRE + RADIUS * np.column_stack([np.cos(a), np.sin(a), 0 * a]) for a in (turned, late))
    parts_of_it = views.three_parts(CENTRE, tip - [0, 0, 0.002], wanted)
    np.testing.assert_allclose(parts_of_it, np.tile([-0.3, 5.99, -2], (100, 1)), atol=0.01)
