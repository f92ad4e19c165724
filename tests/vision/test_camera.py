"""One interface, three cameras; the webcam is played by a fake below the driver's edge."""

import cv2
import numpy as np
import pytest

from ir50p_lab.errors import CalibrationError, CameraError, ImageError, InputError
from ir50p_lab.vision import (
    Frame,
    PictureFolder,
    RenderedCamera,
    Webcam,
    calibrate,
    load_image,
    open_camera,
    save_image,
)
from ir50p_lab.vision.camera import picture_folder, webcam
from ir50p_lab.vision.rendering import SceneBall, bench_scene


class FakeCapture:
    """A cv2.VideoCapture without hardware: blue pictures (in its order: blue first) until unplugged."""

    def __init__(self, opened=True, pictures=100, channels=3):
        self.opened, self.left, self.channels, self.asked, self.released = opened, pictures, channels, {}, False

    def isOpened(self):
        return self.opened

    def set(self, what, value):
        self.asked[what] = value

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
        self.released = True


@pytest.fixture(autouse=True)
def _no_webcam(monkeypatch):
    monkeypatch.setattr(cv2, "VideoCapture", lambda index: FakeCapture(opened=False))
    monkeypatch.setattr(webcam, "webcam_present", lambda: False)
    monkeypatch.delenv(webcam.VARIABLE, raising=False)


def plugged_in(monkeypatch, capture):
    """The webcam that this is."""
    monkeypatch.setattr(cv2, "VideoCapture", lambda index: capture)
    return Webcam(0)


@pytest.fixture
def folder(tmp_path):
    for i in (2, 10, 1):
        save_image(tmp_path / f"view{i}.png", np.full((6, 8, 3), i, np.uint8))
    return tmp_path


def test_without_a_webcam_the_bench_is_rendered_and_says_so(capsys):
    with open_camera() as found:
        frame = found.read()
    line = capsys.readouterr().out
    assert line.count("\n") == 1 and "rendered" in line and "no webcam" in line and "open_camera(0)" in line
    assert isinstance(frame, Frame) and frame.simulated and frame.image.shape == (480, 640, 3)
    assert not any("truth" in name for name in vars(frame))


def test_a_webcam_that_answers_is_taken(monkeypatch, capsys):
    monkeypatch.setattr(webcam, "webcam_present", lambda: True)
    monkeypatch.setattr(cv2, "VideoCapture", lambda index: FakeCapture())
    with open_camera() as found:
        frame = found.read()
    assert isinstance(found, Webcam) and not frame.simulated and frame.source == "webcam 0"
    assert (frame.image[0, 0] == (0, 0, 250)).all()  # red, green, blue here
    line = capsys.readouterr().out
    assert "open_camera('rendered')" in line and "webcam 0, 640x480, photographs" in line


def test_a_webcam_that_does_not_answer_gives_way(monkeypatch, capsys):
    monkeypatch.setattr(webcam, "webcam_present", lambda: True)
    for capture, why in ((FakeCapture(opened=False), "no webcam 0"), (FakeCapture(channels=1), "one channel")):
        monkeypatch.setattr(cv2, "VideoCapture", lambda index, it=capture: it)
        with open_camera() as found:
            assert isinstance(found, RenderedCamera)
        assert why in capsys.readouterr().out


@pytest.mark.parametrize("wish", ["rendered", "RENDERED"])
def test_environment_variable(monkeypatch, capsys, wish, folder):
    monkeypatch.setenv(webcam.VARIABLE, wish)
    assert isinstance(open_camera(), RenderedCamera)
    assert f"IR50P_CAMERA={wish}" in capsys.readouterr().out
    monkeypatch.setenv(webcam.VARIABLE, f"folder:{folder}")
    assert isinstance(open_camera(), PictureFolder)
    assert isinstance(open_camera("rendered"), RenderedCamera)  # the argument wins
    monkeypatch.setenv(webcam.VARIABLE, "0")
    with pytest.raises(CameraError, match="no webcam 0"):
        open_camera()


def test_folder(folder, capsys):
    found = open_camera(folder)
    assert [frame.source for frame in found] == ["view1.png", "view2.png", "view10.png"]
    with pytest.raises(CameraError, match="no more than 3 pictures"):
        found.read()
    assert "photographs" in capsys.readouterr().out and found.size == (8, 6)
    one = open_camera(str(folder / "view2.png"))
    assert (one.read().image == 2).all()
    one.close()
    with pytest.raises(CameraError, match="is closed"):
        one.read()


def test_folder_of_rendered_pictures_says_so(tmp_path, capsys):
    save_image(tmp_path / "a.png", np.zeros((6, 8, 3), np.uint8), rendered=True)
    found = open_camera(tmp_path)
    assert found.simulated and found.read().simulated and ", rendered" in capsys.readouterr().out


def test_a_folder_is_opened_without_reading_all_of_it(folder, monkeypatch):
    decoded = []
    monkeypatch.setattr(picture_folder, "load_image", lambda path: decoded.append(path.name) or load_image(path))
    assert not PictureFolder(folder).simulated and decoded == ["view1.png"]


def test_bad_folders_and_files(tmp_path, folder):
    with pytest.raises(ImageError, match="does not exist"):
        open_camera("folder:nowhere")
    (tmp_path / "sub").mkdir()
    with pytest.raises(ImageError, match="no picture"):
        open_camera(tmp_path / "sub")
    (folder / "view2.png").write_bytes(b"\x89PNG\r\n\x1a\nbroken")
    found = open_camera(folder)
    assert found.read().source == "view1.png"
    with pytest.raises(ImageError, match="cut off"):
        found.read()
    assert found.read().source == "view10.png"


def test_a_folder_without_a_usable_picture_is_refused(tmp_path):
    cv2.imwrite(str(tmp_path / "a.png"), np.zeros((6, 8), np.uint8))
    with pytest.raises(ImageError, match="one channel"):
        open_camera(tmp_path)
    (tmp_path / "b.jpg").write_bytes(b"x")
    with pytest.raises(ImageError, match=r"none of the 2 pictures of folder .* one channel"):
        open_camera(tmp_path)


def test_a_broken_file_among_rendered_pictures_makes_no_photographs(tmp_path, capsys):
    for name in "bc":
        save_image(tmp_path / f"{name}.png", np.zeros((6, 8, 3), np.uint8), rendered=True)
    for name, content in (("a.png", b""), ("d.jpg", b"x")):
        (tmp_path / name).write_bytes(content)
    assert open_camera(tmp_path).simulated and "8x6, rendered" in capsys.readouterr().out
    save_image(tmp_path / "e.png", np.zeros((6, 8, 3), np.uint8))
    assert not open_camera(tmp_path).simulated


def test_calibrating_with_a_folder_camera_is_calibrating_with_the_folder(folder):
    """A bad file is left out with its reason; it does not end the calibration."""
    (folder / "view2.png").write_bytes(b"broken")
    said = []
    for images in (folder, open_camera(folder), open_camera(f"folder:{folder}")):
        with pytest.raises(CalibrationError) as why:
            calibrate(images)
        said.append(str(why.value))
    assert "unreadable" in said[0] and len(set(said)) == 1
    with pytest.raises(InputError, match="no last picture"):
        calibrate(RenderedCamera())


def test_unplugged_while_streaming(monkeypatch):
    capture = FakeCapture(pictures=3)
    found = plugged_in(monkeypatch, capture)
    found.read()
    found.read()
    with pytest.raises(CameraError, match=r"unplugged.*open_camera\('rendered'\)"):
        found.read()
    found.close()
    assert capture.released
    with pytest.raises(CameraError, match="closed"):
        found.read()
    found.close()


def test_a_driver_that_only_goes_silent_is_given_up_after_a_while(monkeypatch):
    class Silent(FakeCapture):
        def read(self):
            return (True, np.zeros((4, 4, 3), np.uint8)) if self.left == 100 else (False, None)

        def grab(self):
            self.left -= 1
            return False

    monkeypatch.setattr(webcam, "_PATIENCE", 0.05)
    found = plugged_in(monkeypatch, Silent())
    with pytest.raises(CameraError, match="unplugged"):
        found.read()


def test_a_webcam_without_pictures_or_colour(monkeypatch):
    for capture, error, words in (
        (FakeCapture(pictures=0), CameraError, "shutter"),
        (FakeCapture(channels=1), ImageError, "one channel"),
    ):
        with pytest.raises(error, match=words):
            plugged_in(monkeypatch, capture)
        assert capture.released  # or the next attempt finds it busy


@pytest.mark.parametrize("error", [cv2.error("boom"), OSError("device gone")])
@pytest.mark.parametrize("where", ["read", "grab"])
def test_what_a_driver_raises_is_a_camera_error(monkeypatch, error, where):
    capture = FakeCapture()
    found = plugged_in(monkeypatch, capture)

    def broken():
        raise error

    setattr(capture, where, broken)
    with pytest.raises(CameraError, match=f"stopped .{error}"):
        found.read()


@pytest.mark.parametrize("picture", [np.zeros((4, 5, 2), np.uint8), np.zeros((4, 5, 3), np.uint16)])
def test_raw_pictures_of_a_driver_are_refused(monkeypatch, picture):
    capture = FakeCapture()
    capture.read = lambda: (True, picture)
    with pytest.raises(ImageError, match=f"webcam 0 is no colour picture .{picture.dtype} .*{picture.shape[2]}"):
        plugged_in(monkeypatch, capture)


def test_a_rendered_scene_may_change_between_pictures():
    found = RenderedCamera(bench_scene(), seed=5)
    first = found.read()
    found.scene = bench_scene(SceneBall(position=(0.45, -0.1, 0.03)))
    second = found.read()
    assert (second.image != first.image).any()
    other = RenderedCamera(bench_scene(), seed=5)
    assert (other.read().image == first.image).all()  # reproducible
    found.close()
    with pytest.raises(CameraError, match="closed"):
        found.read()


def test_frames_say_and_keep_what_they_are(tmp_path, monkeypatch):
    frame = RenderedCamera().read()
    assert frame.simulated
    frame.save(tmp_path / "a.png")
    again = open_camera(tmp_path / "a.png").read()
    assert again.simulated and (again.image == frame.image).all()
    photo = plugged_in(monkeypatch, FakeCapture()).read()
    assert not photo.simulated
    photo.save(tmp_path / "b.png")
    assert not open_camera(tmp_path / "b.png").read().simulated


def test_refusals():
    for source in (True, -1, 1.5, []):
        with pytest.raises(ImageError, match="does not exist"):
            open_camera(source)


def test_looking_for_a_webcam_prints_nothing(capfd, monkeypatch):
    monkeypatch.undo()
    with pytest.raises(CameraError, match="webcam 97"):
        Webcam(97)
    assert capfd.readouterr() == ("", "")
