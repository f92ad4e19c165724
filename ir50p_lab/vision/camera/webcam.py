"""A webcam through OpenCV: found quietly, fresh pictures, a clear word when it is unplugged."""

import os
import time
from pathlib import Path

import numpy as np

from ir50p_lab.errors import CameraError, ImageError
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.console import captured

VARIABLE = "IR50P_CAMERA"
TO_RENDERED = f"for the rendered bench: open_camera('rendered') or {VARIABLE}=rendered"

LOST_AFTER = 3  # s without a picture: the webcam is unplugged


class Webcam(Camera):
    """A webcam by its number, 0 for the first; size: (width, height) asked for, the camera may give another.

    A driver keeps a few old pictures: `read` throws those away that were waiting, so that the picture is of now.
    Raises CameraError if there is none of that number, it is busy, or gives no picture.
    capture: what takes the pictures, default cv2.VideoCapture (tests pass one without hardware).
    """

    def __init__(self, index=0, *, size=(640, 480), capture=None):
        self.name, self._index = f"webcam {index}", index
        with captured():
            self._capture = _capture(index) if capture is None else capture
        if self._capture is None or not self._capture.isOpened():
            raise CameraError(
                f"there is no webcam {index}, or it is in use: plug it in, close the program that has it, or "
                f"camera.close() if you opened it before; {TO_RENDERED}"
            )
        self._opened = time.monotonic()
        self._ask_for(size)
        try:
            image = self._grab()
        except ImageError:
            self.close()
            raise
        except CameraError:
            self.close()
            raise CameraError(
                f"webcam {index} is there but gives no picture: is its shutter closed, or does another program use it? "
                f"{TO_RENDERED}"
            ) from None
        self.size = (image.shape[1], image.shape[0])

    def _ask_for(self, size):
        import cv2

        self._capture.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
        self._capture.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
        self._capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)

    def _grab(self):
        began = time.monotonic()
        while True:
            ok, image = self._ask("read")
            if ok and image is not None and image.size:
                channels = 1 if image.ndim == 2 else image.shape[2]
                if channels not in (3, 4) or image.dtype != np.uint8:
                    kind = "one channel (an infrared camera?)" if channels == 1 else f"{channels} channels"
                    what = f"{self.name} gives {kind} of {image.dtype}"
                    raise ImageError(f"{what}: set it to colour pictures of 8 bits, or take another camera")
                return np.ascontiguousarray(image[..., 2::-1])  # from blue, green, red
            if not self._capture.isOpened() or time.monotonic() - began > self._patience:
                raise CameraError(
                    f"{self.name} was unplugged, or stopped: no picture for {time.monotonic() - began:.1f} s. Plug it "
                    f"in and open it again; {TO_RENDERED}"
                )
            time.sleep(0.01)

    def _ask(self, what):
        """Call read() or grab() of the driver."""
        import cv2

        try:
            return getattr(self._capture, what)()
        except (cv2.error, OSError) as error:
            raise CameraError(f"{self.name} stopped ({error}): plug it in and open it again; {TO_RENDERED}") from None

    _patience = LOST_AFTER

    def read(self):
        """The next Frame, not one that was waiting. Raises CameraError when closed or unplugged."""
        if self._capture is None:
            raise CameraError(f"{self.name} is closed: open it again with open_camera({self._index})")
        self._throw_away_waiting()
        image = self._grab()
        return Frame(image=image, t=time.monotonic() - self._opened, simulated=False, source=self.name)

    def _throw_away_waiting(self):
        # one that waited comes at once; one that is being taken makes grab() wait for it
        for _ in range(5):
            began = time.monotonic()
            if not self._ask("grab") or time.monotonic() - began > 0.005:
                return

    def close(self):
        """Let go of the webcam, so that other programs can have it."""
        if self._capture is not None:
            self._capture.release()
            self._capture = None


def webcam_present():
    """Whether it is worth asking OpenCV for a webcam: on Linux that is known without opening anything."""
    return os.name != "posix" or not os.path.isdir("/sys/class") or any(Path("/dev").glob("video*"))


def _capture(index):
    import cv2

    return cv2.VideoCapture(index)
