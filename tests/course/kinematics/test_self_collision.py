"""The forearm through the column: what the maps of 02 mark."""

import numpy as np
import pytest

from ir50p_lab.course.kinematics.self_collision import through_column
from ir50p_lab.modelling import IR50P, inverse_kinematics


@pytest.mark.parametrize("p", [(-0.2, 0.0, 0.03), (-0.05, 0.15, 0.03), (0.02, 0.2, 0.1)])
def test_near_the_column_two_of_four_poses_go_through_it(p):
    """Those of one shape: the elbow on the far side, below the shoulder."""
    answers = inverse_kinematics(IR50P, np.array(p))
    through = [name for name, q in zip(answers.branches, answers, strict=True) if through_column(IR50P, q)]
    assert through == ["front/down", "back/up"]


def test_over_the_column_is_free():
    assert not through_column(IR50P, np.radians([0, 100, -30]))
    assert not any(through_column(IR50P, q) for q in inverse_kinematics(IR50P, np.array([0.42, -0.15, 0.09])))
