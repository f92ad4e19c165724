"""The rendered pictures of data/: each has a recipe, and the recipe makes it again."""

import numpy as np
import pytest

from ir50p_lab.vision import is_rendered, load_image
from tests.support.make_pictures import FOLDER, main, recipes

SOME = ("calibration/flat/blurred", "calibration/flat/other_size", "calibration/bent/board_01", "scenes/70000")


def test_every_picture_has_a_recipe_and_says_that_it_is_rendered():
    files = {path.relative_to(FOLDER).with_suffix("").as_posix(): path for path in FOLDER.rglob("*/*.jpg")}
    assert set(files) == set(recipes())
    assert all(is_rendered(path) for path in files.values())


@pytest.fixture(scope="module")
def remade(tmp_path_factory):
    folder = tmp_path_factory.mktemp("remade")
    main(folder, SOME)
    assert sorted(path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*.jpg")) == sorted(SOME)
    return folder


@pytest.mark.parametrize("name", SOME)
def test_the_recipe_makes_it_again(remade, name):
    again, kept = (load_image(folder / f"{name}.jpg").astype(int) for folder in (remade, FOLDER))
    assert again.shape == kept.shape
    assert np.abs(again - kept).mean() < 0.5  # another version of the JPEG library may round otherwise
    assert is_rendered(remade / f"{name}.jpg")
