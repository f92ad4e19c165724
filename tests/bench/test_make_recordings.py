"""The recordings in `data/` are what the command makes, and hold what the lessons need of them."""

from pathlib import Path

import numpy as np
import pytest

from data.make_recordings import RECORDINGS, main
from ir50p_lab.bench.recording import Recording

DATA = Path(__file__).parents[2] / "data"
AGAIN = "run `python -m data.make_recordings` and look at the plots before you commit them"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    main([str(folder)])
    return folder


@pytest.mark.parametrize("name", RECORDINGS)
def test_the_files_are_what_the_command_makes(made, name):
    there, again = (Recording.load(folder / f"{name}.csv") for folder in (DATA, made))
    assert there.header == again.header, AGAIN
    for array in ("t", "q", "counts", "u", "reference"):
        np.testing.assert_array_equal(getattr(there, array), getattr(again, array), err_msg=f"{array}: {AGAIN}")


@pytest.mark.parametrize("name", RECORDINGS)
def test_they_are_small_marked_and_described(name):
    path = DATA / f"{name}.csv"
    recording = Recording.load(path)
    assert path.stat().st_size < 300 * 1024
    assert recording.simulated and "seed" in recording.header and "date" not in recording.header
    assert f"`{path.name}`" in (DATA / "README.md").read_text(encoding="utf-8")
    assert not recording.missed.any()
