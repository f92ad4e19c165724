"""Notebook 16: its pictures hold what they are for, its views draw it, and check knows wrong answers to its functions."""

import numpy as np
import pytest
import solutions

from data.make_bench_16 import look, main
from ir50p_lab.course import data_file, images
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.tasks import of_notebook
from ir50p_lab.course.images.functions.hue_mask import hue_of
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import is_rendered, load_image

WRITTEN = solutions.load()


def mask_of(picture, ball_hue=0.0):
    return WRITTEN.hue_mask(picture, ball_hue, 0.3)


@pytest.mark.parametrize(("colour", "name"), [("red", "bench_16"), ("blue", "bench_16_blue")])
def test_a_bench_shows_its_ball_in_any_light_and_no_other(colour, name):
    bench, dim, empty = images.bench_pictures(colour)
    truth = look(name)[1]
    np.testing.assert_allclose([truth.x, truth.y], [406.9, 212.0], atol=0.05)  # as the notebook has it
    ball_hue = np.median(hue_of(bench[195:229, 390:424]))
    lit, shaded, none = (images.best_circle(mask_of(one, ball_hue), range(18, 32)) for one in (bench, dim, empty))
    for share, place, _ in (lit, shaded):
        assert share > 0.7 and np.hypot(place[0] - truth.x, place[1] - truth.y) < 1.5
    assert none[0] < 0.25


def test_the_files_are_what_their_command_writes(tmp_path):
    main(tmp_path)
    for path in tmp_path.iterdir():
        kept = data_file(path.name)
        apart = load_image(path).astype(int) - load_image(kept)
        assert is_rendered(kept) and np.abs(apart).mean() < 0.5  # another OpenCV rounds otherwise


def test_there_are_two_benches():
    with pytest.raises(InputError, match="red"):
        images.bench_pictures("green")


def test_the_votes_are_drawn_and_a_mask_without_edges_is_refused():
    bench = images.bench_pictures("red")[0]
    edges = images.edges_of(mask_of(bench))
    votes = images.with_neighbours(WRITTEN.circle_votes(*edges, 25, bench.shape[:2]))
    figure = images.votes_figure(bench, edges, 25, votes)
    assert str(votes.max()) in figure.axes[1].get_title() and len(figure.axes[0].lines) > 100
    with pytest.raises(InputError, match="no edge pixel"):
        images.votes_figure(bench, images.edges_of(np.zeros(bench.shape[:2], bool)), 25, votes)


def test_the_moved_ball_moves():
    seen = [images.best_circle(mask_of(images.bench_with_ball(IR50P, x, 0.1)), range(8, 17)) for x in (0.3, 0.45)]
    assert all(share > 0.5 for share, _, _ in seen) and seen[0][1] != seen[1][1]


LOOP = """
    found = {}
    for radius in RADII:
        found[radius] = strongest(edges_of(mask), radius, mask.shape)
    radius = BEST
    return ANSWER
"""
RIGHT = {"RADII": "radii", "BEST": "max(found, key=found.get)", "ANSWER": "(*found[radius], radius)"}
WRONG = [  # a change in it, what is said
    ({"RADII": "radii[:3]"}, ""),
    ({"BEST": "max(found, key=lambda r: r * found[r][0])"}, "a large circle has more of them"),
    ({"BEST": "max(found)"}, "compare the shares"),
    ({"BEST": "min(found, key=found.get)"}, "the largest should"),
    ({"ANSWER": "found[radius]"}, "3 results are asked for"),
    ({"ANSWER": "(found[radius][0], radius, found[radius][1])"}, "share, place, radius"),
    ({"ANSWER": "(found[radius][0], found[radius][1][::-1], radius)"}, "rows and columns"),
]


def judged(change):
    body = LOOP
    for name, line in (RIGHT | change).items():
        body = body.replace(name, line)
    names = {"strongest": images.strongest, "edges_of": images.edges_of}
    exec(f"def best_circle(mask, radii):{body}", names)
    return grade(of_notebook("best_circle"), names["best_circle"])


def test_a_loop_over_the_radii_is_right():
    assert judged({}).state == "right"


@pytest.mark.parametrize(("change", "words"), WRONG, ids=range(len(WRONG)))
def test_a_wrong_best_circle_is_told(change, words):
    found = judged(change)
    assert found.state == "wrong" and words in found.says, found.says
