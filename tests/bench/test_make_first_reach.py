"""What notebook 00 shows first has a recipe, and the recipe makes it again."""

import numpy as np

from ir50p_lab.bench import Recording
from ir50p_lab.vision import is_rendered, load_image
from tests.support.make_first_reach import DATA, main


def test_the_recipe_makes_picture_and_recording_again(tmp_path):
    main(tmp_path)
    kept, made = (Recording.load(folder / "first_reach.csv") for folder in (DATA, tmp_path))
    assert made.header == kept.header and kept.simulated and len(made) == len(kept)
    assert np.abs(made.q - kept.q).max() < 0.02  # another processor: another calibration, by tenths of a millimetre
    assert is_rendered(DATA / "first_reach.jpg")
    pictures = [load_image(str(folder / "first_reach.jpg")).astype(float) for folder in (DATA, tmp_path)]
    assert np.abs(np.subtract(*pictures)).mean() < 1
