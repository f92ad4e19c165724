"""The drawings that never change: what lies in `data/drawings` is what the recipe draws, and notebooks show it."""

import re

import pytest

from data.make_drawings import DRAWINGS, main
from ir50p_lab.course.draw.drawings import drawing
from ir50p_lab.home import PROJECT

FOLDER = PROJECT / "data" / "drawings"
SHOWN = {
    "one_loop": ("speed, filtered", "limit", "arm"),
    "three_loops": ("controller 1", "controller 3", "one arm"),
    "axis_and_lever": ("axis", "lever", "velocity"),
    "colour_solids": ("RGB", "HSV", "hue is the angle"),
    "ruler": ("rise time", "settling time", "overshoot", "rest error"),
}


def words(svg):
    """The texts of a drawing: matplotlib writes each beside its outline."""
    return re.findall(r"<!-- (.*?) -->", svg, re.DOTALL)


@pytest.mark.parametrize("name", SHOWN)
def test_a_drawing_has_its_words(name):
    shown = drawing(name)
    said = " ".join(words(shown.data))
    assert all(word in said for word in SHOWN[name])
    assert re.search(r'<img [^>]*alt="[^"]{30,}"', shown._repr_html_())


def test_the_files_are_what_the_recipe_draws(tmp_path):
    main(["--data", str(tmp_path)])
    assert sorted(path.stem for path in FOLDER.glob("*")) == sorted(DRAWINGS)
    for name in DRAWINGS:
        kept, made = ((folder / f"{name}.svg").read_text(encoding="utf-8") for folder in (FOLDER, tmp_path))
        assert words(kept) == words(made) and len(kept) < 200_000
