"""A board in the hand, as A2 has it: what the camera sees fits where the arm and the camera stand."""

import numpy as np

from ir50p_lab.course.camera.board_in_the_hand import T_HAND_BOARD, board_in_the_hand
from ir50p_lab.modelling import IR50P, frames


def test_what_is_seen_is_where_the_hand_holds_it():
    session = board_in_the_hand(4, noise=0.0, seed=1)
    for q, seen in zip(session.poses, session.T_cam_board, strict=True):
        np.testing.assert_allclose(session.T_base_cam @ seen, frames(IR50P, q)[3] @ T_HAND_BOARD, atol=1e-5)
