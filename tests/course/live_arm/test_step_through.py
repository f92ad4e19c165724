"""A panel of poses stays a picture where nothing runs."""

import base64
import io

import numpy as np
from PIL import Image

from ir50p_lab.course.live_arm.step_through import step_through
from ir50p_lab.modelling import IR50P


def test_a_panel_of_poses_has_the_picture_of_its_arm():
    panel = step_through(IR50P, np.array([[0, 0.5, -1], [0, 0.2, -0.5]]), (0.4, 0.0, 0.1))
    data = panel._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in data
    assert Image.open(io.BytesIO(base64.b64decode(data["image/png"]))).width > 400
