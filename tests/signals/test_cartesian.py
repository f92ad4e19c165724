"""Paths of the tip: exact in space by the forward kinematics, consistent in time, and refused where they must be."""

import dataclasses
import math

import cloudpickle
import numpy as np
import pytest

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.modelling import IR50P, THESIS_RODS, forward_kinematics, inverse_kinematics
from ir50p_lab.modelling.ik import BRANCHES
from ir50p_lab.signals import cartesian_circle, cartesian_line, path_error

FREE = dataclasses.replace(IR50P, q_min=(-np.inf,) * 3, q_max=(np.inf,) * 3, actuators=None)
START = (0.35, 0, 0.3)


def pose(branch, p=START):
    """A pose (3,) rad of FREE with its tip at p."""
    return inverse_kinematics(FREE, np.array(p))[branch]


PATHS = {
    "line": cartesian_line(IR50P, (0.35, -0.15, 0.3), (0.30, 0.15, 0.25), start_time=0.3),
    "level circle": cartesian_circle(IR50P, START, 0.08),
    "upright circle": cartesian_circle(IR50P, START, 0.06, normal=(-1, 0, 0.2)),
    "round the column": cartesian_circle(FREE, (0, 0, 0.4), 0.3, speed=0.2),
    "elbow down": cartesian_line(FREE, START, (0.4, 0.1, 0.3), near=pose("front/down")),
    "backwards": cartesian_line(FREE, START, (0.4, 0.1, 0.35), near=pose("back/up"), max_joint_speed=9),
    "another arm": cartesian_circle(THESIS_RODS, (1.2, 0, 1.0), 0.3, speed=0.5),
}


@pytest.fixture(params=PATHS.values(), ids=PATHS)
def path(request):
    return request.param


def times(path, n=2001):
    return np.linspace(path.start - 0.2, path.duration + 0.3, n)


def test_joints_follow_the_path_on_one_branch_and_rates_are_derivatives(path):
    t, h = times(path), 1e-3
    rows = path.sample(t)
    np.testing.assert_allclose(forward_kinematics(path.arm, rows[:, 0]), path.tip(t), atol=1e-12)
    other = inverse_kinematics(path.arm, path.tip(t))[path.branch]
    np.testing.assert_allclose(np.cos(rows[:, 0] - other), 1, atol=1e-14)  # the same but for whole turns
    assert np.abs(np.diff(rows[:, 0], axis=0)).max() < 0.2  # and no jumps of a turn
    slope = (path.sample(t + h) - path.sample(t - h)) / (2 * h)
    np.testing.assert_allclose(slope[:, :2], rows[:, 1:], atol=1e-3)
    np.testing.assert_allclose(path(t[700]), rows[700], atol=1e-12)


def test_it_begins_and_ends_at_rest_and_rests_outside(path):
    for t, end in ((path.start, path.q_start), (-5.0, path.q_start), (path.duration + 5, path(path.duration)[0])):
        np.testing.assert_allclose(path(t), [end, 0 * end, 0 * end], atol=1e-3 if t == path.start else 1e-9)


def test_shape_length_and_speed():
    line, circle, upright = (PATHS[name] for name in ("line", "level circle", "upright circle"))
    p = line.tip(np.linspace(0, 20, 99))
    np.testing.assert_allclose(p[[0, -1]], [(0.35, -0.15, 0.3), (0.30, 0.15, 0.25)], atol=1e-12)
    assert np.linalg.matrix_rank(p - p[0], tol=1e-9) == 1
    assert line.duration == pytest.approx(0.3 + np.linalg.norm(p[-1] - p[0]) / 0.05)  # mean speed
    p = circle.tip(np.linspace(0, circle.duration, 9999)) - START
    np.testing.assert_allclose(np.linalg.norm(p, axis=1), 0.08, atol=1e-14)
    np.testing.assert_allclose(p[0], (0.08, 0, 0), atol=1e-12)
    assert p[1000, 1] > 0  # anticlockwise about z
    assert np.linalg.norm(np.diff(p, axis=0), axis=1).sum() == pytest.approx(2 * math.pi * 0.08)
    across = upright.tip(np.linspace(0, upright.duration, 9)) - START
    np.testing.assert_allclose(across @ (-1, 0, 0.2), 0, atol=1e-14)
    turned = PATHS["round the column"]
    np.testing.assert_allclose(turned(turned.duration)[0] - turned.q_start, (2 * math.pi, 0, 0), atol=1e-9)


def test_the_branch_is_that_of_the_pose_to_start_near():
    assert [PATHS[name].branch for name in ("line", "elbow down", "backwards")] == ["front/up", "front/down", "back/up"]


def test_it_is_sent_to_other_processes(path):
    copy = cloudpickle.loads(cloudpickle.dumps(path))
    np.testing.assert_array_equal(copy.sample([0.5]), path.sample([0.5]))


@pytest.mark.parametrize(
    "start, end, options, words",
    [
        ((0.35, 0, 0.3), (0.75, 0, 0.3), {}, "out of reach from"),
        ((0.35, -0.05, 0.05), (0.35, 0.05, -0.01), {}, "tip would be 10 mm under the table"),
        ((0.35, 0, 0.3), (0.35, 0.1, 0.3), {"table": 0.31}, "under the table"),
        ((0.3, 0.1, 0.3), (-0.1, 0.3, 0.3), {}, "joint limits.*" + ".*".join(BRANCHES)),
        ((0.35, 0, 0.285), (0.5715, 0, 0.285), {}, "singular pose"),
        ((0.2, 0.001, 0.6), (-0.2, 0.001, 0.6), {"arm": FREE}, "joint 1 would turn"),
    ],
)
def test_what_the_arm_cannot_do_is_refused(start, end, options, words):
    with pytest.raises(UnreachableError, match=words):
        cartesian_line(options.pop("arm", IR50P), start, end, **options)


def test_too_fast_names_the_speed_that_goes():
    ends = (0.35, -0.15, 0.3), (0.35, 0.15, 0.3)
    with pytest.raises(UnreachableError, match="give a speed of at most") as caught:
        cartesian_line(IR50P, *ends, speed=1.0)
    allowed = float(str(caught.value).split("at most ")[1].split(" m/s")[0])
    path = cartesian_line(IR50P, *ends, speed=allowed)
    assert (np.abs(path.sample(times(path))[:, 1]).max(axis=0) <= 0.5 * IR50P.actuators.no_load_speed).all()


@pytest.mark.parametrize(
    "change",
    [{"speed": 0.0}, {"near": (0, 0)}, {"margin": -0.1}, {"start_time": "now"}, {"centre": (0.3, 0, math.nan)},
     {"radius": 0.0}, {"normal": (0, 0, 0)}],
)  # fmt: skip
def test_bad_input(change):
    with pytest.raises(InputError, match=next(iter(change))):
        cartesian_circle(IR50P, **{"centre": START, "radius": 0.05} | change)
    with pytest.raises(InputError, match="two different points"):
        cartesian_line(IR50P, START, START)


# ---- the error in millimetres


def test_error_of_a_perfect_a_late_and_a_shifted_follower(path):
    t = np.arange(0, path.duration + 1, 0.01)
    assert path_error(path.arm, path.sample(t)[:, 0], path, t=t).tracking_mm.max() < 1e-8
    late = path_error(path.arm, path.sample(t - 0.12)[:, 0], path, t=t)
    off = np.linalg.norm(path.tip(t - 0.12) - path.tip(t), axis=1)
    np.testing.assert_allclose(late.tracking_mm, 1e3 * off, atol=1e-8)
    assert late.rms_mm == pytest.approx(1e3 * np.sqrt(np.mean(off**2)))


def test_bad_records():
    for q, options, words in (
        (np.zeros((5, 3)), {}, "no times"),
        (np.zeros((5, 3)), {"t": np.arange(4.0)}, "do not fit"),
        (np.full((4, 3), np.nan), {"t": np.arange(4.0)}, "finite"),
    ):
        with pytest.raises(InputError, match=words):
            path_error(IR50P, q, PATHS["line"], **options)
