"""What the student's function draws in 00: right, wrong, and not written yet."""

import numpy as np
import pytest

from ir50p_lab.course import LiveArm
from ir50p_lab.course.start.views import turned_by
from ir50p_lab.modelling import IR50P, forward_kinematics, frames, rot_z


@pytest.fixture
def q():
    return np.random.default_rng().uniform(-1, 1, 3)


def test_the_arm_is_turned_by_the_function_right_or_wrong(q):
    np.testing.assert_allclose(turned_by(IR50P, rot_z)(q), frames(IR50P, q), atol=1e-12)
    backwards = turned_by(IR50P, lambda angle: rot_z(-angle))(q)
    np.testing.assert_allclose(backwards[1:], frames(IR50P, q * [-1, 1, 1])[1:], atol=1e-12)
    unwritten = turned_by(IR50P, lambda angle: np.array([[..., ..., 0], [..., ..., 0], [0, 0, 1]]))(q)
    assert not unwritten[3, :2, 3].any() and unwritten[3, 2, 3] == pytest.approx(forward_kinematics(IR50P, q)[2])


@pytest.mark.parametrize(
    "wrong",
    [None, "text", np.eye(2), np.full((3, 3), np.nan), 1.0, [[1, 2], [3]], print, np.eye(4)],
    ids=["nothing", "text", "2 x 2", "nan", "a number", "ragged", "a function", "4 x 4"],
)
def test_a_function_that_gives_no_matrix_is_answered_as_by_check(wrong, capsys):
    def rot_z(angle):
        return wrong

    LiveArm(IR50P, frames=turned_by(IR50P, rot_z))
    assert "rot_z: it returns" in capsys.readouterr().out
