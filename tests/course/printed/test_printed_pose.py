"""The transcription of thesis 1.1-1.2: right where it is right, wrong in the way it says."""

import numpy as np
import pytest
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


@pytest.mark.parametrize(
    "wrong",
    [
        printed.T_1_11([printed.dh(*row) for row in printed.TABLE_1_1], 0, 3),
        printed.T_1_20(),
        printed.T_1_20(printed.table_read_literally()),
        printed.T_swapped(),
        printed.T_1_30(),
        printed.T_1_30(0),
        printed.T_1_31(),
    ],
)
def test_what_is_wrong_differs_from_the_package(wrong):
    assert np.abs(numbers(wrong) - RIGHT).max() > 0.1


def test_the_wrong_forms_are_wrong_as_they_say():
    np.testing.assert_allclose(np.array(printed.R_y(0.4), float), rot_y(-0.4), atol=1e-15)
    # One matrix early, but right up to there.
    A = [printed.dh(*row) for row in printed.TABLE_1_1]
    np.testing.assert_allclose(numbers(printed.T_1_11(A, 0, 3)), frames(THESIS_A, Q)[2], atol=1e-15)
    # The last link is missing, the swapped product forgets q3, the sign of the last turn spares the tip.
    assert printed.l3 not in printed.T_1_20().free_symbols
    assert printed.q3 not in printed.T_swapped()[:3, 3].free_symbols
    np.testing.assert_allclose(numbers(printed.T_1_30())[:, [0, 3]], RIGHT[:, [0, 3]], atol=1e-15)
    np.testing.assert_allclose(numbers(printed.T_1_30())[:3, 1:3], -RIGHT[:3, 1:3], atol=1e-15)
    assert printed.l1 not in printed.T_1_20(printed.table_read_literally()).free_symbols
    np.testing.assert_allclose(numbers(printed.T_1_31())[[0, 2, 3]], RIGHT[[0, 2, 3]], atol=1e-15)
    assert printed.X_restated(0.2, 0.7) != printed.X(0.2, 0.7)
    assert printed.Z_text(0.3, 0.1) != printed.Z(0.3, 0.1)
