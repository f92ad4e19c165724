"""The transcription of thesis 1.1-1.2: right where it is right, wrong in the way it says."""

import numpy as np
import sympy

from ir50p_lab.course.printed import pose as printed
from ir50p_lab.modelling import THESIS_A, dh_matrix, dh_table, frames, rot_y

Q = (0.3, 0.5, -0.7)
NUMBERS = dict(zip(printed.q, Q, strict=True)) | {printed.l1: 1, printed.l2: 1, printed.l3: 1}
RIGHT = frames(THESIS_A, Q)[3]


def numbers(expression):
    return np.array(sympy.Matrix(expression).subs(NUMBERS), dtype=float)


def test_what_is_right_equals_the_package():
    step = (0.3, 0.1, 0.2, 0.7)
    theta, d, a, alpha = step
    np.testing.assert_allclose(np.array(printed.dh(*step), float), dh_matrix(*step), atol=1e-15)
    np.testing.assert_allclose(np.array(printed.Z(theta, d) * printed.X(a, alpha), float), dh_matrix(*step), atol=1e-15)
    np.testing.assert_allclose(numbers(printed.TABLE_1_1), dh_table(THESIS_A, Q), atol=1e-15)


def test_the_wrong_forms_are_wrong_as_they_say():
    np.testing.assert_allclose(np.array(printed.R_y(0.4), float), rot_y(-0.4), atol=1e-15)
    # One matrix early, but right up to there.
    A = [printed.dh(*row) for row in printed.TABLE_1_1]
    np.testing.assert_allclose(numbers(printed.T_1_11(A, 0, 3)), frames(THESIS_A, Q)[2], atol=1e-15)
    np.testing.assert_allclose(numbers(printed.T_1_31())[[0, 2, 3]], RIGHT[[0, 2, 3]], atol=1e-15)
