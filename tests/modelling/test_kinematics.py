"""Chain, Jacobian and inverse kinematics: each against another route, and the corrected thesis' numbers."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from arms import mujoco_model, random_arm
from rounding_noise import NOISE
from scipy.spatial.transform import Rotation

from ir50p_lab.errors import InputError, UnreachableError
from ir50p_lab.modelling import (
    IR50P,
    THESIS_A,
    dh_matrix,
    dh_table,
    forward_kinematics,
    frames,
    inverse_kinematics,
    jacobian,
    reachability,
    transform,
)

PI = np.pi
# Source: the thesis' arm (l = 1 m) with its equations corrected, evaluated in full precision.
# pose: q, p, det Jv, IK front/up, front/down, back/up, back/down
# fmt: off
REFERENCE = {
    "home": ((0, 0, 0), (2, 0, 1), 0, [(0, 0, 0), (0, 0, 0), (-PI, PI, 0), (-PI, PI, 0)]),
    "setpoint": ((PI/2, PI/2, -PI/3), (0, 0.866025403784, 2.5), 0.75,
        [(1.5707963268, 1.5707963268, -1.0471975512), (1.5707963268, 0.5235987756, 1.0471975512), (-1.5707963268, 2.617993878, -1.0471975512), (-1.5707963268, 1.5707963268, 1.0471975512)]),
    "elbow_up": ((PI/6, PI/4, -PI/3), (1.448888739434, 0.836516303738, 1.448287736084), 1.448888739434,
        [(0.5235987756, 0.7853981634, -1.0471975512), (0.5235987756, -0.2617993878, 1.0471975512), (-2.617993878, -2.8797932658, -1.0471975512), (-2.617993878, 2.3561944902, 1.0471975512)]),
    "elbow_down": ((-2*PI/3, -PI/12, PI/2), (-0.612372435696, -1.06066017178, 1.707106781187), -1.224744871392,
        [(-2.0943951024, 1.308996939, -1.5707963268), (-2.0943951024, -0.2617993878, 1.5707963268), (1.0471975512, -2.8797932658, -1.5707963268), (1.0471975512, 1.8325957146, 1.5707963268)]),
    "over_shoulder": ((PI/4, 2*PI/3, -PI/4), (-0.170540688701, -0.170540688701, 2.831951230074), -0.170540688701,
        [(-2.3561944902, 1.8325957145, -0.7853981634), (-2.3561944902, 1.0471975512, 0.7853981634), (0.7853981634, 2.0943951024, -0.7853981634), (0.7853981634, 1.308996939, 0.7853981634)]),
}
# fmt: on


def same_angles(found, expected, atol):
    np.testing.assert_allclose(np.exp(1j * np.asarray(found)), np.exp(1j * np.asarray(expected)), atol=atol, rtol=0)


@pytest.mark.parametrize("pose", REFERENCE)
@pytest.mark.parametrize("scale", [1.0, 0.2])
def test_reproduces_the_corrected_thesis_numbers(pose, scale):
    arm = replace(THESIS_A, l=(scale,) * 3, lc=(scale / 2,) * 3)
    q, p, det, branches = REFERENCE[pose]
    np.testing.assert_allclose(forward_kinematics(arm, q), scale * np.array(p), atol=1e-11)
    np.testing.assert_allclose(np.linalg.det(jacobian(arm, q)[:3]), scale**3 * det, atol=1e-11)
    solutions = inverse_kinematics(arm, scale * forward_kinematics(THESIS_A, q))
    for found, expected in zip(solutions, branches, strict=True):
        same_angles(found, expected, atol=1e-7 if pose == "home" else 1e-9)


def edge_and_random_poses(rng, n):
    q = rng.uniform(-PI, PI, (n, 3))
    tenth = n // 10
    q[:tenth, 2] = rng.uniform(-1e-7, 1e-7, tenth)  # stretched
    q[tenth : 2 * tenth, 2] = PI + rng.uniform(-1e-7, 1e-7, tenth)  # folded
    q[:50, 2], q[tenth : tenth + 50, 2] = 0, PI  # exactly so
    q[2 * tenth : 3 * tenth, 1] = PI / 2  # upper arm on the vertical axis
    q[2 * tenth : 2 * tenth + 50, 2] = 0  # tip on the vertical axis
    return q


@pytest.mark.parametrize("arm", [IR50P, THESIS_A], ids=lambda a: a.name)
def test_ik_undoes_fk_on_every_branch(arm):
    q = edge_and_random_poses(np.random.default_rng(0), 100_000)
    p = forward_kinematics(arm, q)
    solutions = inverse_kinematics(arm, p)
    assert np.isfinite(solutions.q).all() and (np.abs(solutions.q) <= PI).all()
    for branch in solutions:
        assert np.abs(forward_kinematics(arm, branch) - p).max() < 1e-12
    # the pose we came from is among the four, where the elbow and the shoulder are not singular
    from_column = arm.l[1] * np.cos(q[:, 1]) + arm.l[2] * np.cos(q[:, 1] + q[:, 2])
    clear = (np.abs(np.sin(q[:, 2])) > 1e-3) & (np.abs(from_column) > 1e-3)
    gap = np.abs(np.exp(1j * solutions.q) - np.exp(1j * q[:, None])).max(axis=-1).min(axis=-1)
    assert clear.sum() > 60_000 and gap[clear].max() < 1e-10


def test_branches_are_what_their_names_say():
    p = np.array([0.3, 0.2, 0.4])
    s = inverse_kinematics(IR50P, p)
    assert s.branches == ("front/up", "front/down", "back/up", "back/down") and len(s) == 4
    for name in s.branches:
        q = s[name]
        facing = np.cos(q[0]) * p[0] + np.sin(q[0]) * p[1]
        assert (facing > 0) == name.startswith("front")
        assert (q[2] <= 0) == name.endswith("up")
    assert (s["back/up"] == s[2]).all() and (s[0] == s.q[0]).all()


def test_frames_against_mujoco_and_closed_form():
    rng = np.random.default_rng(1)
    arm = random_arm(rng)
    model = mujoco_model(arm)
    data = mujoco.MjData(model)
    for q in rng.uniform(-PI, PI, (200, 3)):
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        T = frames(arm, q)
        np.testing.assert_allclose(T[3, :3, 3], data.site("tip").xpos, atol=1e-12)
        np.testing.assert_allclose(forward_kinematics(arm, q), T[3, :3, 3], atol=1e-14)
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        mujoco.mj_jacSite(model, data, Jv, Jw, 0)
        np.testing.assert_allclose(jacobian(arm, q), np.vstack([Jv, Jw]), atol=1e-12)


def test_dh_step_against_scipy_rotations():
    theta, d, a, alpha = 0.4, 0.3, -0.2, 1.1
    expected = np.eye(4)
    expected[:3, :3] = (Rotation.from_euler("z", theta) * Rotation.from_euler("x", alpha)).as_matrix()
    expected[:3, 3] = [a * np.cos(theta), a * np.sin(theta), d]
    np.testing.assert_allclose(dh_matrix(theta, d, a, alpha), expected, atol=1e-15)
    assert dh_matrix(np.zeros(5), 0, 0, 0).shape == (5, 4, 4)


def test_frames_are_the_product_of_the_dh_table():
    q = np.array([0.3, -0.8, 1.9])
    T = np.eye(4)
    for row, expected in zip(dh_table(IR50P, q), frames(IR50P, q)[1:], strict=True):
        T = T @ dh_matrix(*row)
        np.testing.assert_allclose(T, expected, atol=1e-15)


@pytest.mark.parametrize("many", [False, True])
def test_transform_between_any_two_frames(many):
    q = np.random.default_rng(2).uniform(-PI, PI, (4, 3))
    q = q if many else q[0]
    for i in range(4):
        for j in range(4):
            product = transform(IR50P, q, i, j) @ transform(IR50P, q, j, i)
            np.testing.assert_allclose(product, np.broadcast_to(np.eye(4), product.shape), atol=1e-14 + 10 * NOISE)
            via = transform(IR50P, q, i, 2) @ transform(IR50P, q, 2, j)
            np.testing.assert_allclose(transform(IR50P, q, i, j), via, atol=1e-14 + 10 * NOISE)


@pytest.mark.parametrize(
    "p, distance", [((1.0, 0, 0.285), 0.428), ((0, 0, 0.285 + 0.1), 0.072), ((0, 0, 0.285), 0.172)]
)
def test_out_of_reach_says_how_far(p, distance):
    with pytest.raises(UnreachableError) as caught:
        inverse_kinematics(IR50P, p)
    assert caught.value.distance == pytest.approx(distance, abs=1e-12 + 10 * NOISE)
    assert np.linalg.norm(caught.value.nearest - p) == pytest.approx(distance, abs=1e-12 + 10 * NOISE)
    assert reachability(IR50P, caught.value.nearest) < 1e-12 + 10 * NOISE
    assert f"{distance:.3g}" in str(caught.value) and "reaches 0.172 to 0.572 m" in str(caught.value)


def test_many_points_out_of_reach_are_counted_and_the_worst_named():
    with pytest.raises(UnreachableError, match="2 more points") as caught:
        inverse_kinematics(IR50P, [[0.3, 0, 0.3], [1, 0, 0], [2, 0, 0], [3, 0, 0]])
    assert caught.value.distance > 2.4


def test_branches_beyond_the_limits_are_marked():
    assert not inverse_kinematics(IR50P, [-0.3, 0, 0.1]).within_limits.any()
    solutions = inverse_kinematics(IR50P, forward_kinematics(IR50P, [0.5, 0.9, -1.2]))
    np.testing.assert_allclose(solutions.q[solutions.within_limits], [[0.5, 0.9, -1.2]], atol=1e-12)


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: forward_kinematics(IR50P, [0, np.nan, 0]), ["q", "nan", "index 1"]),
        (lambda: frames(IR50P, [0, 0]), ["q", "(2,)"]),
        (lambda: frames(np.zeros((3, 20)), [0, 0, 0]), ["Arm", "ndarray"]),
        (lambda: dh_table(IR50P, np.zeros((2, 3))), ["(2, 3)", "shape (3,)"]),
        (lambda: transform(IR50P, [0, 0, 0], 0, 4), ["frame j = 4", "from 0 to 3"]),
        (lambda: inverse_kinematics(IR50P, [0.3, np.inf, 0]), ["p", "inf"]),
    ],
)
def test_bad_input_gets_a_sentence(call, words):
    with pytest.raises(InputError) as caught:
        call()
    for word in words:
        assert word in str(caught.value)
