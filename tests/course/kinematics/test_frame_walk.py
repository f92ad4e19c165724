"""What the student's functions draw in 01: right, wrong, and not written yet."""

import numpy as np
import pytest

from ir50p_lab.course.kinematics.frame_walk import arm_by_table, walk
from ir50p_lab.modelling import IR50P, dh_matrix, frames


@pytest.fixture
def q():
    return np.random.default_rng().uniform(-1, 1, 3)


def test_the_arm_is_drawn_by_the_table(q):
    l1, l2, l3 = IR50P.l
    table = [[l1, 0, np.pi / 2], [0, l2, 0], [0, l3, -np.pi / 2]]
    np.testing.assert_allclose(arm_by_table(table, dh_matrix)(q), frames(IR50P, q), atol=1e-12)
    assert not arm_by_table([[..., ..., ...]] * 3, dh_matrix)(q)[:, :3, 3].any()


def test_the_walker_names_what_it_does_and_never_what_comes_next():
    figure, go = walk(IR50P, np.ones(3))
    for motions, said in (
        (0.0, "frame 0, at the base"),
        (1.0, "joint 1, motion 1 of 4: turn about z"),
        (1.25, "joint 1, motion 2 of 4: shift along z"),
        (6.0, "joint 2, motion 2 of 4: shift along z"),
        (12.0, "joint 3, motion 4 of 4: turn about x"),
    ):
        asks = go(motions)
        assert figure.axes[0].get_title() == said
        assert bool(asks) == (motions == int(motions))
