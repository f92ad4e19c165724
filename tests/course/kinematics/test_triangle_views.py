"""Pictures of 02 of what the student's own functions find."""

from ir50p_lab.course.kinematics.triangle_views import allowed_map
from ir50p_lab.modelling import IR50P, inverse_kinematics


def test_a_function_that_lists_no_poses_is_answered_by_a_sentence(capsys):
    assert allowed_map(IR50P, lambda p: inverse_kinematics(IR50P, p).q) is not None
    for wrong, words in ((lambda p: None, "lack its `return`"), (lambda p: p["x"], "IndexError")):
        assert allowed_map(IR50P, wrong) is None
        assert words in capsys.readouterr().out
