"""The camera of the page from the side of Python; `tests/browser/test_page_camera.py` has the page, too."""

import io
import sys
import time
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from refusals import refused

from ir50p_lab.errors import CameraError
from ir50p_lab.vision import camera, open_camera, page_camera

RGB = np.full((480, 640, 3), (200, 30, 40), np.uint8)


def jpeg(rgb):
    Image.fromarray(rgb).save(file := io.BytesIO(), "jpeg", quality=95)
    return file.getvalue()


@pytest.fixture
def page(monkeypatch):
    """A camera and what is said to its page, which is played by the test."""
    found, said = open_camera("page"), []
    monkeypatch.setattr(found._live, "send", said.append)
    found._heard(None, {"shown": True}, [])
    return found, said


def sends(found, at=None, rgb=RGB):
    found._heard(None, {"at": 1000 * (time.time() if at is None else at)}, [jpeg(rgb)])


def test_a_notebook_has_the_page_s_a_script_number_0(monkeypatch, capsys):
    monkeypatch.delenv("IR50P_CAMERA", raising=False)
    monkeypatch.setattr(camera, "Webcam", lambda index, size: SimpleNamespace(name=index, size=size, simulated=False))
    assert open_camera().name == 0
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=1)))
    assert open_camera().name == "the page's camera" and open_camera(1).name == 1
    assert "Camera: the page's camera, 640x480, photographs" in capsys.readouterr().out
    monkeypatch.setenv("IR50P_CAMERA", "2")
    assert open_camera().name == 2


def test_what_the_page_sends_is_read_once(page):
    found, said = page
    assert said == [{"start": True}] and found.image is None
    sends(found)
    frame = found.read()
    assert np.abs(frame.image.astype(int) - RGB).max() < 4 and not frame.simulated
    refused(r"no new picture.*run this cell again", found.read, error=CameraError)


def test_before_the_page_has_answered_the_next_cell_is_named():
    refused("in the next cell", open_camera("page").read, error=CameraError)


def test_why_the_camera_is_off_is_told_until_it_is_on(page):
    found, _ = page
    found._heard(None, {"off": "The browser finds no camera"}, [])
    refused("finds no camera", found.read, error=CameraError)
    sends(found)
    assert found.read().image.shape == RGB.shape


@pytest.mark.parametrize("ahead", [-7200, 0, 7200])
def test_an_old_picture_is_refused_whatever_the_page_s_clock_says(page, ahead):
    found, _ = page
    sends(found, time.time() + ahead)
    found.read()
    sends(found, time.time() + ahead - 20)  # it has waited behind a long cell
    refused("no new picture", found.read, error=CameraError)


def test_circles_are_answered_and_a_function_that_fails_is_told(page):
    found, said = page
    found.each(mine=lambda rgb: (3, 4.5, 2), none=lambda rgb: None, two=lambda rgb: (1, 2), dark=spoil)
    sends(found)
    assert said[-1]["circles"] == [["mine", 3.0, 4.5, 2.0]]
    assert "the circle of two has shape (2,)" in said[-1]["says"] and (found.image > 0).any()
    found.close()
    sends(found)
    assert said[-1] == {"circles": [], "says": ""} and {"start": False} in said


def spoil(rgb):
    rgb[:] = 0


def test_a_picture_is_kept_on_demand_alone(page, monkeypatch):
    found, _ = page
    shown = []
    monkeypatch.setattr(page_camera, "display", shown.append)
    refused("no picture to keep", found.keep, error=CameraError)
    sends(found)
    assert shown == []
    found.keep()
    assert shown[0].alt == "A picture of the page's camera" and Image.open(io.BytesIO(shown[0].data)).size == (640, 480)
