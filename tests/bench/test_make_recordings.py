"""The recordings in `data/` are what the command makes, and hold what the lessons need of them."""

from pathlib import Path

import numpy as np
import pytest

from ir50p_lab.bench.recording import Recording
from tests.support.make_recordings import RECORDINGS, main

DATA = Path(__file__).parents[2] / "data"
AGAIN = "run `python -m tests.support.make_recordings` and look at the plots before you commit them"


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


def test_noise_at_rest_is_noise_only():
    recording = Recording.load(DATA / "noise_at_rest.csv")
    counts = recording.counts
    assert not recording.u.any() and len(recording) == 1000
    assert (np.abs(counts - counts.mean(axis=0)) < 6).all()
    # 1 count rms before rounding, and the 1/12 of rounding: within 3 standard errors of a variance from 1000 samples
    np.testing.assert_allclose(counts.var(axis=0), 1 + 1 / 12, rtol=3 * np.sqrt(2 / 1000))
    halves = counts[:500].mean(axis=0) - counts[500:].mean(axis=0)
    assert (np.abs(halves) < 4 * np.sqrt(2 * 1.083 / 500)).all()  # nothing sinks


def test_the_weak_shoulder_swings_over_and_the_default_does_not():
    default, weak = (
        Recording.load(DATA / f"{name}.csv").metrics() for name in ("pid_default_unit", "pid_weak_shoulder")
    )
    assert weak[0].overshoot > 0.05 > 0.03 > default[0].overshoot
    assert all(abs(joint.error) < 0.06 for joint in (*default, *weak))


def test_the_fast_move_is_five_times_as_fast():
    recording = Recording.load(DATA / "slow_and_fast.csv")
    speed = np.abs(np.diff(recording.reference, axis=0)).max(axis=1) / recording.period
    slow, fast = speed[recording.t[1:] < 8].max(), speed[recording.t[1:] > 8].max()
    assert fast / slow == pytest.approx(5, rel=1e-2)
    rms = np.sqrt(np.nanmean((recording.reference - recording.q) ** 2, axis=0))
    assert max(rms) < 0.15
