"""Pictures from files instead of a camera."""

from pathlib import Path

from ir50p_lab.errors import CameraError, ImageError
from ir50p_lab.vision.camera.interface import Camera, Frame
from ir50p_lab.vision.image import is_rendered, list_images, load_image


class PictureFolder(Camera):
    """The pictures of a folder, or one picture, in the order of their names; after the last, CameraError.

    Raises ImageError for a missing folder, and one without a colour picture; `read` raises it for a file that is none,
    and goes on with the next one then. Attributes: paths: of all its files; simulated: no photograph is among them.
    """

    def __init__(self, path):
        path = Path(path)
        self.paths = [path] if path.is_file() else list_images(path)
        self.name, self._next = f"folder {path}" if path.is_dir() else f"picture {path}", 0
        self.size, self.simulated, problems = None, True, []
        for one in self.paths:
            try:
                size = load_image(one).shape[1::-1]
            except ImageError as error:
                problems.append(str(error))
                continue
            self.size = self.size or size
            self.simulated = is_rendered(one)
            if not self.simulated:
                break
        if self.size is None:
            raise ImageError(
                f"none of the {len(problems)} pictures of {self.name} can be used. The first: {problems[0]}. (To "
                "calibrate with grey ones, give calibrate the folder.)"
            )

    def __iter__(self):
        while self._next < len(self.paths):
            yield self.read()

    def read(self):
        """The next Frame. Raises CameraError after the last picture, ImageError for a file that is none."""
        if self.closed:
            raise CameraError(f"{self.name} is closed: open it again")
        if self._next >= len(self.paths):
            raise CameraError(f"{self.name} has no more than {len(self.paths)} pictures: open it again")
        path = self.paths[self._next]
        self._next += 1
        return Frame(image=load_image(path), simulated=is_rendered(path), source=path.name)
