"""Cameras: a source of frames. A webcam is opened quietly, gives fresh pictures, and says when it is unplugged."""

import contextlib
import os
import tempfile
import time
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import CameraError
from ir50p_lab.vision.image import check_image, save_image

_PATIENCE = 3  # s without a picture: the webcam is unplugged


@dataclass(frozen=True, kw_only=True, eq=False)
class Frame:
    """One picture: image (h, w, 3) uint8, red green blue; simulated: rendered, not photographed; source: its camera."""

    image: np.ndarray
    simulated: bool
    source: str

    def save(self, path):
        """Write the picture to a file; a rendered one carries a mark (PNG and JPEG). Raises ImageError."""
        save_image(path, self.image, rendered=self.simulated)


class Camera:
    """A source of pictures: `with open_camera(0) as camera: frame = camera.read()`. Attributes: name, simulated, size."""

    name, simulated, size = "camera", False, (0, 0)

    def close(self):
        """Let go of the camera: no more pictures; twice does no harm."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Webcam(Camera):
    """A webcam by its number, 0 for the first; size: (width, height) asked for, the camera may give another."""

    def __init__(self, index=0, *, size=(640, 480)):
        import cv2

        self.name = f"webcam {index}"
        with _quiet():
            self._capture = cv2.VideoCapture(index)
        for what, value in ((cv2.CAP_PROP_FRAME_WIDTH, size[0]), (cv2.CAP_PROP_FRAME_HEIGHT, size[1])):
            self._capture.set(what, value)
        self._capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)
        try:
            self.size = self.read().image.shape[1::-1]
        except CameraError:
            self.close()  # or the next attempt finds it busy
            raise

    def read(self):
        """The next Frame, not one that was waiting. Raises CameraError if there is none, or it is busy or unplugged."""
        began = time.monotonic()
        for _ in range(5):  # one that waited comes at once; one that is being taken makes grab() wait for it
            asked = time.monotonic()
            if not self._capture.grab() or time.monotonic() - asked > 0.005:
                break
        while time.monotonic() - began < _PATIENCE and self._capture.isOpened():
            ok, image = self._capture.read()
            if ok and image is not None and image.size:
                image = check_image(np.ascontiguousarray(image[..., 2::-1]), f"the picture of {self.name}")
                return Frame(image=image, simulated=False, source=self.name)
            time.sleep(0.01)
        raise CameraError(
            f"{self.name} gives no picture: is it plugged in, its shutter open, closed in every other program, and not "
            "closed here (camera.close() before you open it again)?"
        )

    def close(self):
        """Let go of the webcam, so that other programs can have it."""
        self._capture.release()


def open_camera(index=0, *, size=(640, 480)):
    """Open a webcam and say in one line which: Webcam. Raises CameraError if there is none of that number."""
    camera = Webcam(int(os.environ.get("IR50P_CAMERA", index)), size=size)
    print("Camera: {}, {}x{}".format(camera.name, *camera.size))
    return camera


@contextlib.contextmanager
def _quiet():
    """Keep what camera drivers write to the console out of the notebook."""
    try:
        kept = os.dup(2)
    except OSError:  # a program without a console
        yield
        return
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)
