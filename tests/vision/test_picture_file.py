"""Files of all kinds that users have: read right, or refused with the remedy; the decoders say nothing aloud."""

import struct

import cv2
import numpy as np
import pytest
from PIL import Image

from ir50p_lab.errors import ImageError
from ir50p_lab.vision import PictureFolder, load_image, to_grey
from ir50p_lab.vision.calibration.pictures import pictures_of

TURN = Image.Transpose
UNDO = {  # how a camera stores the picture whose EXIF orientation is this
    1: None,
    2: TURN.FLIP_LEFT_RIGHT,
    3: TURN.ROTATE_180,
    4: TURN.FLIP_TOP_BOTTOM,
    5: TURN.TRANSPOSE,
    6: TURN.ROTATE_90,
    7: TURN.TRANSVERSE,
    8: TURN.ROTATE_270,
}


@pytest.fixture
def picture():
    """Smooth, different in all four corners, (40, 60, 3)."""
    y, x = np.mgrid[0:40, 0:60]
    return np.dstack([4 * x, 6 * y, 120 + x - y]).astype(np.uint8)


@pytest.mark.parametrize("suffix", ["jpg", "png", "tif", "webp"])
@pytest.mark.parametrize("orientation", UNDO)
def test_a_phone_held_in_any_way(tmp_path, picture, suffix, orientation):
    stored = Image.fromarray(picture)
    if UNDO[orientation] is not None:
        stored = stored.transpose(UNDO[orientation])
    exif = Image.Exif()
    exif[0x0112] = orientation
    stored.save(tmp_path / f"a.{suffix}", exif=exif, **({"quality": 95} if suffix in ("jpg", "webp") else {}))
    found = load_image(tmp_path / f"a.{suffix}")
    assert found.shape == picture.shape and np.abs(found.astype(int) - picture).mean() < 2
    assert (PictureFolder(tmp_path).read().image == found).all()


@pytest.mark.parametrize("usual", [1, 3, 6, 8])
def test_a_calibration_sees_what_the_sensor_saw_however_the_phone_was_held(tmp_path, picture, usual):
    """Four pictures of one scene by one sensor, tagged differently: all are brought to how most were held."""
    for k, orientation in enumerate((usual, usual, 1, 3, 6, 8)):
        exif = Image.Exif()
        exif[0x0112] = orientation
        Image.fromarray(picture).save(tmp_path / f"{k}.jpg", exif=exif, quality=95)
    found = [one.image for one in pictures_of(tmp_path)]
    assert (found[0] == to_grey(load_image(tmp_path / "0.jpg"))).all()
    assert all(np.abs(one.astype(int) - found[0]).max() < 12 for one in found)


@pytest.mark.parametrize(
    "fault", [SyntaxError("not a TIFF file"), struct.error("unpack"), IndexError(), Image.DecompressionBombError()]
)
def test_a_broken_exif_is_that_of_a_camera_held_upright(tmp_path, picture, monkeypatch, fault):
    def getexif(self):
        raise fault

    Image.fromarray(picture).save(tmp_path / "a.jpg")
    monkeypatch.setattr(Image.Image, "getexif", getexif)
    monkeypatch.setattr("PIL.JpegImagePlugin.JpegImageFile.getexif", getexif, raising=False)
    assert [one.turns for one in pictures_of(tmp_path)] == [0]


def test_a_picture_too_large_for_pillow_is_taken_in_silence(tmp_path, picture, monkeypatch):
    Image.fromarray(picture).save(tmp_path / "a.jpg")
    for limit in (2000, 1000):  # of 2400 pixels: a warning, an error
        monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", limit)
        assert [one.turns for one in pictures_of(tmp_path)] == [0]


def kinds(picture, folder):
    """file -> largest mean difference from `picture` after reading."""
    image = Image.fromarray(picture)
    hole = np.dstack([picture, np.full(picture.shape[:2], 255, np.uint8)])
    hole[:10, :, 3] = 0
    Image.fromarray(hole).save(folder / "transparent.png")
    image.quantize(256).save(folder / "palette.png")
    image.quantize(255).save(folder / "palette_transparent.png", transparency=0)
    image.convert("CMYK").save(folder / "cmyk.jpg", quality=95)
    image.convert("CMYK").save(folder / "cmyk.tif")
    image.convert("YCbCr").save(folder / "ycbcr.tif")
    image.save(folder / "progressive.jpg", progressive=True, quality=95)
    image.save(folder / "a.ppm")
    other = [image.transpose(TURN.ROTATE_180)]
    for name in ("animated.gif", "animated.webp", "animated.png", "pages.tif"):
        image.save(folder / name, save_all=True, append_images=other)
    (folder / "motion.jpg").write_bytes((folder / "progressive.jpg").read_bytes() + b"MotionPhoto" * 999)
    image.save(folder / "renamed.png")
    (folder / "renamed.png").rename(folder / "renamed.jpg")
    return sorted(folder.iterdir())


def test_colour_pictures_of_all_kinds_are_read(tmp_path, picture):
    for path in kinds(picture, tmp_path):
        found = load_image(path)
        assert found.shape == picture.shape and found.dtype == np.uint8 and found.flags["C_CONTIGUOUS"], path.name
        assert np.abs(found.astype(int) - picture).mean() < 5, path.name


@pytest.mark.parametrize("name", ["L.png", "1.png", "LA.png", "L.jpg", "L.tif"])
def test_grey_of_all_kinds_is_one_channel(tmp_path, picture, name):
    path = tmp_path / name
    Image.fromarray(picture).convert(path.stem).save(path)
    with pytest.raises(ImageError, match=r"one channel.*colour picture"):
        load_image(path)
    with pytest.raises(ImageError, match="one channel"):
        PictureFolder(tmp_path).read()
    grey = load_image(path, allow_grey=True)
    assert grey.shape == picture.shape and (np.ptp(grey, axis=2) == 0).all()
    assert pictures_of([path])[0].problem is None  # a board needs no colour


@pytest.mark.parametrize(
    ("name", "bits"), [("a.png", np.uint16), ("a.tif", np.uint16), ("b.tif", np.float32)], ids=["png", "tif", "float"]
)
def test_more_than_8_bits(tmp_path, picture, name, bits):
    cv2.imwrite(str(tmp_path / name), picture.astype(bits))
    with pytest.raises(ImageError, match=f"{8 * np.dtype(bits).itemsize} bits.*save it with 8"):
        load_image(tmp_path / name)
    assert "save it with 8" in pictures_of([tmp_path / name])[0].problem


@pytest.mark.parametrize("name", ["a.heic", "a.jpg"])
def test_heic_names_the_remedy(tmp_path, name):
    (tmp_path / name).write_bytes(struct.pack(">I", 24) + b"ftypheic" + bytes(4) + b"mif1heic" + bytes(500))
    with pytest.raises(ImageError, match=r"HEIC.*JPEG.*Most Compatible"):
        load_image(tmp_path / name)
    if name == "a.heic":
        with pytest.raises(ImageError, match="HEIC pictures of a phone as JPEG"):
            PictureFolder(tmp_path)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"\0\0\0\x18ftypmp42" + bytes(100), "video"),
        (b"%PDF-1.4 " + bytes(100), "no picture.*JPEG or PNG"),
        (b"II*\0" + bytes(100), "raw"),
        (b"\x89PNG\r\n\x1a\n" + bytes(100) + b"IEND", "damaged"),
        (b"RIFF" + struct.pack("<I", 5000) + b"WEBP" + bytes(100), "cut off"),
    ],
)
def test_what_is_no_picture(tmp_path, data, words, capfd):
    (tmp_path / "a.jpg").write_bytes(data)
    with pytest.raises(ImageError, match=words):
        load_image(tmp_path / "a.jpg")
    assert capfd.readouterr() == ("", "")


def test_a_damaged_jpeg_is_noticed_and_nothing_is_printed(tmp_path, capfd):
    noise = np.random.default_rng(3).integers(0, 255, (200, 300, 3), dtype=np.uint8)
    cv2.imwrite(str(tmp_path / "a.jpg"), noise)
    data = (tmp_path / "a.jpg").read_bytes()
    (tmp_path / "a.jpg").write_bytes(data[:20000] + data[30000:])  # its end is there, the middle is not
    with pytest.raises(ImageError, match=r"damaged \(Corrupt JPEG data.*again"):
        load_image(tmp_path / "a.jpg")
    assert capfd.readouterr() == ("", "")
