"""Pictures as arrays: read, check, write. Always uint8, (height, width, 3), in the order red, green, blue."""

import os
import re
import zlib
from pathlib import Path

import numpy as np

from ir50p_lab.errors import ImageError
from ir50p_lab.vision.picture_file import decode

MARK = "rendered by ir50p_lab: not a photograph"
"""What a rendered picture carries in its file (PNG: a tEXt chunk, JPEG: a comment)."""

SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp")  # of files that are written
READ = (*SUFFIXES, ".ppm", ".pgm", ".gif")
_PNG = b"\x89PNG\r\n\x1a\n"


def check_image(image, name="image"):
    """Return `image` if it is a colour picture: uint8, (height, width, 3), red green blue.

    Raises ImageError, naming what it is instead and what to do, for None, an empty array, one channel, four channels,
    or numbers that are not bytes.
    """
    if not isinstance(image, np.ndarray):
        what = "None" if image is None else f"a {type(image).__name__}"
        raise ImageError(f"{name} is {what}: give an array (height, width, 3); load_image reads files")
    if image.size == 0:
        raise ImageError(f"{name} is empty (shape {image.shape}): the camera or the file gave no picture")
    if image.ndim == 2 or (image.ndim == 3 and image.shape[2] == 1):
        raise ImageError(
            f"{name} has one channel (shape {image.shape}): a grey picture holds no colour to look for. Give the "
            "colour picture (height, width, 3)"
        )
    if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8:
        raise ImageError(
            f"{name} holds {image.dtype} numbers of shape {image.shape}: give bytes 0..255 (uint8), (height, width, "
            "3), red green blue. Drop a fourth channel, image[..., :3]; scale 0..1, (255 * image).astype('uint8')"
        )
    return image


def to_grey(image):
    """Grey picture (h, w) uint8 of a colour one (h, w, 3): 0.299 R + 0.587 G + 0.114 B, rounded (thesis 3.1.1)."""
    import cv2

    return cv2.cvtColor(check_image(image), cv2.COLOR_RGB2GRAY)


def load_image(path, *, allow_grey=False):
    """Read a picture: (h, w, 3) uint8, red green blue; the right way up if its EXIF says so, without transparency.

    Of an animation the first picture is taken. allow_grey: a picture of one channel is taken too, its value three
    times (a checkerboard needs no colour).
    Raises ImageError for a path that is missing or a folder, an empty file, one that is no picture, damaged or cut
    off, and one of one channel or more than 8 bits.
    """
    if not isinstance(path, str | os.PathLike):
        raise ImageError(f"path = {path!r:.60}: give the path of a picture file")
    path = Path(path)
    if path.is_dir():
        raise ImageError(f"{path} is a folder: give one of its files, or open_camera('folder:{path}') for all of them")
    data = _bytes(path)
    image, problem = decode(data)
    if problem:
        raise ImageError(f"{path} {problem}")
    if image.dtype != np.uint8:
        raise ImageError(f"{path} has {8 * image.itemsize} bits per colour: save it with 8, image // 257 of 16 bits")
    if image.ndim == 2:
        if not allow_grey:
            raise ImageError(
                f"{path} has one channel: a grey picture holds no colour to look for; give the colour picture"
            )
        return np.repeat(image[:, :, None], 3, axis=2)
    return np.ascontiguousarray(image[..., ::-1])


def _bytes(path):
    """What is in the file; ImageError if nothing is, or it cannot be read."""
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        beside = "" if path.parent.is_dir() else f", nor the folder {path.parent}"
        raise ImageError(f"there is no file {path}{beside}: check the name (here is {Path.cwd()})") from None
    except (OSError, ValueError) as error:  # no right to, or a null byte in the name
        raise ImageError(f"{path} cannot be read ({error}): check its name and its rights") from None
    if not data:
        raise ImageError(f"{path} is empty (0 bytes): copy or take the picture again")
    return data


def save_image(path, image, *, rendered=False, quality=95):
    """Write a picture (h, w, 3) uint8, red green blue, as the suffix of `path` says (.png, .jpg, ...).

    rendered: put the mark into the file (PNG and JPEG) that `is_rendered` finds. quality: of JPEG.
    Raises ImageError for what is no picture, another suffix, or a place that cannot be written.
    """
    import cv2

    path, image = Path(path), check_image(image)
    if path.suffix.lower() not in SUFFIXES:
        raise ImageError(f"{path.name} does not end in one of {', '.join(SUFFIXES)}: choose one, .png loses nothing")
    options = [cv2.IMWRITE_JPEG_QUALITY, int(quality)] if path.suffix.lower() in (".jpg", ".jpeg") else []
    _, data = cv2.imencode(path.suffix.lower(), np.ascontiguousarray(image[..., ::-1]), options)
    data = data.tobytes()
    try:
        path.write_bytes(_marked(data) if rendered else data)
    except OSError as error:
        raise ImageError(f"{path} cannot be written ({error.strerror}): choose another folder") from None


def is_rendered(path):
    """Whether the picture file carries the mark of a rendered one. Raises ImageError for a file that is not there."""
    return MARK.encode() in _bytes(Path(path))[:4096]


def list_images(folder):
    """Paths of the pictures in a folder, in the order of their names, numbers in them by value (view2 before view10).

    Raises ImageError for a missing folder or one without pictures.
    """
    folder = Path(folder)
    if not folder.is_dir():
        what = "is a file, not a folder:" if folder.exists() else "does not exist: check the name, and"
        raise ImageError(f"{folder} {what} give the folder of the pictures (here is {Path.cwd()})")
    files = [p for p in folder.iterdir() if not p.name.startswith(".")]
    paths = [p for p in files if p.suffix.lower() in READ]
    if not paths:
        raise ImageError(
            f"{folder} holds no picture ({len(files)} other files): they end in {', '.join(READ)}; save HEIC pictures "
            "of a phone as JPEG"
        )
    return sorted(paths, key=_by_number)


def _by_number(path):
    return [int(part) if part.isdecimal() else part for part in re.split("([0-9]+)", path.name.lower())]


def _marked(data):
    mark = MARK.encode()
    if data.startswith(_PNG):
        body = b"tEXtComment\x00" + mark
        chunk = len(body[4:]).to_bytes(4, "big") + body + zlib.crc32(body).to_bytes(4, "big")
        header = len(_PNG) + 25  # the first chunk, IHDR, is always 25 bytes
        return data[:header] + chunk + data[header:]
    if data.startswith(b"\xff\xd8"):
        return data[:2] + b"\xff\xfe" + (len(mark) + 2).to_bytes(2, "big") + mark + data[2:]
    raise ImageError("only PNG and JPEG files can say that they are rendered: choose .png or .jpg")
