"""mass_matrix: right for every arm, also one without motors, and wrong in words."""

import re

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import parts
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.robot.catalogue import task
from ir50p_lab.modelling import IR50P, THESIS_A, THESIS_RODS, mass_matrix

TASK = task("mass_matrix")
ROTORS = "np.diag(np.array(rotor, dtype=float))"
CENTRE = "T[i][:3, 3] + lc[i] * directions[i]"
TENSOR = "J[3:].T @ R @ inertia[i] @ R.T @ J[3:]"


@pytest.mark.parametrize("arm", [IR50P, THESIS_A, THESIS_RODS], ids=lambda arm: arm.name)
def test_it_is_that_of_the_package(arm):
    numbers = parts(arm)
    for q in np.random.default_rng(4).uniform(-2, 2, (20, 3)):
        np.testing.assert_allclose(TASK.right(q, *numbers[:5]), mass_matrix(arm, q), atol=1e-12)


def test_an_arm_without_motors_has_no_rotors_and_no_gain():
    numbers = parts(THESIS_RODS)
    assert not numbers.rotor.any() and not numbers.damping.any() and np.isnan(numbers.gain).all()


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("R @ inertia[i] @ R.T", "inertia[i]", "what does the base see"),
        ("R @ inertia[i] @ R.T", "R.T @ inertia[i] @ R", "turned backwards"),
        ("R = T[i + 1]", "R = T[i]", "the frame before their link"),
        (ROTORS, "np.zeros((3, 3)) + rotor", "into every row"),
        (ROTORS, "np.zeros((3, 3))", "the rotors are left out"),
        (CENTRE, "T[i + 1][:3, 3] + lc[i] * directions[i]", "counted on from the far end"),
        (CENTRE, "T[i + 1][:3, 3] - lc[i] * directions[i]", "counted back from the far end"),
        (CENTRE, "T[i + 1][:3, 3]", "sits at its far end"),
        ("T[0][:3, 2], ", "T[1][:3, 0], ", "swings round the waist"),
        ("i + 1, centre", "3, centre", "what does the elbow do to the upper arm"),
        ("i + 1, centre", "i, centre", "each link lacks its own joint"),
        ("J[:3].T @ J[:3]", "J[:3] @ J[:3].T", "joints on both sides"),
        ("J[:3].T @ J[:3]", "J[:3].T * J[:3]", "entry by entry"),
        ("J[:3].T @ J[:3]", "J.T @ J", "six rows are multiplied by the mass"),
        (TENSOR, f"m[i] * {TENSOR}", "has its kilograms in it already"),
        ("inertia[i] @", "(inertia[i] + m[i] * lc[i] ** 2 * np.eye(3)) @", "has counted it already"),
        ("return M", "return M / 2", "belongs to the energy"),
        ("M = M + m", "M = m", "begin anew"),
        ("R = T[i + 1]", "R = T[3]", "with the inertia of link 1 alone"),
        ("m[i] *", "np.sqrt(m[i]) *", "with the mass of link [12] alone"),
        (ROTORS, "np.diag(rotor[::-1])", "have changed places"),
    ],
)
def test_a_mistake_has_its_sentence(old, new, words):
    text = solutions.source("mass_matrix")
    assert old in text
    wrong = cell(text.replace(old, new), "mass_matrix", {one: task(one).right for one in TASK.leans_on})
    verdict = grade(TASK, wrong)
    assert verdict.state == "wrong" and re.search(words, verdict.says), verdict.says


def test_a_jacobian_by_differences_serves():
    def by_differences(T, link, point):
        return task("jacobian").right(T, link, point) + 4e-6

    mine = cell(
        solutions.source("mass_matrix"), "mass_matrix", {"frames": task("frames").right, "jacobian": by_differences}
    )
    assert grade(TASK, mine).state == "right"
