"""A webcam through OpenCV: found quietly, fresh pictures, a clear word when it is unplugged."""

import os
import time
from pathlib import Path

import numpy as np

from ir50p_lab.errors import CameraError, VisionError
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.console import captured
from ir50p_lab.vision.image import check_image

VARIABLE = "IR50P_CAMERA"
TO_RENDERED = f"for the rendered bench: open_camera('rendered') or {VARIABLE}=rendered"

_PATIENCE = 3  # s without a picture: the webcam is unplugged


class Webcam(Camera):
    """A webcam by its number, 0 for the first; size: (width, height) asked for, the camera may give another.

    A driver keeps a few old pictures: `read` throws those away that were waiting, so that the picture is of now.
    Raises CameraError if there is none of that number, it is busy, or gives no picture; ImageError if its pictures have
    no colour.
    """

    def __init__(self, index=0, *, size=(640, 480)):
        import cv2

        self.name, self._index = f"webcam {index}", index
        with captured():
            self._capture = cv2.VideoCapture(index)
        if not self._capture.isOpened():
            raise CameraError(
                f"there is no webcam {index}, or it is in use: plug it in, close the program that has it, or "
                f"camera.close() if you opened it before; {TO_RENDERED}"
            )
        self._capture.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
        self._capture.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
        self._capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)
        try:
            self.size = self._grab().shape[1::-1]
        except VisionError:
            self.close()  # or the next attempt finds it busy
            raise

    def _grab(self):
        began = time.monotonic()
        while True:
            ok, image = self._ask("read")
            if ok and image is not None and image.size:
                image = np.ascontiguousarray(image[..., 2::-1])  # from blue, green, red
                return check_image(image, f"the picture of {self.name}")
            if not self._capture.isOpened() or time.monotonic() - began > _PATIENCE:
                raise CameraError(
                    f"{self.name} gives no picture: was it unplugged, is its shutter closed, or does another program "
                    f"use it? Put that right and open it again; {TO_RENDERED}"
                )
            time.sleep(0.01)

    def _ask(self, what):
        """Call read() or grab() of the driver."""
        import cv2

        try:
            return getattr(self._capture, what)()
        except (cv2.error, OSError) as error:
            raise CameraError(f"{self.name} stopped ({error}): plug it in and open it again; {TO_RENDERED}") from None

    def read(self):
        """The next Frame, not one that was waiting. Raises CameraError when closed or unplugged."""
        if self._capture is None:
            raise CameraError(f"{self.name} is closed: open it again with open_camera({self._index})")
        for _ in range(5):  # one that waited comes at once; one that is being taken makes grab() wait for it
            began = time.monotonic()
            if not self._ask("grab") or time.monotonic() - began > 0.005:
                break
        return Frame(image=self._grab(), simulated=False, source=self.name)

    def close(self):
        """Let go of the webcam, so that other programs can have it."""
        if self._capture is not None:
            self._capture.release()
            self._capture = None


def webcam_present():
    """Whether it is worth asking OpenCV for a webcam: on Linux that is known without opening anything."""
    return os.name != "posix" or not os.path.isdir("/sys/class") or any(Path("/dev").glob("video*"))
