"""What every camera gives, a frame; and what every camera is."""

import contextlib
from collections import namedtuple

from ir50p_lab.vision.image import save_image


class Frame(namedtuple("Frame", "image simulated source")):
    """One picture. image: (h, w, 3) uint8, red green blue; simulated: whether it is rendered, not photographed; source:
    its
    camera.
    """

    def save(self, path):
        """Write the picture to a file; a rendered one gets a mark (PNG and JPEG). Raises ImageError."""
        save_image(path, self.image, rendered=self.simulated)


class Camera(contextlib.AbstractContextManager):
    """A source of pictures: `with open_camera() as camera: frame = camera.read()`. It has name, simulated, size."""

    name, simulated, size = "camera", False, (0, 0)

    def close(self):
        """Release the camera; it gives no more pictures. Closing it twice does no harm."""

    def __exit__(self, *_):
        self.close()
