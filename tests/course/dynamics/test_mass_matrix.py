"""mass_matrix: right for every arm, also one without motors, and wrong in words."""

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import parts
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.modelling import IR50P, THESIS_A, THESIS_RODS, mass_matrix

TASK = task("mass_matrix")


@pytest.mark.parametrize("arm", [IR50P, THESIS_A, THESIS_RODS], ids=lambda arm: arm.name)
def test_it_is_that_of_the_package(arm):
    numbers = parts(arm)
    for q in np.random.default_rng(4).uniform(-2, 2, (20, 3)):
        np.testing.assert_allclose(TASK.reference(q, *numbers[:5]), mass_matrix(arm, q), atol=1e-12)


def test_an_arm_without_motors_has_no_rotors_and_no_gain():
    numbers = parts(THESIS_RODS)
    assert not numbers.rotor.any() and not numbers.damping.any() and np.isnan(numbers.gain).all()


def test_a_jacobian_by_differences_serves():
    def by_differences(T, link, point):
        return task("jacobian").reference(T, link, point) + 4e-6

    mine = cell(
        solutions.source("mass_matrix"), "mass_matrix", {"frames": task("frames").reference, "jacobian": by_differences}
    )
    assert grade(TASK, mine).state == "right"
