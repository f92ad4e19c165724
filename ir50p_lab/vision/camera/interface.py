"""What every camera is: a source of frames."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.vision.image import save_image


@dataclass(frozen=True, kw_only=True, eq=False)
class Frame:
    """One picture: image (h, w, 3) uint8, red green blue; where it came from.

    simulated: rendered, not photographed. source: name of the camera, or of the file.
    """

    image: np.ndarray
    simulated: bool
    source: str

    def save(self, path):
        """Write the picture to a file; a rendered one carries a mark (PNG and JPEG). Raises ImageError."""
        save_image(path, self.image, rendered=self.simulated)


class Camera:
    """A source of pictures: `with open_camera() as camera: frame = camera.read()`; also `for frame in camera:`.

    Attributes: name; simulated: whether its pictures are rendered; size: (width, height) pixels; closed.
    """

    name, simulated, size, closed = "camera", False, (0, 0), False

    def read(self):
        """The next Frame. Raises CameraError if the camera is closed, was unplugged, or has no more pictures."""
        raise NotImplementedError

    def close(self):
        """Let go of the camera: no more pictures; twice does no harm."""
        self.closed = True

    def __iter__(self):
        return iter(self.read, None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
