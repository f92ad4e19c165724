"""`open_camera()`: a webcam, a folder of pictures, or the rendered bench; one line says which, why, and the other."""

import os

from ir50p_lab.errors import CameraError, ImageError
from ir50p_lab.vision.camera import webcam
from ir50p_lab.vision.camera.picture_folder import PictureFolder
from ir50p_lab.vision.camera.rendered_camera import RenderedCamera
from ir50p_lab.vision.camera.webcam import TO_RENDERED, VARIABLE, Webcam

TO_WEBCAM = f"for a webcam: open_camera(0) or {VARIABLE}=0"


def open_camera(source=None, *, size=(640, 480)):
    """Find the camera, open it and say in one line which it is, why, and how to get the other.

    The first of these that says something: the argument `source`, the environment variable IR50P_CAMERA, a webcam that
    is plugged in, the rendered bench.

    Args:
        source: a number (of the webcam), 'rendered', 'folder:PATH', or the path of a folder or picture; None looks for
        a webcam. size: (width, height) asked of a webcam; other cameras have the size of their pictures.

    Returns: Camera, for `with open_camera() as camera:`; it is open already.
    Raises: CameraError if the webcam asked for is not there, ImageError for a missing or empty folder, or a path that
    is none. A webcam that was only looked for never raises.
    """
    variable = os.environ.get(VARIABLE, "").strip()
    if source is not None:
        return _asked_for(str(source), size, f"asked for by open_camera({source!r})")
    if variable:
        return _asked_for(variable, size, f"asked for by {VARIABLE}={variable}")
    try:
        if not webcam.webcam_present():
            raise CameraError("no webcam found")
        camera = Webcam(0, size=size)
    except (CameraError, ImageError) as error:
        why = str(error).split(";")[0].split(":")[0]
        return _say(RenderedCamera(), why, TO_WEBCAM)
    return _say(camera, "a webcam is plugged in and answers", TO_RENDERED)


def _asked_for(source, size, reason):
    if source.isdecimal():
        return _say(Webcam(int(source), size=size), reason, TO_RENDERED)
    if source.lower() == "rendered":
        return _say(RenderedCamera(), reason, TO_WEBCAM)
    path = source[len("folder:") :] if source.lower().startswith("folder:") else source
    return _say(PictureFolder(path), reason, TO_WEBCAM)


def _say(camera, reason, other):
    """The one line."""
    width, height = camera.size
    kind = "rendered" if camera.simulated else "photographs"
    print(f"Camera: {camera.name}, {width}x{height}, {kind} ({reason}; {other})")
    return camera
