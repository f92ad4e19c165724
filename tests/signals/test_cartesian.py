"""Paths of the tip: exact in space by the forward kinematics, consistent in time, and refused where they must be."""

import dataclasses
import math
import pickle
import re

import numpy as np
import pytest
from arms import random_arm
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import cumulative_simpson

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.modelling import IR50P, THESIS_RODS, forward_kinematics, inverse_kinematics, jacobian
from ir50p_lab.modelling.ik import BRANCHES
from ir50p_lab.signals import cartesian_circle, cartesian_line, path_error, quintic

FREE = dataclasses.replace(IR50P, q_min=(-np.inf,) * 3, q_max=(np.inf,) * 3, actuators=None)


def solution(p, branch):
    """A pose (3,) rad of FREE with its tip at p."""
    return inverse_kinematics(FREE, np.array(p))[branch]


PATHS = {
    "line": cartesian_line(IR50P, (0.35, -0.15, 0.3), (0.30, 0.15, 0.25), start_time=0.3),
    "short line": cartesian_line(IR50P, (0.35, 0, 0.3), (0.35, 0.004, 0.3)),
    "level circle": cartesian_circle(IR50P, (0.35, 0, 0.3), 0.08, turns=2),
    "upright circle, clockwise": cartesian_circle(
        IR50P, (0.35, 0, 0.3), 0.06, normal=(1, 0, 0.2), turns=-1.25, phase=1
    ),
    "round the column": cartesian_circle(FREE, (0, 0, 0.4), 0.3, turns=3),
    "elbow down": cartesian_line(FREE, (0.35, 0, 0.3), (0.4, 0.1, 0.3), near=solution((0.35, 0, 0.3), "front/down")),
    "backwards": cartesian_line(
        FREE, (0.35, 0, 0.3), (0.4, 0.1, 0.35), near=solution((0.35, 0, 0.3), "back/up"), max_joint_speed=9
    ),
}


@pytest.fixture(params=PATHS.values(), ids=PATHS)
def path(request):
    return request.param


def times(path, n=4001):
    return np.linspace(-0.2, path.duration + 0.3, n)


def test_the_forward_kinematics_leads_back_to_the_path(path):
    t = times(path)
    rows = path.sample(t)
    np.testing.assert_allclose(forward_kinematics(path.arm, rows[:, 0]), path.tip(t), atol=1e-13)
    v = np.einsum("nij,nj->ni", jacobian(path.arm, rows[:, 0])[:, :3], rows[:, 1])
    h = 1e-6
    np.testing.assert_allclose(v, (path.tip(t + h) - path.tip(t - h)) / (2 * h), atol=1e-8)


def test_velocity_and_acceleration_are_derivatives(path):
    t, h = times(path), 1e-5
    behind, here, ahead = (path.sample(t + shift) for shift in (-h, 0, h))
    slope = (ahead - behind) / (2 * h)
    np.testing.assert_allclose(slope[:, 0], here[:, 1], atol=1e-8)
    np.testing.assert_allclose(slope[:, 1], here[:, 2], atol=1e-3)  # the jerk jumps at the ends of the ramps
    assert np.quantile(np.abs(slope[:, 1] - here[:, 2]), 0.99) < 1e-7


def test_integrals_lead_back_to_the_pose(path):
    t = times(path, 20001)
    rows = path.sample(t)
    q = rows[0, 0] + cumulative_simpson(rows[:, 1], x=t, axis=0, initial=0)
    qd = cumulative_simpson(rows[:, 2], x=t, axis=0, initial=0)
    np.testing.assert_allclose(q, rows[:, 0], atol=1e-7)
    np.testing.assert_allclose(qd, rows[:, 1], atol=2e-5)


def test_the_branch_is_that_of_the_pose_to_start_near():
    assert [PATHS[name].branch for name in ("elbow down", "backwards")] == ["front/down", "back/up"]


def test_one_branch_is_kept_and_it_is_that_of_the_inverse_kinematics(path):
    t = times(path, 501)
    q = path.sample(t)[:, 0]
    other = inverse_kinematics(path.arm, path.tip(t))[path.branch]
    np.testing.assert_allclose(np.cos(q - other), 1, atol=1e-14)  # the same but for whole turns
    assert np.abs(np.diff(q, axis=0)).max() < 0.2  # and no jumps of a turn


def test_it_begins_and_ends_at_rest_and_rests_outside(path):
    for t, row in ((-5.0, path.q_start), (path.duration, None), (path.duration + 5, None)):
        q, qd, qdd = path(t)
        assert not qd.any() and not qdd.any()
        if row is not None:
            np.testing.assert_allclose(q, row, atol=1e-14)
    np.testing.assert_allclose(path.tip(path.duration), path.shape(np.array(path.shape.length))[0], atol=1e-15)


def test_one_time_and_many_times_agree(path):
    t = times(path, 21)
    for row, time in zip(path.sample(t), t, strict=True):
        np.testing.assert_allclose(row, path(time), rtol=0, atol=1e-15)
    with pytest.raises(InputError):
        path(math.nan)


def test_speed_and_acceleration_of_the_tip_are_kept_and_reached():
    for speed, acceleration, path in (
        (0.09, 0.3, PATHS["line"]),
        (0.09, 0.3, PATHS["level circle"]),
        (0.2, 0.05, cartesian_circle(FREE, (0.35, 0, 0.3), 0.05, speed=0.2, acceleration=0.05)),
        (0.2, 0.5, cartesian_line(FREE, (0.3, 0.1, 0.3), (0.3, -0.1, 0.3), speed=0.2, acceleration=0.5)),
    ):
        t = np.linspace(0, path.duration, 20001)
        p = path.tip(t)
        v = np.gradient(p, t, axis=0)
        a = np.gradient(v, t, axis=0)[3:-3]
        v, a = np.linalg.norm(v, axis=1).max(), np.linalg.norm(a, axis=1).max()
        assert v <= speed * (1 + 1e-6) and a <= acceleration * (1 + 1e-4)
        assert v > 0.9 * speed or a > 0.9 * acceleration


def test_length_in_time_is_length_in_space():
    line, circle = PATHS["line"], PATHS["level circle"]
    assert line.shape.length == pytest.approx(math.dist((0.35, -0.15, 0.3), (0.30, 0.15, 0.25)))
    t = np.linspace(0, circle.duration, 20001)
    assert np.linalg.norm(np.diff(circle.tip(t), axis=0), axis=1).sum() == pytest.approx(2 * 2 * math.pi * 0.08)
    np.testing.assert_allclose(np.linalg.norm(circle.tip(t) - (0.35, 0, 0.3), axis=1), 0.08, atol=1e-15)
    turned = cartesian_circle(FREE, (0, 0, 0.4), 0.3, turns=1)
    q = turned.sample(np.array([0, turned.duration]))[:, 0]
    np.testing.assert_allclose(q[1] - q[0], (2 * math.pi, 0, 0), atol=1e-12)  # anticlockwise about z, once


@given(st.integers(0, 10**6))
def test_on_random_arms_and_lines(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    q = np.array([rng.uniform(-3, 3), rng.uniform(-0.5, 1.0), rng.choice([-1, 1]) * rng.uniform(0.5, 2.2)])
    start = forward_kinematics(arm, q)
    try:
        path = cartesian_line(
            arm, start, start + rng.normal(0, 0.05, 3) * arm.reach, near=q, table=None, max_joint_speed=20
        )
    except UnreachableError:
        assume(False)
    np.testing.assert_allclose(path.q_start, q, atol=1e-9)  # the branch nearest to where the arm is
    t = times(path, 301)
    rows = path.sample(t)
    np.testing.assert_allclose(forward_kinematics(arm, rows[:, 0]), path.tip(t), atol=1e-12)
    h = 1e-5
    slope = (path.sample(t + h)[:, :2] - path.sample(t - h)[:, :2]) / (2 * h)
    np.testing.assert_allclose(slope[:, 0], rows[:, 1], atol=1e-6)
    np.testing.assert_allclose(slope[:, 1], rows[:, 2], atol=1e-2)
    assert np.abs(rows[:, 1]).max() <= 20


# ---- what is refused


@pytest.mark.parametrize("beyond", [1e-4, 1e-3, 0.01, 0.1, 1.0])
def test_out_of_reach(beyond):
    end = np.array([IR50P.l[1] + IR50P.l[2] + beyond, 0, IR50P.l[0]])
    with pytest.raises(UnreachableError, match="out of reach") as caught:
        cartesian_line(IR50P, (0.35, 0, 0.285), end)
    place = ", ".join(f"{x:.3f}" for x in end)
    assert f"{1e3 * beyond:.3g} mm outside at 100 % of the way (tip at [{place}] m)" in str(caught.value)


@pytest.mark.parametrize("depth", [1e-4, 1e-3, 0.01, 0.1])
def test_under_the_table(depth):
    ends = (0.35, -0.05, 0.05), (0.35, 0.05, -depth)
    with pytest.raises(UnreachableError, match="under the table") as caught:
        cartesian_line(IR50P, *ends)
    assert f"the tip would be {1e3 * depth:.3g} mm" in str(caught.value)
    cartesian_line(IR50P, *ends, table=None)
    cartesian_line(IR50P, *ends, table=-depth)
    with pytest.raises(UnreachableError, match="under the table"):
        cartesian_line(IR50P, (0.35, 0, 0.3), (0.35, 0.1, 0.3), table=0.3 + depth)


def test_the_elbow_stays_above_the_table_too():
    arm = dataclasses.replace(FREE, l=(0.1, 0.2, 0.372))
    with pytest.raises(UnreachableError, match="elbow would be"):
        near = inverse_kinematics(arm, np.array((0.2, 0, 0.05)))["front/down"]
        cartesian_line(arm, (0.2, 0, 0.05), (0.2, 0.05, 0.05), near=near, max_joint_speed=10)


@pytest.mark.parametrize("past", [0.001, 0.01, 0.1, 0.5])
def test_joint_limits(past):
    r, limit = 0.35, IR50P.q_max[0]
    points = [(r * math.cos(q), r * math.sin(q), 0.3) for q in (limit - 0.3, limit + past)]
    with pytest.raises(UnreachableError, match="joint limits") as caught:
        cartesian_line(IR50P, *points, margin=0.0)
    assert all(branch in str(caught.value) for branch in BRANCHES)
    assert f"q1 = {math.degrees(limit + past):.1f} deg at 100 %" in str(caught.value)
    inside = [(r * math.cos(q), r * math.sin(q), 0.3) for q in (limit - 0.3, limit - 0.01)]
    cartesian_line(IR50P, *inside, margin=0.0)
    with pytest.raises(UnreachableError, match="margin"):
        cartesian_line(IR50P, *inside)


@pytest.mark.parametrize("gap", [1e-6, 1e-4, 1e-3])
def test_near_the_stretched_arm_joints_would_race(gap):
    rim = IR50P.l[1] + IR50P.l[2] - gap
    with pytest.raises(UnreachableError, match=r"singular pose \(elbow stretched") as caught:
        cartesian_line(FREE, (0.35, 0, 0.285), (rim, 0, 0.285))
    share, rate = re.search(r"at (\d+) %", str(caught.value)), re.search(r"turn at (\S+) rad/s", str(caught.value))
    assert int(share[1]) > 90 and float(rate[1]) > 2


@pytest.mark.parametrize("gap", [0.0, 1e-3, 0.01])
def test_past_the_axis_of_joint_1_it_would_race(gap):
    with pytest.raises(UnreachableError, match="from the axis of joint 1") as caught:
        cartesian_line(FREE, (0.2, gap, 0.6), (-0.2, gap, 0.6), near=solution((0.2, gap, 0.6), "front/up"))
    assert "at 50 % of the way" in str(caught.value)


def test_too_fast_names_the_speed_that_goes():
    ends = (0.35, -0.15, 0.3), (0.35, 0.15, 0.3)
    with pytest.raises(UnreachableError, match="give a speed of at most") as caught:
        cartesian_line(IR50P, *ends, speed=1.0, acceleration=10)
    allowed = float(str(caught.value).split("at most ")[1].split(" m/s")[0])
    path = cartesian_line(IR50P, *ends, speed=0.95 * allowed, acceleration=10)
    rates = np.abs(path.sample(times(path))[:, 1]).max(axis=0)
    assert (rates <= 0.5 * IR50P.actuators.no_load_speed).all()


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"speed": 0.0}, "speed"),
        ({"speed": -1.0}, "speed"),
        ({"acceleration": math.nan}, "acceleration"),
        ({"near": (0, 0)}, "near"),
        ({"near": (0, math.inf, 0)}, "near"),
        ({"table": math.nan}, "table"),
        ({"margin": -0.1}, "margin"),
        ({"max_joint_speed": 0}, "max_joint_speed"),
        ({"max_joint_speed": (1, 1)}, "max_joint_speed"),
        ({"start_time": "now"}, "start_time"),
        ({"centre": (0.3, 0)}, "centre"),
        ({"centre": (0.3, 0, math.nan)}, "centre"),
        ({"radius": 0.0}, "radius"),
        ({"radius": math.inf}, "radius"),
        ({"normal": (0, 0, 0)}, "normal"),
        ({"turns": 0}, "turns"),
        ({"turns": 1e9}, "turns"),
        ({"phase": "east"}, "phase"),
    ],
)
def test_bad_input(change, match):
    arguments = {"centre": (0.35, 0, 0.3), "radius": 0.05} | change
    with pytest.raises(InputError, match=match):
        cartesian_circle(IR50P, arguments.pop("centre"), arguments.pop("radius"), **arguments)


def test_a_line_needs_two_points():
    with pytest.raises(InputError, match="two different points"):
        cartesian_line(IR50P, (0.3, 0, 0.3), (0.3, 0, 0.3))


def test_frozen_compared_by_value_and_sent_to_other_processes(path):
    with pytest.raises(dataclasses.FrozenInstanceError):
        path.branch = "back/up"
    copy = pickle.loads(pickle.dumps(path))
    assert copy == path and hash(copy) == hash(path)
    np.testing.assert_array_equal(copy.sample([0.5]), path.sample([0.5]))


def test_it_runs_with_an_arm_of_other_lengths():
    path = cartesian_circle(THESIS_RODS, (1.2, 0, 1.0), 0.3, speed=0.5)
    assert path.duration > 0


# ---- the error in millimetres


def test_a_perfect_follower_has_no_error(path):
    t = times(path, 301)
    error = path_error(path.arm, path.sample(t)[:, 0], path, t=t)
    assert error.tracking_mm.max() < 1e-9


def test_a_late_follower_is_as_far_off_as_its_delay_times_the_speed():
    path, late = PATHS["line"], 0.12
    t = np.arange(0, path.duration + 1, 0.01)
    error = path_error(IR50P, path.sample(t - late)[:, 0], path, t=t)
    assert error.tracking_mm.max() == pytest.approx(1e3 * late * 0.09, rel=1e-6)
    assert error.rms_mm == pytest.approx(np.sqrt(np.mean(np.sum((error.tip - path.tip(t)) ** 2, axis=1))) * 1e3)


def test_a_shifted_follower_is_off_the_path():
    path = PATHS["level circle"]
    t = np.arange(0, path.duration, 0.02)
    higher = inverse_kinematics(IR50P, path.tip(t) + np.array([0, 0, 0.005]))["front/up"]
    error = path_error(IR50P, higher, path, t=t)
    np.testing.assert_allclose(error.tracking_mm, 5, atol=1e-9)


def test_joint_references_and_recordings_work_as_well():
    target = quintic((0, 0.3, -1), (0.5, 0.6, -1.2), duration=2)
    t = np.linspace(0, 2, 101)

    class Record:
        q = target.sample(t)[:, 0]

    Record.t = t
    error = path_error(IR50P, Record, target)
    assert error.tracking_mm.max() < 1e-9


def test_bad_records():
    path = PATHS["line"]
    with pytest.raises(InputError, match="no times"):
        path_error(IR50P, np.zeros((5, 3)), path)
    with pytest.raises(InputError, match="do not fit"):
        path_error(IR50P, np.zeros((5, 3)), path, t=np.arange(4.0))
    with pytest.raises(InputError, match="finite"):
        path_error(IR50P, np.full((4, 3), np.nan), path, t=np.arange(4.0))
