"""Cameras as sources of frames. A webcam is opened quietly, gives fresh pictures, and says when it is unplugged."""

import sys
import time

import numpy as np

from ir50p_lab.browser_tab import IN_BROWSER
from ir50p_lab.errors import CameraError
from ir50p_lab.home import setting
from ir50p_lab.vision.frame import Camera, Frame
from ir50p_lab.vision.image import check_image, is_rendered, list_images, load_image

_PATIENCE = 3.0  # s: if no picture comes for so long, the webcam counts as unplugged
_AT_ONCE = 0.005  # s: if a picture comes sooner, it has waited in the driver, and is old


class Webcam(Camera):
    """A webcam by its number, 0 for the first. size: (width, height) to ask for; the camera may give another.

    Raises CameraError if there is none, ImageError if its pictures have no colour.
    """

    def __init__(self, index=0, *, size=(640, 480)):
        import cv2

        self.name = f"webcam {index}"
        level = cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)  # or drivers print into the notebook
        self._capture = cv2.VideoCapture(index)
        cv2.utils.logging.setLogLevel(level)
        asked = (cv2.CAP_PROP_FRAME_WIDTH, size[0]), (cv2.CAP_PROP_FRAME_HEIGHT, size[1]), (cv2.CAP_PROP_BUFFERSIZE, 1)
        for what, value in asked:
            self._capture.set(what, value)
        try:
            self.size = self.read().image.shape[1::-1]
        except Exception:
            self.close()  # or the next attempt finds it busy
            raise

    def read(self):
        """Return the next Frame, not one that was already waiting.

        Raises CameraError if there is no such webcam, or it is busy or unplugged.
        """
        began = time.monotonic()
        for _ in range(5):  # drop old pictures: those come at once, for a new one grab() waits
            asked = time.monotonic()
            if not self._capture.grab() or time.monotonic() - asked > _AT_ONCE:
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
        """Release the webcam, so that other programs can use it."""
        self._capture.release()


class PictureFolder(Camera):
    """The pictures of a folder as a camera, in the order of their names; simulated: if the first of them is rendered.

    Raises ImageError for a folder without pictures, and from `read` for a file that cannot be read; CameraError from
    `read` after the last one.
    """

    def __init__(self, folder):
        self._paths = list_images(folder)
        self.name, self.simulated = f"folder {folder}", is_rendered(self._paths[0])
        self.size = load_image(self._paths[0]).shape[1::-1]

    def read(self):
        """Return the next picture as a Frame."""
        if not self._paths:
            raise CameraError(f"{self.name} has no more pictures: open it again to begin with the first")
        path = self._paths.pop(0)
        return Frame(image=load_image(path), simulated=is_rendered(path), source=path.name)


def open_camera(source=None, *, size=(640, 480)):
    """Open a camera, say in one line which it is, and return it.

    source: a number: that webcam of this computer; "page": the camera of the browser that shows the notebook, live
    below the cell and to be read in the next one; "folder:PATH": the pictures of a folder. Default: what IR50P_CAMERA
    says, else "page" in a notebook and 0 in a script. size: (width, height) to ask of a camera.
    Raises CameraError if there is no such webcam, ImageError for a folder without pictures.
    """
    source = str((setting("IR50P_CAMERA") or _usual()) if source is None else source)
    if source.startswith("folder:"):
        camera = PictureFolder(source.removeprefix("folder:"))
    elif source.isdecimal():
        camera = Webcam(int(source), size=size)
    elif source == "page":
        from ir50p_lab.vision.page_camera import PageCamera

        camera = PageCamera(size=size)
    else:
        raise CameraError(f'no camera is called {source!r}: give the number of a webcam, "page", or folder:PATH')
    kind = "rendered" if camera.simulated else "photographs"
    print("Camera: {}, {}x{}, {}".format(camera.name, *camera.size, kind))
    return camera


def _usual():
    """What is opened by default: in a notebook the page's camera, because its kernel may run where there is none."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return "page" if IN_BROWSER or hasattr(shell, "kernel") else 0
