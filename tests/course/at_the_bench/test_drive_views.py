"""Notebook 11: the circle that is asked for, faults that are made on purpose, and a figure that tells where it is from."""

import json
import re
import types
from pathlib import Path

import numpy as np
import pytest

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course.at_the_bench import drive_views as views
from ir50p_lab.course.lab_book.claims import ClaimError, claim
from ir50p_lab.course.robot import my_robot
from ir50p_lab.course.robot.parts import parts
from ir50p_lab.errors import BoardLostError, InputError, LabError, PauseError, RunawayError
from ir50p_lab.modelling import IR50P

CENTRE, RADIUS, SECONDS = np.array([0.42, -0.15, 0.13]), 0.06, 6.5
L, LIMITS = IR50P.l, parts(IR50P).limits
FIRST = my_robot.reach(CENTRE + np.array([RADIUS, 0, 0]), L, rest_pose(IR50P), LIMITS)
last = FIRST


def circle(t, *, phase=1.0, way=1.0, speed=1.0, radius=RADIUS, centre=CENTRE, start=0.0, at=None, rows=3, unit=1.0):
    turned, rate, _ = my_robot.quintic(0.0, 2 * np.pi * phase, SECONDS, t)
    turned = way * turned + start
    place = centre + radius * np.array([np.cos(turned), np.sin(turned), 0])
    q = my_robot.reach(place, L, FIRST, LIMITS)
    J = my_robot.jacobian(my_robot.frames(q if at is None else at, L), 3, place)[:rows]
    v = way * speed * radius * rate * np.array([-np.sin(turned), np.cos(turned), 0])
    return np.array([unit * q, np.linalg.solve(J, v), np.zeros(3)])


def no_quintic(t):
    turned = 2 * np.pi * np.clip(t / SECONDS, 0, 1)
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


NO_ANGLES = {
    "dots": (lambda t: ..., "it gives no angles yet"),
    "nothing": (lambda t: None, "returns nothing"),
    "memory": (remembers, "two answers: it remembers"),
    "six rows": (lambda t: circle(t, rows=6), "LinAlgError"),
    "no zeros": (lambda t: circle(t)[:2], r"\(2, 3\)"),
    "out of reach": (lambda t: circle(t, radius=0.6), r"`reach` gives None .* \[ 0\.48 -0\.15  0\.13\] m"),
    "nothing afterwards": (lambda t: circle(t) if t <= SECONDS else None, "returns nothing"),
    "the centre is moved": (lambda t: CENTRE.__iadd__(0.1), "work on a copy"),
}
NO_CIRCLE = {
    "degrees": (lambda t: circle(t, unit=180 / np.pi), "joints keep their limits"),
    "height": (lambda t: circle(t, centre=CENTRE - [0, 0, 0.1]), r"outwards and upwards .*, 0\.1\] m"),
    "radius": (lambda t: circle(t, radius=0.05), r"outwards and upwards .*\[0\.01, .*\] m"),
    "begins elsewhere": (lambda t: circle(t, start=0.5), "waits at `first`"),
    "half a round": (lambda t: circle(t, phase=0.5), "waits at `first`"),
    "time goes on": (lambda t: circle(t % SECONDS + 0.01 * t), "waits at `first`"),
    "twice round": (lambda t: circle(t, phase=2), "in the end: .*2"),
    "too soon": (lambda t: circle(2 * t), "at half time, .*1, 1"),
    "rate forgotten": (rate_forgotten, "angles change as speeds say"),
    "no quintic": (no_quintic, "waits at rest"),
    "twice as fast": (lambda t: circle(t, speed=2), "angles change as speeds say"),
    "minus": (lambda t: circle(t, speed=-1), "angles change as speeds say"),
    "old pose": (lambda t: circle(t, at=FIRST), "angles change as speeds say"),
}
RIGHT = {"it": circle, "backwards": lambda t: circle(t, way=-1), "list": lambda t: circle(t).tolist()}
NOTEBOOK = json.loads((Path(__file__).parents[3] / "notebooks" / "11_bench_drive.ipynb").read_text(encoding="utf-8"))
CLAIMS = ["".join(cell["source"]) for cell in NOTEBOOK["cells"] if re.fullmatch("drive-07[abc]", cell["id"])]


def in_use(mine):
    return views.circle_in_use(mine, IR50P, CENTRE, RADIUS, FIRST, SECONDS)


@pytest.mark.parametrize("wrong", NO_ANGLES)
def test_what_gives_no_angles_is_told_why_and_the_course_s_stands_in(wrong, capsys):
    mine, said = NO_ANGLES[wrong]
    assert pytest.approx(circle(2.0)) == in_use(mine)(2.0)
    assert re.search(said, capsys.readouterr().out)


def claimed(the_circle):
    """The claims of the notebook on a circle, in its own cells."""
    names = {"np": np, "claim": claim, "my_robot": my_robot, "parts": parts, "arm": IR50P, "the_circle": the_circle}
    names |= {"centre": CENTRE, "radius": RADIUS, "lap": SECONDS, "first": FIRST}
    for source in CLAIMS:
        exec(source, names)


@pytest.mark.parametrize("wrong", NO_CIRCLE)
def test_a_circle_that_is_none_is_told_so_by_the_notebook(wrong, capsys):
    mine, said = NO_CIRCLE[wrong]
    with pytest.raises(ClaimError, match=said):
        claimed(in_use(mine))
    assert "circle: yours" in capsys.readouterr().out


@pytest.mark.parametrize("right", RIGHT)
def test_a_right_circle_is_used(right):
    assert in_use(RIGHT[right]) is RIGHT[right]
    claimed(RIGHT[right])


def test_a_circle_that_no_arm_follows_is_refused_before_it_is_drawn():
    with pytest.raises(InputError, match="39 of its 100 places have no pose; make it"):
        views.circle_in_use(circle, IR50P, CENTRE, 0.2, None, SECONDS)


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
