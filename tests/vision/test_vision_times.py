"""Times of the processor, as another program may be running."""

import subprocess
import sys
from functools import partial

import cv2
import numpy as np
import pytest
from board_pictures import look, paint
from processor_time import processor_time

from ir50p_lab.errors import CalibrationError
from ir50p_lab.vision import calibrate, find_balls, render_scene
from ir50p_lab.vision.rendering import Patch, SceneBall, bench_scene


@pytest.fixture(scope="module")
def pictures():
    """Of two boards: one with whole squares around it, and one with its outer squares cut narrow."""
    rng = np.random.default_rng(0)
    poses = [
        look(rng.uniform(0.35, 0.5), rng.uniform(0.2, 0.7), rng.uniform(0, 6.28), rng.normal(0, 0.2)) for _ in range(13)
    ]
    return [paint(T, seed=k, rim=(1.0, 0.4)[k % 2]) for k, T in enumerate(poses)]


@pytest.mark.parametrize("pattern", [(5, 4), (10, 7)])
def test_a_wrong_pattern_is_refused_within_a_small_multiple_of_the_time_of_the_right_one(pictures, pattern):
    def refused():
        with pytest.raises(CalibrationError, match=r"pattern=\(9, 6\)"):
            calibrate(pictures, pattern=pattern, progress=False)

    wrong, right = processor_time(refused, lambda: calibrate(pictures, progress=False), rounds=2)
    assert wrong < 16 * right


def test_pictures_without_a_board_are_given_up_about_as_soon_as_by_opencv_alone():
    rng, pictures = np.random.default_rng(0), []
    for _ in range(4):
        picture = np.full((480, 640), 120, np.uint8)
        for x, y, w, h, grey in rng.integers((0, 0, 10, 10, 20), (640, 480, 160, 160, 235), (120, 5)).tolist():
            cv2.rectangle(picture, (x, y), (x + w, y + h), grey, -1)
        noise = rng.normal(0, 4, picture.shape)
        pictures.append(np.clip(cv2.GaussianBlur(picture, (0, 0), 0.8) + noise, 0, 255).astype(np.uint8))

    def ours():
        with pytest.raises(CalibrationError, match="4 no board"):
            calibrate(pictures, progress=False)

    by_us, alone = processor_time(ours, lambda: [cv2.findChessboardCorners(one, (9, 6)) for one in pictures], rounds=2)
    assert by_us < 4 * alone


def test_the_first_ball_is_found_at_once():
    """Nothing is compiled: in a fresh process the first picture takes no second of the processor."""
    code = (
        "import time, numpy as np; from ir50p_lab.vision import find_balls; start = time.process_time();"
        "find_balls(np.full((480, 640, 3), (200, 30, 40), np.uint8)); print(time.process_time() - start)"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert float(run.stdout) < 1.5


def test_a_table_of_a_reddish_colour_takes_no_more_than_ten_times_as_long_as_one_of_another():
    """Its mask breaks up into many parts, of which a few are looked at."""
    ball = SceneBall()
    tables = [Patch(position=(0.25, 0.0), size=(1.7, 1.6), colour=paint) for paint in ((70, 90, 130), (153, 82, 57))]
    pictures = [render_scene(bench_scene(ball, patches=(table,)))[0] for table in tables]
    took = processor_time(*[partial(find_balls, picture) for picture in pictures], rounds=5)
    assert took[1] < 10 * took[0] and took[1] < 0.5
