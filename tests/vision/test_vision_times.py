"""Times of the processor, as another program may be running."""

import time

import cv2
import numpy as np
import pytest
from board_pictures import look, paint

from ir50p_lab.errors import CalibrationError
from ir50p_lab.vision import calibrate, find_balls, render_scene
from ir50p_lab.vision.rendering import SceneBall, bench_scene


@pytest.fixture(autouse=True)
def one_thread():
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    yield
    cv2.setNumThreads(threads)


@pytest.fixture(scope="module")
def pictures():
    """Of two boards: one with whole squares around it, and one with its outer squares cut narrow."""
    rng = np.random.default_rng(0)
    poses = [
        look(rng.uniform(0.35, 0.5), rng.uniform(0.2, 0.7), rng.uniform(0, 6.28), rng.normal(0, 0.2)) for _ in range(13)
    ]
    return [paint(T, seed=k, rim=(1.0, 0.4)[k % 2]) for k, T in enumerate(poses)]


@pytest.mark.parametrize("pattern", [(8, 6), (5, 4), (7, 7), (10, 7)])
def test_a_wrong_pattern_is_refused_within_three_seconds(pictures, pattern):
    start = time.process_time()
    with pytest.raises(CalibrationError, match=r"pattern=\(9, 6\)"):
        calibrate(pictures, pattern=pattern, progress=False)
    assert time.process_time() - start < 3


@pytest.mark.parametrize("colour", ["blue", "orange", "black"])
def test_a_ball_of_another_colour_takes_no_longer_than_the_one_sought(colour):
    """Two and a half times is the limit; a picture that shows little of the colour is searched where it shows it."""
    pictures = [render_scene(bench_scene(SceneBall(colour=paint)), seed=0)[0] for paint in ("red", colour)]
    assert [len(find_balls(picture)) for picture in pictures] == [1, 0]
    took = np.full(2, np.inf)
    for _ in range(30):
        for k, picture in enumerate(pictures):
            start = time.process_time()
            find_balls(picture)
            took[k] = min(took[k], time.process_time() - start)
    assert took[1] < 2.5 * took[0]
