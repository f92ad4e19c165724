"""The 31 functions that a student writes, composed: each alone against the course's, and together as a robot."""

import numpy as np
import pytest
import solutions

from ir50p_lab.controllers import PID
from ir50p_lab.course.robot.arm_numbers import parts
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate

mine = solutions.load()
arm = parts(IR50P)
rigid = IR50P.without_friction()


def poses(count, seed=0):
    return np.random.default_rng(seed).uniform(*arm.limits, (count, 3))


def mass(q):
    return mine.mass_matrix(q, arm.l, arm.m, arm.lc, arm.inertia, arm.rotor)


def weight(q):
    return mine.gravity_torque(q, arm.l, arm.m, arm.lc, arm.g)


def accelerate(q, qd, torque):
    return np.linalg.solve(mass(q), torque - mine.velocity_torque(q, qd, mass) - weight(q))


def test_every_function_of_the_course_has_a_solution():
    assert sorted(solutions.ORDER) == sorted(path.stem for path in solutions.FOLDER.glob("*.py"))
    assert len(solutions.ORDER) == 31


@pytest.mark.parametrize("q", poses(5))
def test_the_way_there_and_back(q):
    p = mine.forward_kinematics(q, arm.l)
    found = mine.inverse_kinematics(p, arm.l)
    assert found.shape == (4, 3)
    for row in found:
        np.testing.assert_allclose(mine.forward_kinematics(row, arm.l), p, atol=1e-12)
    assert np.min(np.max(np.abs(found - q), axis=1)) < 1e-9
    stretched = mine.forward_kinematics([q[0], q[1], 0], arm.l)
    assert len(mine.inverse_kinematics(stretched, arm.l)) == 4
    assert len(mine.inverse_kinematics(1.01 * (stretched - [0, 0, arm.l[0]]) + [0, 0, arm.l[0]], arm.l)) == 0


def test_a_drag_in_small_steps_ends_where_the_formula_says():
    p = np.array([0.42, -0.15, 0.09])
    q = np.array([0.0, 0.3, -0.6])
    for _ in range(30):
        q = mine.damped_step(q, p, arm.l, 0.02)
    np.testing.assert_allclose(q, mine.reach(p, arm.l, q, arm.limits), atol=1e-6)
    assert mine.reach([0, 0, -0.2], arm.l, q, arm.limits) is None


def test_a_frictionless_fall_is_the_courses():
    def f(t, x):
        torque = mine.motor_torque(0, x[3:], arm.gain, arm.damping)
        return np.concatenate([x[3:], accelerate(x[:3], x[3:], torque)])

    _, x = mine.integrate(f, [0, 0.8, -0.8, 0, 0, 0], 1.0, 0.01)
    course = simulate(rigid, duration=1.0, q0=[0, 0.8, -0.8], unit="PWM")
    np.testing.assert_allclose(x[:, :3], course.q, atol=1e-6)


def test_a_pid_loop_is_the_courses():
    gains = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30)}
    controller = mine.PID(**gains)
    target = np.array([0.4, 0.6, -0.5])
    x = np.zeros(6)
    ends = []
    for k in range(100):
        u = controller.step(k * 0.01, x[:3], np.array([target, np.zeros(3), np.zeros(3)]))

        def f(t, x, u=u):
            return np.concatenate([x[3:], accelerate(x[:3], x[3:], mine.motor_torque(u, x[3:], arm.gain, arm.damping))])

        x = mine.rk4_step(f, 0, x, 0.01)
        ends.append(x[:3])
    course = simulate(rigid, PID(**gains, limit_pwm=255), target, duration=1.0)
    np.testing.assert_allclose(ends, course.q[1:], atol=3e-5)
    own = simulate(IR50P, mine.PID(**gains), target, duration=2.0)  # the very class in the course's simulation
    np.testing.assert_allclose(own.q, simulate(IR50P, PID(**gains, limit_pwm=255), target, duration=2.0).q, atol=1e-9)


def picture(K, T_base_cam, ball, radius, size=(480, 640)):
    """A red disc on grey where a camera sees the ball, flat: enough for geometry."""
    X = np.linalg.solve(T_base_cam, np.r_[ball, 1])[:3]
    u, v = (K @ (X / X[2]))[:2]
    rows, columns = np.indices(size)
    rgb = np.full((*size, 3), 120, dtype=np.uint8)
    r = K[0, 0] * radius / X[2]
    rgb[np.hypot(columns - u, rows - v) < r] = (200, 30, 40)
    return rgb, (u, v), r


def test_from_the_picture_to_the_tip():
    K = np.array([[600, 0, 320], [0, 600, 240], [0, 0, 1.0]])
    T_base_cam = np.array([[0, -1, 0, 0.35], [-1, 0, 0, 0.0], [0, 0, -1, 1.0], [0, 0, 0, 1.0]])  # looks straight down
    ball = np.array([0.42, -0.15, 0.03])
    rgb, pixel, radius = picture(K, T_base_cam, ball, 0.03)
    table = np.array([[0.2, -0.2], [0.2, 0.2], [0.5, 0.2], [0.5, -0.2]])
    corners = [picture(K, T_base_cam, np.r_[place, 0.03], 0.03)[1] for place in table]
    place = mine.homography(np.array(corners), table) @ np.r_[pixel, 1]
    np.testing.assert_allclose(place[:2] / place[2], ball[:2], atol=1e-9)
    np.testing.assert_allclose(mine.pixel_to_plane(K, T_base_cam, pixel, 0.03), ball, atol=1e-9)
    seen = {"K": K, "T_base_cam": T_base_cam, "l": arm.l, "limits": arm.limits, "hue": 0.0, "tolerance": 0.3}
    seen |= {"radii": range(round(radius) - 3, round(radius) + 4), "ball_radius": 0.03, "above": 0.06}
    q = mine.find_and_reach(rgb, np.zeros(3), **seen)
    np.testing.assert_allclose(mine.forward_kinematics(q, arm.l), ball + np.array([0, 0, 0.06]), atol=0.003)
    dot = np.full_like(rgb, 120)
    dot[100, 100] = (200, 30, 40)
    assert mine.find_and_reach(dot, np.zeros(3), **seen) is None
