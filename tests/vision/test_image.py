"""Pictures: what is refused and in which words; back and forth through files of all kinds that users have."""

import io
import struct
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image
from refusals import refused

from ir50p_lab.errors import ImageError
from ir50p_lab.vision import check_image, is_rendered, list_images, load_image, save_image, to_grey


@pytest.fixture
def picture():
    return np.random.default_rng(0).integers(0, 256, (40, 60, 3), dtype=np.uint8)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (None, "is None"),
        ([[1, 2]], "is a list"),
        (np.empty((0, 5, 3), np.uint8), r"shape \(0, 5, 3\)"),
        (np.zeros((4, 5), np.uint8), "one channel"),
        (np.zeros((4, 5, 1), np.uint8), "one channel"),
        (np.zeros((4, 5, 4), np.uint8), "fourth channel"),
        (np.zeros((4, 5, 3, 1), np.uint8), "height, width, 3"),
        (np.zeros((4, 5, 3)), "255"),
        (np.zeros((4, 5, 3), np.int32), "uint8"),
    ],
)
def test_what_is_no_colour_picture(value, words):
    refused(words, check_image, value, error=ImageError)
    refused("photo", check_image, value, "photo", error=ImageError)


def test_grey_is_the_weighted_sum(picture):
    assert np.abs(to_grey(picture) - picture @ (0.299, 0.587, 0.114)).max() <= 0.51


def test_red_stays_red_in_a_file(tmp_path):
    image = np.zeros((8, 9, 3), np.uint8)
    image[..., 0] = 200
    save_image(tmp_path / "red.png", image)
    assert (load_image(tmp_path / "red.png") == image).all()
    assert (cv2.imread(str(tmp_path / "red.png"))[0, 0] == (0, 0, 200)).all()  # OpenCV: blue, green, red


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".bmp", ".tif", ".webp"])
def test_there_and_back(tmp_path, picture, suffix):
    smooth = cv2.GaussianBlur(picture, (0, 0), 5)
    path = tmp_path / f"bild ü{suffix}"
    save_image(path, smooth)
    assert np.abs(load_image(path).astype(int) - smooth).max() <= (12 if suffix in (".jpg", ".webp") else 0)
    assert not is_rendered(path)


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_rendered_pictures_say_so_and_still_open(tmp_path, picture, suffix):
    path = tmp_path / f"a{suffix}"
    save_image(path, picture, rendered=True, quality=100)
    assert is_rendered(path)
    assert load_image(path).shape == picture.shape


def test_the_pictures_of_the_course_say_that_they_are_rendered():
    pictures = sorted((Path(__file__).parents[2] / "data").rglob("*.jpg"))
    assert len(pictures) > 20 and all(map(is_rendered, pictures))


def test_only_some_files_can_be_marked(tmp_path, picture):
    refused(r"choose \.png", save_image, tmp_path / "a.bmp", picture, rendered=True, error=ImageError)


def test_refused_files(tmp_path, picture):
    refused("there is no file", load_image, tmp_path / "no" / "a.png", error=ImageError)
    refused(r"is a folder.*folder:", load_image, tmp_path, error=ImageError)
    for path in (None, "a\0b"):
        refused(r"cannot be read .*: give the path of a picture file", load_image, path, error=ImageError)
    cv2.imwrite(str(tmp_path / "deep.png"), picture[..., 0].astype(np.uint16))
    refused("more than 8 bits", load_image, tmp_path / "deep.png", allow_grey=True, error=ImageError)
    for bad in ("a.xyz", "no/a.png"):
        refused("cannot be written", save_image, tmp_path / bad, picture, error=ImageError)


HEIC = struct.pack(">I", 24) + b"ftypheic" + bytes(4) + b"mif1heic" + bytes(500)


@pytest.mark.parametrize(
    "data", [b"", b"this is no picture at all", b"\x89PNG\r\n\x1a\n" + bytes(100) + b"IEND", b"%PDF-1.4 ", HEIC]
)
def test_what_is_no_picture(tmp_path, data, capfd):
    (tmp_path / "a.jpg").write_bytes(data)
    said = r"cannot be read as a picture.*JPEG or PNG.*Most Compatible"
    refused(said, load_image, tmp_path / "a.jpg", error=ImageError)
    assert capfd.readouterr() == ("", "")


def test_an_open_file_is_named_without_its_address_in_memory():
    refused(r"^this picture cannot be read .*BytesIO", load_image, io.BytesIO(b"..."), error=ImageError)


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".bmp"])
@pytest.mark.parametrize("part", [0.3, 0.95])
def test_a_file_that_was_cut_off_is_noticed(tmp_path, picture, suffix, part):
    path = tmp_path / f"a{suffix}"
    save_image(path, picture)
    data = path.read_bytes()
    path.write_bytes(data[: int(part * len(data))])
    refused("cut off", load_image, path, error=ImageError)


@pytest.mark.parametrize("suffix", ["jpg", "png", "webp"])
def test_a_phone_held_upright(tmp_path, picture, suffix):
    smooth, exif = cv2.GaussianBlur(picture, (0, 0), 5), Image.Exif()
    exif[0x0112] = 6
    stored = Image.fromarray(smooth).transpose(Image.Transpose.ROTATE_90)
    stored.save(tmp_path / f"a.{suffix}", exif=exif, quality=95)
    assert np.abs(load_image(tmp_path / f"a.{suffix}").astype(int) - smooth).mean() < 2


def test_colour_pictures_of_all_kinds_are_read(tmp_path, picture):
    smooth = cv2.GaussianBlur(picture, (0, 0), 5)
    image, hole = Image.fromarray(smooth), np.dstack([smooth, np.full(smooth.shape[:2], 255, np.uint8)])
    hole[:10, :, 3] = 0
    Image.fromarray(hole).save(tmp_path / "transparent.png")
    image.quantize(256).save(tmp_path / "palette.png")
    image.convert("CMYK").save(tmp_path / "cmyk.jpg", quality=95)
    image.save(tmp_path / "progressive.jpg", progressive=True, quality=95)
    image.save(tmp_path / "animated.gif", save_all=True, append_images=[image.transpose(Image.Transpose.ROTATE_180)])
    image.save(tmp_path / "renamed.png")
    (tmp_path / "renamed.png").rename(tmp_path / "renamed.jpg")
    cv2.imwrite(str(tmp_path / "16_bits.png"), 257 * smooth[..., ::-1].astype(np.uint16))
    for path in sorted(tmp_path.iterdir()):
        found = load_image(path)
        assert found.shape == picture.shape and found.dtype == np.uint8, path.name
        assert np.abs(found.astype(int) - smooth).mean() < 5, path.name


@pytest.mark.parametrize("mode", ["L", "1", "LA"])
def test_grey_of_all_kinds_is_one_channel(tmp_path, picture, mode):
    Image.fromarray(picture).convert(mode).save(tmp_path / "a.png")
    refused(r"one channel.*colour picture", load_image, tmp_path / "a.png", error=ImageError)
    grey = load_image(tmp_path / "a.png", allow_grey=True)
    assert grey.shape == picture.shape and (np.ptp(grey, axis=2) == 0).all()


def test_folder_in_order_of_its_numbers(tmp_path, picture):
    for name in ("view10.png", "view2.png", "view1.jpg", "notes.txt", ".hidden.png"):
        save_image(tmp_path / name, picture) if name != "notes.txt" else (tmp_path / name).touch()
    assert [path.name for path in list_images(tmp_path)] == ["view1.jpg", "view2.png", "view10.png"]
    refused("does not exist", list_images, tmp_path / "no", error=ImageError)
    refused("is a file", list_images, tmp_path / "view2.png", error=ImageError)
    (tmp_path / "sub").mkdir()
    refused("holds no picture", list_images, tmp_path / "sub", error=ImageError)
