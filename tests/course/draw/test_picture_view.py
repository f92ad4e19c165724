"""A picture that is clicked tells its pixel, shows circles and masks, and loses no error."""

import base64
import io

import numpy as np
import pytest
from PIL import Image

from ir50p_lab.course import PictureView
from ir50p_lab.errors import InputError

PICTURE = np.random.default_rng(0).integers(0, 256, (30, 40, 3), np.uint8)


def shown(view):
    return np.asarray(Image.open(io.BytesIO(view.canvas.value)))


def click(view, x, y):
    """What the browser sends for the middle of a pixel."""
    h, w = view.picture.shape[:2]
    view.canvas._handle_custom_msg({"right": (x + 0.5) / w, "up": 1 - (y + 0.5) / h}, [])


def test_it_shows_the_picture_and_the_next_one_and_circles_on_a_copy():
    view = PictureView(PICTURE, alt="a bench")
    np.testing.assert_array_equal(shown(view), PICTURE)
    assert view.canvas.description == "a bench" and "rendered" in view.status.value and not view.canvas.clickable
    view.circles = [(20, 15, 8, "white")]
    assert (shown(view)[15, [12, 28]] == 255).all() and (shown(view)[15, 20] == PICTURE[15, 20]).all()
    view.picture = np.zeros((50, 60, 3), np.uint8)
    assert (view.picture == 0).all() and shown(view).max() == 255 and view.canvas.layout.width == "60px"


def test_a_mask_is_black_and_white():
    mask = PICTURE[..., 0] > 100
    assert (shown(PictureView(mask)) == 255 * mask[..., None]).all()


@pytest.mark.parametrize(
    "picture", [PICTURE[..., 0], PICTURE / 255, PICTURE[..., :2], None, np.zeros((0, 0, 3), np.uint8)]
)
def test_what_is_no_picture_is_refused(picture):
    with pytest.raises(InputError, match="give bytes"):
        PictureView(picture)


def test_a_click_tells_its_pixel_and_what_was_said_stands_below():
    def tell(x, y):
        print("printed <b>")
        return f"{x} {y} {PICTURE[y, x]}"

    view = PictureView(PICTURE, tell)
    for x, y in ((0, 0), (39, 29), (7, 21)):
        click(view, x, y)
        assert view.status.value == f"printed &lt;b&gt;<br>{x} {y} {PICTURE[y, x]}"
    view.canvas._handle_custom_msg({"right": 1.0, "up": 0.0}, [])
    assert "39 29" in view.status.value


def test_an_error_of_a_click_is_seen_with_its_line():
    def tell(x, y):
        raise KeyError("no ball")

    view = PictureView(PICTURE, tell)
    click(view, 3, 4)
    assert "no ball" in view.status.value and "in tell" in view.status.value


def test_an_export_has_its_picture_and_words():
    data, metadata = PictureView(PICTURE, alt="a bench")._repr_mimebundle_()
    assert np.asarray(Image.open(io.BytesIO(base64.b64decode(data["image/png"])))).shape == PICTURE.shape
    assert metadata["image/png"]["alt"] == "a bench" and "application/vnd.jupyter.widget-view+json" in data
