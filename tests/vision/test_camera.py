"""One interface, two cameras; the webcam is played by a fake below the driver's edge."""

import cv2
import numpy as np
import pytest
from refusals import refused

from ir50p_lab.errors import CameraError, ImageError
from ir50p_lab.vision import PictureFolder, Webcam, camera, open_camera, save_image


class FakeCapture:
    """A cv2.VideoCapture without hardware: blue pictures (in its order: blue first) until unplugged."""

    def __init__(self, opened=True, pictures=100, channels=3):
        self.opened, self.left, self.channels, self.released = opened, pictures, channels, False

    def isOpened(self):
        return self.opened

    def set(self, what, value):
        pass

    def grab(self):
        return self.left > 0

    def read(self):
        if self.left <= 0:
            self.opened = False
            return False, None
        self.left -= 1
        image = np.zeros((480, 640, self.channels), np.uint8)
        image[..., 0] = 250
        return True, image

    def release(self):
        self.released, self.opened = True, False


@pytest.fixture
def plug_in(monkeypatch):
    """Makes a capture the one that is plugged in; at first there is none."""

    def plug(capture):
        monkeypatch.setattr(cv2, "VideoCapture", lambda index: capture)
        return capture

    monkeypatch.delenv("IR50P_CAMERA", raising=False)
    plug(FakeCapture(opened=False, pictures=0))
    return plug


@pytest.fixture
def folder(tmp_path):
    for i in (2, 10, 1):
        save_image(tmp_path / f"view{i}.png", np.full((6, 8, 3), i, np.uint8))
    return tmp_path


def test_a_webcam_that_answers_is_taken(plug_in, capsys, tmp_path):
    capture = plug_in(FakeCapture())
    with open_camera() as found:
        frame = found.read()
    assert isinstance(found, Webcam) and not frame.simulated and frame.source == "webcam 0"
    assert (frame.image[0, 0] == (0, 0, 250)).all()  # red, green, blue here
    assert capsys.readouterr().out == "Camera: webcam 0, 640x480, photographs\n" and capture.released
    frame.save(tmp_path / "a.png")
    assert not PictureFolder(tmp_path).read().simulated


def test_without_a_webcam_it_says_what_to_do(plug_in):
    refused(r"webcam 0 gives no picture.*plugged in", open_camera, error=CameraError)


def test_environment_variable(plug_in, monkeypatch, folder):
    monkeypatch.setenv("IR50P_CAMERA", f"folder:{folder}")
    assert isinstance(open_camera(), PictureFolder)
    refused("webcam 0", open_camera, 0, error=CameraError)  # the argument wins
    monkeypatch.setenv("IR50P_CAMERA", "rendered")
    refused(r"'rendered'.*folder:PATH", open_camera, error=CameraError)


def test_folder(folder, capsys):
    found = open_camera(f"folder:{folder}")
    frames = [found.read() for _ in range(3)]
    assert [frame.source for frame in frames] == ["view1.png", "view2.png", "view10.png"]
    assert (frames[1].image == 2).all() and not frames[1].simulated
    refused("no more pictures", found.read, error=CameraError)
    assert "8x6, photographs" in capsys.readouterr().out


def test_folder_of_rendered_pictures_says_so(tmp_path, capsys):
    save_image(tmp_path / "a.png", np.zeros((6, 8, 3), np.uint8), rendered=True)
    found = open_camera(f"folder:{tmp_path}")
    assert found.simulated and found.read().simulated and ", rendered" in capsys.readouterr().out


def test_bad_folders(tmp_path):
    refused("does not exist", open_camera, "folder:nowhere", error=ImageError)
    refused("no picture", open_camera, f"folder:{tmp_path}", error=ImageError)


def test_unplugged_while_streaming(plug_in):
    capture = plug_in(FakeCapture(pictures=2))
    found = Webcam(0)
    found.read()
    refused("gives no picture", found.read, error=CameraError)
    found.close()
    found.close()
    assert capture.released


def test_a_driver_that_only_goes_silent_is_given_up_after_a_while(plug_in, monkeypatch):
    capture = plug_in(FakeCapture())
    found = Webcam(0)
    capture.read = lambda: (False, None)
    monkeypatch.setattr(camera, "_PATIENCE", 0.05)
    refused("gives no picture", found.read, error=CameraError)


@pytest.mark.parametrize(("channels", "words"), [(1, "one channel"), (2, "not a colour picture")])
def test_a_webcam_without_colour(plug_in, channels, words):
    capture = plug_in(FakeCapture(channels=channels))
    refused(f"the picture of webcam 0.*{words}", Webcam, 0, error=ImageError)
    assert capture.released  # or the next attempt finds it busy


def test_looking_for_a_webcam_prints_nothing(capfd):
    refused("webcam 97", Webcam, 97, error=CameraError)
    assert capfd.readouterr() == ("", "")
