"""Pictures: what is refused and in which words; back and forth through files."""

import subprocess
import sys

import cv2
import numpy as np
import pytest

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
    with pytest.raises(ImageError, match=words):
        check_image(value)
    with pytest.raises(ImageError, match="photo"):
        check_image(value, "photo")


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
    if suffix == ".png":
        from PIL import Image

        assert "not a photograph" in Image.open(path).text["Comment"]
        assert (load_image(path) == picture).all()


def test_only_some_files_can_be_marked(tmp_path, picture):
    with pytest.raises(ImageError, match=r"choose \.png"):
        save_image(tmp_path / "a.bmp", picture, rendered=True)


def test_refused_files(tmp_path, picture):
    with pytest.raises(ImageError, match="there is no file"):
        load_image(tmp_path / "no" / "a.png")
    with pytest.raises(ImageError, match="is a folder"):
        load_image(tmp_path)
    with pytest.raises(ImageError, match=r"None cannot be read .*: give the path of a picture file"):
        load_image(None)
    (tmp_path / "empty.png").touch()
    with pytest.raises(ImageError, match="0 bytes"):
        load_image(tmp_path / "empty.png")
    (tmp_path / "text.png").write_text("this is no picture at all")
    with pytest.raises(ImageError, match="is no picture"):
        load_image(tmp_path / "text.png")
    cv2.imwrite(str(tmp_path / "grey.png"), picture[..., 0])
    with pytest.raises(ImageError, match="one channel"):
        load_image(tmp_path / "grey.png")
    assert (load_image(tmp_path / "grey.png", allow_grey=True) == picture[..., :1]).all()
    cv2.imwrite(str(tmp_path / "deep.png"), picture.astype(np.uint16))
    with pytest.raises(ImageError, match="16 bits"):
        load_image(tmp_path / "deep.png")
    with pytest.raises(ImageError, match=r"xyz.* cannot be written"):
        save_image(tmp_path / "a.xyz", picture)
    with pytest.raises(ImageError, match="cannot be written"):
        save_image(tmp_path / "no" / "a.png", picture)


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".bmp"])
@pytest.mark.parametrize("part", [0.3, 0.7, 0.95])
def test_a_file_that_was_cut_off_is_noticed(tmp_path, picture, suffix, part):
    path = tmp_path / f"a{suffix}"
    save_image(path, picture)
    data = path.read_bytes()
    path.write_bytes(data[: int(part * len(data))])
    with pytest.raises(ImageError, match="cut off"):
        load_image(path)


def test_transparency_is_dropped_and_exif_turns_the_picture(tmp_path, picture):
    cv2.imwrite(str(tmp_path / "a.png"), np.dstack([picture[..., ::-1], picture[..., 0]]))
    assert load_image(tmp_path / "a.png").shape == (40, 60, 3)
    from PIL import Image

    exif = Image.Exif()
    exif[0x0112] = 6  # a phone held upright
    Image.fromarray(picture).save(tmp_path / "a.jpg", exif=exif)
    assert load_image(tmp_path / "a.jpg").shape == (60, 40, 3)


def test_folder_in_order_of_its_numbers(tmp_path, picture):
    for name in ("view10.png", "view2.png", "view1.jpg", "notes.txt", ".hidden.png"):
        save_image(tmp_path / name, picture) if name != "notes.txt" else (tmp_path / name).touch()
    assert [path.name for path in list_images(tmp_path)] == ["view1.jpg", "view2.png", "view10.png"]
    with pytest.raises(ImageError, match="does not exist"):
        list_images(tmp_path / "no")
    with pytest.raises(ImageError, match="is a file"):
        list_images(tmp_path / "view2.png")
    (tmp_path / "sub").mkdir()
    with pytest.raises(ImageError, match="holds no picture"):
        list_images(tmp_path / "sub")


def test_importing_the_package_costs_nothing():
    code = "import ir50p_lab.vision, ir50p_lab.vision.rendering, sys; print(' '.join(sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split()
    assert not {"cv2", "numpy", "scipy", "matplotlib"} & set(loaded)


def test_a_path_with_a_null_byte_and_a_missing_file_are_refused():
    for ask in (load_image, is_rendered):
        with pytest.raises(ImageError, match="null byte"):
            ask("a\0b")
        with pytest.raises(ImageError, match="there is no file"):
            ask("nowhere.png")
