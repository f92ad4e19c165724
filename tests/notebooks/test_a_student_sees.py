"""A scripted student goes through the core of 16 to 18 in one home, and the arm goes to what it sees by own code alone."""

import re

import pytest
from test_a_student_fits import gone_through

from ir50p_lab.course.robot.catalogue import NOTEBOOKS, ORDER

#: Of each function: what the student first writes for a part of the solution, and what is said of it.
WRONG = {
    "hue_mask": [
        ("np.angle(np.exp(1j * (angle - hue)))", "angle - hue", "does your circle have a seam"),
        ("np.asarray(rgb, dtype=float)", "rgb", "as bytes"),
        ("<= tolerance", "<= np.radians(tolerance)", "read as degrees"),
    ],
    "circle_votes": [
        ("+ radius", "- radius", "vote outwards"),
        ("votes[y, x]", "votes[x, y]", "an array is [row, column]"),
    ],
    "homography": [
        ("-X * u, -X * v", "X * u, X * v", "the first row of a point have the wrong sign"),
        ("u, v = pixels[k]", "v, u = pixels[k]", "a pixel is (column, row)"),
    ],
    "pixel_to_plane": [
        ("height - camera[2]", "camera[2] - height", "it goes the other way along the line"),
        ("pixel[0], pixel[1]", "pixel[1], pixel[0]", "a pixel is (column, row)"),
        ("(height - ", "(height / 1000 - ", "but at the wrong height"),
    ],
    "find_and_reach": [
        ("best = 0.5", "best = 0", "a red bar is taken for a ball"),
        ("pixel = middle", "pixel = middle[::-1]", "a pixel is column, then row"),
        ("[0, 0, above]", "[0, 0, 0]", "mm off in height"),
    ],
}


@pytest.mark.notebook
def test_a_student_sees_a_ball_and_goes_there(tmp_path):
    before = ORDER[: ORDER.index("hue_mask")]
    said = gone_through("16_images_and_ball", tmp_path, WRONG, first=before)
    assert "my_robot.circle_votes: yours" in said and "at (407, 212), radius 25 px" in said
    said = gone_through("17_camera_calibration", tmp_path, WRONG)
    assert "✓ the worst of the four, mm off" in said and "Kept: camera-1" in said
    said = gone_through("18_vision_guided_reaching", tmp_path, WRONG)
    assert "Your camera-1" in said and "(the course's" not in said
    assert all(f"my_robot.{name}: yours" in said for name in (*NOTEBOOKS["16"], "pixel_to_plane", "computed_torque"))
    assert "✓ worst of ten, off the line" in said
    (miss,) = re.findall(r"ball\.miss\.by_camera: ([\d.]+) mm", said)
    assert float(miss) < 25
