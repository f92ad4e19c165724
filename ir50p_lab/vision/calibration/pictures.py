"""What `calibrate` may be given: arrays, Frames, paths, or a folder of pictures."""

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ir50p_lab.errors import ImageError, InputError
from ir50p_lab.vision.camera.interface import Camera
from ir50p_lab.vision.camera.picture_folder import PictureFolder
from ir50p_lab.vision.image import list_images, load_image, to_grey
from ir50p_lab.vision.picture_file import quarter_turns


@dataclass(frozen=True, eq=False)
class Picture:
    """One picture, not decoded twice: name; index; image: grey levels (h, w) uint8, or None and the problem with it.

    turns: quarter turns to the right that made it upright, if its file says so.
    """

    name: str
    index: int
    image: np.ndarray | None
    problem: str | None = None
    turns: int = 0

    @property
    def size(self):
        """(width, height), or None if there is no picture."""
        return None if self.image is None else (self.image.shape[1], self.image.shape[0])


def pictures_of(images, progress=False):
    """A list of Picture, read with a progress bar if asked for (None: if they are many).

    Raises InputError for what cannot hold pictures, ImageError for a missing or empty folder.
    """
    if isinstance(images, str | Path):
        images = list_images(images)
    elif isinstance(images, PictureFolder):
        images = images.paths  # as if the folder were given: read() would stop at a bad file
    elif isinstance(images, Camera):
        raise InputError(f"{images.name} has no last picture: give a list, [camera.read(), ...]")
    elif (isinstance(images, np.ndarray) and images.ndim < 4) or hasattr(images, "image"):
        raise InputError("one picture is not enough: give a list of pictures, or a folder")
    try:
        images = list(images)
    except TypeError:
        raise InputError(f"images = {images!r}: give a list of pictures or paths, or a folder") from None
    if not images:
        raise InputError("no pictures were given: take 10 to 20 of the board, in different places and tilts")
    files = any(isinstance(one, str | Path) for one in images)
    images = with_bar(images, progress, "reading pictures") if files else images  # the large ones take their time
    return _as_most_were_held([_picture(k, one) for k, one in enumerate(images)])


def _as_most_were_held(pictures):
    """Pictures of a phone, turned upright by it, as its sensor saw them: the lens does not turn with the picture."""
    turns = Counter(picture.turns for picture in pictures if picture.image is not None)
    usual = turns.most_common(1)[0][0] if turns else 0
    return [
        replace(one, image=np.ascontiguousarray(np.rot90(one.image, one.turns - usual)), turns=usual)
        if one.image is not None and one.turns != usual
        else one
        for one in pictures
    ]


def _picture(index, one):
    import cv2

    if isinstance(one, str | Path):
        try:
            image = to_grey(load_image(one, allow_grey=True))  # a third of the memory: twenty of 12 Mpixel are 240 MB
            return Picture(Path(one).name, index, image, turns=quarter_turns(one))
        except ImageError as error:
            return Picture(Path(one).name, index, None, str(error))
    name = getattr(one, "name", None) or f"picture {index + 1}"
    array = np.asarray(getattr(one, "image", one))
    shaped = array.ndim == 2 or (array.ndim == 3 and array.shape[2] in (3, 4))
    if array.dtype != np.uint8 or not array.size or not shaped:
        what = f"{array.dtype} array of shape {array.shape}: give uint8 of shape (h, w, 3), or (h, w)"
        return Picture(str(name), index, None, what)
    if array.ndim == 3:
        array = cv2.cvtColor(np.ascontiguousarray(array[..., :3]), cv2.COLOR_RGB2GRAY)
    return Picture(str(name), index, np.ascontiguousarray(array))


def with_bar(pictures, progress, what="finding corners"):
    """The pictures, with a progress bar if asked for (None: if they are many)."""
    if progress is False or (progress is None and len(pictures) < 8):
        return pictures
    from tqdm.auto import tqdm

    return tqdm(pictures, desc=what, leave=False)


def common_size(pictures):
    """(width, height) that most pictures have; of equally many, that which came first."""
    sizes = Counter(picture.size for picture in pictures if picture.size is not None)
    return sizes.most_common(1)[0][0] if sizes else None
