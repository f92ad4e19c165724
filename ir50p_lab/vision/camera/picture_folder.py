"""Pictures from files instead of a camera."""

import contextlib
import time
from pathlib import Path

from ir50p_lab.errors import CameraError, ImageError
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.image import is_rendered, list_images, load_image


class PictureFolder(Camera):
    """The pictures of a folder, or one picture, in the order of their names; after the last, CameraError unless `loop`.

    Raises ImageError for a missing or empty folder; `read` raises it for a file that is no colour picture, and goes on
    with the next one then.
    """

    def __init__(self, path, *, loop=False):
        path = Path(path)
        self._paths = [path] if path.is_file() else list_images(path)
        self.name, self._loop, self._next = f"folder {path}" if path.is_dir() else f"picture {path}", loop, 0
        self._closed, self._opened = False, time.monotonic()
        self.simulated = all(is_rendered(p) for p in self._paths)
        for candidate in self._paths:
            with contextlib.suppress(ImageError):
                height, width = load_image(candidate).shape[:2]
                self.size = (width, height)
                break

    def __len__(self):
        return len(self._paths)

    def __iter__(self):
        while self._loop or self._next < len(self._paths):
            yield self.read()

    def read(self):
        """The next Frame. Raises CameraError after the last picture, ImageError for a file that is none."""
        if self._closed:
            raise CameraError(f"{self.name} is closed: open it again")
        if self._next >= len(self._paths):
            if not self._loop:
                raise CameraError(
                    f"{self.name} has no more than {len(self._paths)} pictures: open it again, or with loop=True"
                )
            self._next = 0
        path = self._paths[self._next]
        self._next += 1
        return Frame(
            image=load_image(path),
            t=time.monotonic() - self._opened,
            simulated=is_rendered(path),
            source=path.name,
        )

    def close(self):
        """No more pictures."""
        self._closed = True
