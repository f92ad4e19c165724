"""Notebook 11: the circle that is asked for, faults that are made on purpose, and a figure that tells where it is from."""

import re

import numpy as np
import pytest

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course.at_the_bench import drive_views as views
from ir50p_lab.course.robot import my_robot
from ir50p_lab.course.robot.parts import parts
from ir50p_lab.errors import BoardLostError, InputError, LabError, PauseError, RunawayError
from ir50p_lab.modelling import IR50P

CENTRE, RADIUS, SECONDS = np.array([0.42, -0.15, 0.13]), 0.06, 6.5
L, LIMITS = IR50P.l, parts(IR50P).limits
FIRST = my_robot.reach(CENTRE + np.array([RADIUS, 0, 0]), L, rest_pose(IR50P), LIMITS)
last = FIRST


def circle(t, *, phase=1.0, way=1.0, speed=1.0, radius=RADIUS, start=0.0, at=None, rows=3, unit=1.0):
    turned, rate, _ = my_robot.quintic(0.0, 2 * np.pi * phase, SECONDS, t)
    turned = way * turned + start
    place = CENTRE + radius * np.array([np.cos(turned), np.sin(turned), 0])
    q = my_robot.reach(place, L, FIRST, LIMITS)
    J = my_robot.jacobian(my_robot.frames(q if at is None else at, L), 3, place)[:rows]
    v = way * speed * radius * rate * np.array([-np.sin(turned), np.cos(turned), 0])
    return np.array([unit * q, np.linalg.solve(J, v), np.zeros(3)])


def no_quintic(t):
    turned = 2 * np.pi * t / SECONDS
    place = CENTRE + RADIUS * np.array([np.cos(turned), np.sin(turned), 0])
    q = my_robot.reach(place, L, FIRST, LIMITS)
    J = my_robot.jacobian(my_robot.frames(q, L), 3, place)[:3]
    v = 2 * np.pi / SECONDS * RADIUS * np.array([-np.sin(turned), np.cos(turned), 0])
    return np.array([q, np.linalg.solve(J, v), np.zeros(3)])


def remembers(t):
    global last
    last = 0.999 * circle(t)[0] + 0.001 * last
    return np.array([last, *circle(t)[1:]])


def rate_forgotten(t):
    rows = circle(t)
    rows[1] = rows[1] / max(my_robot.quintic(0.0, 2 * np.pi, SECONDS, t)[1], 1e-9)
    return rows


WRONG = {
    "dots": (lambda t: ..., "it gives no angles yet"),
    "nothing": (lambda t: None, "returns nothing"),
    "begins elsewhere": (lambda t: circle(t, start=0.5), "stands .* rad from where the way ends"),
    "degrees": (lambda t: circle(t, unit=180 / np.pi), "stands .* rad from where the way ends"),
    "radius": (lambda t: circle(t, radius=0.05), "from where the way ends"),
    "half a round": (lambda t: circle(t, phase=0.5), "it is not back"),
    "twice round": (lambda t: circle(t, phase=2), "once round was asked for"),
    "no pose": (lambda t: circle(t, radius=0.5), "`reach` gives None where there is no pose"),
    "memory": (remembers, "two answers: it remembers"),
    "rate forgotten": (rate_forgotten, "not the change of its angles"),
    "twice as fast": (lambda t: circle(t, speed=2), "not the change of its angles"),
    "minus": (lambda t: circle(t, speed=-1), "not the change of its angles"),
    "no quintic": (no_quintic, "of an arm that stands"),
    "old pose": (lambda t: circle(t, at=FIRST), "not the change of its angles"),
    "six rows": (lambda t: circle(t, rows=6), "LinAlgError"),
    "no zeros": (lambda t: circle(t)[:2], r"\(2, 3\)"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_circle_is_answered_and_the_course_s_stands_in(wrong, capsys):
    mine, said = WRONG[wrong]
    used = views.circle_in_use(mine, IR50P, CENTRE, RADIUS, FIRST, SECONDS)
    assert pytest.approx(circle(2.0)) == used(2.0)
    assert re.search(said, capsys.readouterr().out)


@pytest.mark.parametrize("right", [circle, lambda t: circle(t, way=-1), lambda t: circle(t).tolist()])
def test_a_right_circle_is_used(right, capsys):
    assert views.circle_in_use(right, IR50P, CENTRE, RADIUS, FIRST, SECONDS) is right
    assert "circle: yours" in capsys.readouterr().out


def test_a_circle_that_no_arm_follows_is_refused_before_it_is_drawn():
    with pytest.raises(InputError, match="39 of its 100 places have no pose; make it"):
        views.circle_in_use(circle, IR50P, CENTRE, 0.2, None, SECONDS)


def broken(fault):
    bench, pid = views.arm_to_break(fault, record_to=False, realtime=fault == "process"), my_robot.PID(2000, 2000, 80)
    q0 = rest_pose(IR50P)
    bench.plant.place(q0)
    with pytest.raises(LabError) as caught, bench:
        for k, sample in enumerate(bench.run(3, lambda t: my_robot.quintic(q0, FIRST, 3, t))):
            if k == 100:
                views.make(fault, bench)
            bench.drive(pid.step(sample.t, sample.q, sample.reference))
    return caught.value, *views.aftermath(bench)


@pytest.mark.parametrize(
    ("fault", "error", "after"),
    [("motor", RunawayError, 0.7), ("potentiometer", InputError, 0.02), ("cable", BoardLostError, 0.02)],
)
def test_a_fault_ends_the_run_and_the_arm_sinks(fault, error, after):
    raised, seconds, turned, fallen = broken(fault)
    assert isinstance(raised, error) and seconds <= after and fallen > 20
    assert (turned > 10) == (fault == "motor")


def test_a_process_that_stops_is_cut():
    raised, seconds, *_ = broken("process")
    assert isinstance(raised, PauseError) and seconds < 1.5


def test_a_real_arm_is_broken_only_where_the_lab_allows_it(monkeypatch, capsys):
    real = views.connect("simulated", record_to=False)
    real.caps = real.caps._replace(faults=())
    monkeypatch.setattr(views, "arm_that_answers", lambda **options: real)
    bench = views.arm_to_break("motor", record_to=False)
    assert bench is not real and not real.is_open and "Broken on the simulated arm" in capsys.readouterr().out
    real.caps = real.caps._replace(faults=("motor",))
    assert views.arm_to_break("motor") is real


def test_the_circle_s_figure_says_where_it_is_from():
    run = views.simulated(
        IR50P, my_robot.PID(2000, 2000, 80), lambda t: my_robot.quintic(FIRST, FIRST, 1, t), 0.5, q0=FIRST
    )
    tips = np.array([my_robot.forward_kinematics(q, L) for q in run.recording.q])
    figure = views.circle_figure(CENTRE, RADIUS, run.recording, yours=tips[10:])
    assert "simulated arm" in " ".join(text.get_text() for text in figure.texts)
    assert np.array_equal(figure.axes[1].lines[1].get_xdata(), run.recording.t[10:])
