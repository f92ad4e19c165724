"""What the student's functions draw in 00 and 01: right, wrong, and not written yet; what the lab book has of the ball."""

import numpy as np
import pytest

from ir50p_lab.course import lab_book
from ir50p_lab.course.start_views import so_far, turned_by
from ir50p_lab.course.walk_view import arm_by_table, two_views, walk
from ir50p_lab.modelling import IR50P, dh_matrix, forward_kinematics, frames, rot_z


@pytest.fixture
def q():
    return np.random.default_rng().uniform(-1, 1, 3)


def test_the_arm_is_turned_by_the_function_right_or_wrong(q):
    np.testing.assert_allclose(turned_by(IR50P, rot_z)(q), frames(IR50P, q), atol=1e-12)
    backwards = turned_by(IR50P, lambda angle: rot_z(-angle))(q)
    np.testing.assert_allclose(backwards[1:], frames(IR50P, q * [-1, 1, 1])[1:], atol=1e-12)
    unwritten = turned_by(IR50P, lambda angle: np.array([[..., ..., 0], [..., ..., 0], [0, 0, 1]]))(q)
    assert not unwritten[3, :2, 3].any() and unwritten[3, 2, 3] == pytest.approx(forward_kinematics(IR50P, q)[2])


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


def test_two_arms_are_seen_from_above_and_from_the_right(q):
    T = np.array(frames(IR50P, q))
    above, side = two_views({"one": T, "another": T[::-1]}).axes
    np.testing.assert_allclose(above.lines[0].get_xydata(), T[:, [0, 1], 3])
    np.testing.assert_allclose(side.lines[1].get_xydata(), T[::-1][:, [0, 2], 3])


def test_the_way_to_the_ball_is_filled_from_the_lab_book(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    assert [text.get_text() for text in so_far().axes[0].texts] == ["not yet"] * 7
    lab_book.measured("ball.miss.by_hand", 34.2, "mm")
    lab_book.measured("ball.seconds.by_hand", 41, "s")
    lab_book.measured("ball.miss.by_formula", 1e-13, "mm")
    ax = so_far().axes[0]
    said = [text.get_text() for text in ax.texts]
    assert said[0] == "34.2 mm, 41 s" and said[4] == "1e-13 mm" and said.count("not yet") == 5
    by_hand, by_formula = ax.lines[:2]
    np.testing.assert_allclose(by_hand.get_xydata(), [[34.2, 0]])
    np.testing.assert_allclose(by_formula.get_xydata(), [[0.01, 4]])  # the edge of what is drawn
