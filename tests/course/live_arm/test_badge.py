"""The badge of a view: whose code draws or moves the arm."""

import numpy as np
import solutions
from cells import cell

from ir50p_lab.course import LiveArm, check, my_robot
from ir50p_lab.course.kinematics.frame_walk import arm_by_table
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.live_arm.badge import badge_of
from ir50p_lab.course.start.views import turned_by
from ir50p_lab.modelling import IR50P

STUB = "def frames(q, l):\n    ...\n    return np.array([np.eye(4)] * 4)"
WRITTEN = STUB.replace("    ...\n", "")
DRAWN = "def drawn_by(q):\n    return frames(q, [0.3, 0.2, 0.4])"
FOLLOW = "def follow(p, q_now):\n    poses = my_robot.inverse_kinematics(p, l)\n    return poses[0]"


def test_what_is_not_written_yet_is_not_yours():
    assert badge_of(cell(DRAWN, "drawn_by", {"frames": cell(STUB, "frames")})) == "not written yet"
    assert badge_of(cell(DRAWN, "drawn_by", {"frames": cell(WRITTEN, "frames")})) == "yours"
    stub = cell("def rot_z(angle):\n    return np.array([[..., ..., 0], [..., ..., 0], [0, 0, 1]])", "rot_z")
    view = LiveArm(IR50P, frames=turned_by(IR50P, stub))
    assert view.options["badge"] == "not written yet"
    assert badge_of(turned_by(IR50P, cell(solutions.source("rot_z"), "rot_z"))) == "yours"


def test_what_a_notebook_gives_counts_for_no_badge():
    drawn = cell(DRAWN, "drawn_by", {"frames": frames})
    assert badge_of(drawn) == "the course's" and badge_of(drawn, [frames]) == "yours"
    unwritten = cell(DRAWN, "drawn_by", {"frames": cell(STUB, "frames")})
    assert badge_of(unwritten, [frames]) == "not written yet"


def test_a_table_with_dots_is_not_written_yet_and_rests_on_a_function():
    full = [[0.3, 0, np.pi / 2], [0, 0.2, 0], [0, 0.4, 0]]
    assert badge_of(arm_by_table([[..., 0, 0], *full[1:]], my_robot.dh_matrix)) == "not written yet"
    assert badge_of(arm_by_table(full, my_robot.dh_matrix)) == "the course's"
    for name in ("rot_z", "dh_matrix"):
        check(name, cell(solutions.source(name), name))
    assert badge_of(arm_by_table(full, my_robot.dh_matrix)) == "yours"


def test_a_drag_is_yours_once_its_function_has_passed():
    follow = cell(FOLLOW, "follow", {"my_robot": my_robot, "l": IR50P.l})
    assert badge_of(follow) == badge_of(None) == "the course's"
    for name in ("rot_z", "dh_matrix", "frames", "forward_kinematics", "inverse_kinematics"):
        check(name, cell(solutions.source(name), name))
    assert badge_of(follow) == "yours"
