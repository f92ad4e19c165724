"""The bricks of notebook 01 are turned as the matrices say."""

import numpy as np

from ir50p_lab.course.draw.style import subplots
from ir50p_lab.course.kinematics.pose_views import Brick, space, two_bricks
from ir50p_lab.modelling.pose import rot_x, rot_y, rot_z


def space_axes():
    _, ax = subplots(4, 4, projection="3d")
    space(ax)
    return ax


def test_brick_turns_as_its_matrix():
    edges = (0.8, 0.4, 0.2)
    brick = Brick(space_axes(), edges=edges)
    assert brick.corners.shape == (6, 4, 3)
    np.testing.assert_allclose(np.ptp(brick.corners.reshape(-1, 3), axis=0), edges)
    still = brick.corners.copy()
    for face in still:  # each lies flat, on its side of the middle
        assert sorted(np.ptp(face, axis=0))[0] == 0 and (np.abs(face) == np.array(edges) / 2).all()
    R = rot_z(np.pi / 2) @ rot_x(0.3)
    brick.update(R)
    np.testing.assert_allclose(
        brick.corners.reshape(-1, 3), [R @ corner for corner in still.reshape(-1, 3)], atol=1e-15
    )


def test_two_orders_end_apart():
    space_of = two_bricks(np.pi / 2).axes
    assert len(space_of) == 4 and all(ax.get_xlim() == (-1, 1) for ax in space_of)
    turns = rot_x(np.pi / 2) @ rot_y(np.pi / 2), rot_y(np.pi / 2) @ rot_x(np.pi / 2)
    for ax, R in zip(space_of[1:3], turns, strict=True):
        ends = [np.column_stack(line.get_data_3d())[1] for line in ax.lines[3:6]]  # of the frame, after x, y, z
        np.testing.assert_allclose(np.array(ends).T, 0.55 * R, atol=1e-12)
