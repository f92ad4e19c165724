"""The bytes of a picture file: decoded, or the reason why they are none."""

import warnings

import numpy as np

from ir50p_lab.vision.console import captured

_GREY_AND_ALPHA = 4  # colour type of a PNG
_ORIENTATION = 0x0112  # tag of EXIF


def decode(data):
    """(picture, None) or (None, why there is none).

    data: bytes of a file. Picture: blue, green, red (h, w, 3), or (h, w) of one channel, with its own number of bits;
    the right way up, without transparency; of an animation the first.
    """
    import cv2

    with captured() as said:  # the decoder of JPEG says of damage nowhere else
        try:
            image = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), cv2.IMREAD_ANYCOLOR | cv2.IMREAD_ANYDEPTH)
        except cv2.error:  # an empty file, sizes beyond what OpenCV takes
            image = None
    if image is None:
        return None, (
            f"is no picture that OpenCV can read ({len(data)} bytes, the first {data[:8]!r}): cut off or damaged (copy "
            "or take it again), a video, a camera's raw, or a HEIC picture of a phone? Save it as JPEG or PNG (iPhone: "
            "Settings, Camera, Formats, 'Most Compatible' takes JPEGs from then on)"
        )
    damage = [line for line in said if "Corrupt JPEG" in line and "extraneous" not in line]  # those are harmless
    if damage:
        return None, f"is damaged ({damage[0].strip()}): copy or take the picture again"
    if data.startswith(b"\x89PNG") and data[25] == _GREY_AND_ALPHA:
        image = np.ascontiguousarray(image[..., 0])
    return image, None


def quarter_turns(path):
    """By how many quarter turns to the right a phone turned this picture upright (its EXIF orientation), 0 to 3."""
    from PIL import Image

    try:
        with warnings.catch_warnings(action="ignore"), Image.open(path) as picture:
            return {6: 1, 3: 2, 8: 3}.get(picture.getexif().get(_ORIENTATION), 0)
    except Exception:  # a kind that OpenCV reads and Pillow does not, a broken EXIF, a size that Pillow refuses
        return 0
