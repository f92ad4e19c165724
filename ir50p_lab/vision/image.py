"""Pictures as arrays: read, check, write. They are always uint8, (height, width, 3), in the order red, green, blue."""

import io
import re
import warnings
from pathlib import Path

import numpy as np
from PIL import Image, ImageOps
from PIL.PngImagePlugin import PngInfo

from ir50p_lab.errors import ImageError

MARK = "rendered by ir50p_lab: not a photograph"
"""The mark in the file of a rendered picture (PNG: a tEXt chunk, JPEG: a comment)."""

_READ = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".ppm", ".pgm", ".gif")


def check_image(image, name="image"):
    """Return `image` if it is a colour picture: uint8, (height, width, 3), red green blue.

    Raises ImageError, which says what it is instead and what to do, for None, an empty array, one channel, four
    channels, or numbers that are not bytes.
    """
    if not isinstance(image, np.ndarray):
        what = "None" if image is None else f"a {type(image).__name__}"
        raise ImageError(f"{name} is {what}: give an array (height, width, 3); load_image reads files")
    if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8 or image.size == 0:
        grey = image.ndim == 2 or image.shape[2:] == (1,)
        kind = "has one channel, no colour to look for" if grey else "is not a colour picture"
        raise ImageError(
            f"{name} {kind} ({image.dtype} numbers of shape {image.shape}): give bytes 0..255 (uint8), (height, width, "
            "3), red green blue. Drop a fourth channel, image[..., :3]; scale 0..1, (255 * image).astype('uint8')"
        )
    return image


def to_grey(image):
    """Return a colour picture (h, w, 3) as grey (h, w) uint8: 0.299 R + 0.587 G + 0.114 B, rounded (thesis 3.1.1)."""
    import cv2

    return cv2.cvtColor(check_image(image), cv2.COLOR_RGB2GRAY)


def load_image(path, *, allow_grey=False):
    """Read a picture: (h, w, 3) uint8, red green blue, turned upright as its EXIF says, without transparency.

    Of an animation the first picture is taken. allow_grey: a picture of one channel is taken, too, with its value three
    times (a checkerboard needs no colour).
    Raises ImageError for a path that is missing or a folder; for a file that is empty, no picture, damaged or cut off;
    for a picture of one channel, or of more than 8 bits.
    """
    if isinstance(path, str | Path) and Path(path).is_dir():
        raise ImageError(f"{path} is a folder: give one of its files, or open_camera('folder:{path}') for all of them")
    data = _bytes(path)
    try:
        with warnings.catch_warnings(action="ignore"), Image.open(io.BytesIO(data)) as picture:
            deep, grey = picture.mode[0] in "IF", picture.mode in ("1", "L", "LA")
            image = np.array(ImageOps.exif_transpose(picture).convert("RGB"))
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise ImageError(
            f"{path} cannot be read as a picture, is cut off or damaged ({error}): save it as JPEG or PNG (iPhone: "
            "Settings, Camera, Formats, 'Most Compatible')"
        ) from None
    if deep:
        raise ImageError(f"{path} has more than 8 bits per colour: save it with 8, image // 257 of 16 bits")
    if grey and not allow_grey:
        raise ImageError(f"{path} has one channel, no colour to look for: give the colour picture")
    return image


def _bytes(path):
    """The bytes of the file. Raises ImageError if it cannot be read."""
    try:
        return Path(path).read_bytes()
    except FileNotFoundError:
        raise ImageError(f"there is no file {path}: check the name and the folder (here is {Path.cwd()})") from None
    except (OSError, ValueError, TypeError) as error:  # no permission, a null byte in the name, not a path
        name = "this picture" if hasattr(path, "read") else f"{path!s:.200}"  # an open file has no name to tell
        raise ImageError(f"{name} cannot be read ({error}): give the path of a picture file") from None


def save_image(path, image, *, rendered=False, quality=95):
    """Write a picture (h, w, 3) uint8, red green blue, in the format that the suffix of `path` names (.png, .jpg, ...).

    rendered: put the mark into the file (PNG and JPEG only) that `is_rendered` finds. quality: of JPEG.
    Raises ImageError for what is not a picture, a format that cannot be marked, or a place that cannot be written.
    """
    if rendered and Path(path).suffix.lower() not in (".png", ".jpg", ".jpeg"):
        raise ImageError("only PNG and JPEG files can say that they are rendered: choose .png or .jpg")
    picture, mark = Image.fromarray(check_image(image)), PngInfo()
    mark.add_text("Comment", MARK)
    marked = {"pnginfo": mark, "comment": MARK} if rendered else {}
    try:
        picture.save(path, quality=quality, subsampling=0, **marked)  # each pixel keeps its own hue
    except (OSError, ValueError) as error:
        raise ImageError(f"{path} cannot be written ({error}): choose another folder, or a name with .png") from None


def is_rendered(path):
    """Return whether the picture file carries the mark of a rendered one. Raises ImageError for a missing file."""
    return MARK.encode() in _bytes(path)[:4096]


def list_images(folder):
    """Return the paths of the pictures in a folder, sorted by name, with numbers by value (view2 before view10).

    Raises ImageError for a missing folder or one without pictures.
    """
    folder = Path(folder)
    if not folder.is_dir():
        what = "is a file, not a folder" if folder.exists() else "does not exist"
        raise ImageError(f"{folder} {what}: give the folder of the pictures (here is {Path.cwd()})")
    paths = [p for p in folder.iterdir() if p.suffix.lower() in _READ and not p.name.startswith(".")]
    if not paths:
        raise ImageError(f"{folder} holds no picture ({', '.join(_READ)}); save HEIC pictures of a phone as JPEG")
    return sorted(paths, key=_by_number)


def _by_number(path):
    return [int(part) if part.isdecimal() else part for part in re.split("([0-9]+)", path.name.lower())]
