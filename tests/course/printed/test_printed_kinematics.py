"""The printed equations of 1.3 and 1.4: wrong where it says so and nowhere else, judged by independent routes."""

import numpy as np
import pytest
import sympy
from sympy import Matrix, cos, pi, sin

from ir50p_lab.course.printed import kinematics as printed
from ir50p_lab.course.printed.pose import T_1_31, l1, l2, l3, q, q1, q2, q3
from ir50p_lab.modelling import IR50P, THESIS_A, forward_kinematics

rho = l2 * cos(q2) + l3 * cos(q2 + q3)
TIP = Matrix([cos(q1) * rho, sin(q1) * rho, l1 + l2 * sin(q2) + l3 * sin(q2 + q3)])
Q = (0.4, 0.9, -1.3)


def is_zero(expression):
    return sympy.simplify(expression) == sympy.zeros(*expression.shape)


def test_the_printed_tip_and_its_derivatives_repeat_row_1():
    t = T_1_31()[:3, 3]  # (1.45)
    assert t[1] == t[0] and is_zero(Matrix([t[0] - TIP[0], t[2] - TIP[2]]))
    for angle in q:
        assert sympy.simplify((t[1] - TIP[1]).diff(angle)) != 0


def test_matrices_on_the_way_are_no_rotations_or_give_another_axis():
    right = Matrix([[1, 0, 0], [0, cos(pi / 2), -sin(pi / 2)], [0, sin(pi / 2), cos(pi / 2)]])
    wrong = printed.Rot_x_1_51()
    assert [k for k in range(9) if wrong[k] != right[k]] == [7]
    turn = Matrix([[cos(q1), -sin(q1), 0], [sin(q1), cos(q1), 0], [0, 0, 1]])
    product = printed.R_0_2_1_51()
    assert [k for k in range(9) if sympy.simplify(product[k] - (turn * right)[k]) != 0] == [8]
    assert turn * right * printed.z_hat == printed.Z_2_and_Z_3()
    third = printed.R_0_3_1_52()
    assert [k for k in range(9) if sympy.simplify(third[k] - (turn * right)[k]) != 0] == [5]
    assert third * printed.z_hat != printed.Z_2_and_Z_3()


@pytest.mark.parametrize("arm", [IR50P, THESIS_A], ids=lambda arm: arm.name)
def test_literal_inverse_kinematics_finds_front_down_and_no_other_branch(arm):
    rng = np.random.default_rng(0)
    found = rng.uniform([-1.5, -0.5, 0.05], [1.5, 1.0, 1.5], (500, 3))
    radius = arm.l[1] * np.cos(found[:, 1]) + arm.l[2] * np.cos(found[:, 1] + found[:, 2])
    second_side = arm.l[1] + arm.l[2] * np.cos(found[:, 2])
    found = found[(radius > 0.01) & (second_side > 0.01)]
    assert len(found) > 300
    literal = printed.inverse_kinematics_1_60_to_1_73(arm.l, forward_kinematics(arm, found))
    np.testing.assert_allclose(literal, found, atol=1e-6)
    behind = forward_kinematics(arm, found + np.array([np.pi, 0, 0]))
    reached = forward_kinematics(arm, printed.inverse_kinematics_1_60_to_1_73(arm.l, behind))
    assert np.mean(np.linalg.norm(reached - behind, axis=1) > 1e-9) > 0.95
    elbow_up = forward_kinematics(arm, found * np.array([1, 1, -1]))
    assert np.all(printed.inverse_kinematics_1_60_to_1_73(arm.l, elbow_up)[:, 2] > 0)
