"""The drawings that never change: what lies in `data/drawings` is what the recipe draws, and notebooks show it."""

import re

import pytest

from ir50p_lab.course.images import views as vision_views
from ir50p_lab.course.kinematics import speed_views
from ir50p_lab.course.loops import loop_views, tuning_views
from ir50p_lab.course.reaching import views as reaching_views
from ir50p_lab.home import PROJECT
from tests.support.make_drawings import DRAWINGS, main

FOLDER = PROJECT / "data" / "drawings"
SHOWN = {
    reaching_views.loop_figure: ("find_balls", "T_base_table", "u [PWM]", "look again"),
    loop_views.one_loop: ("speed, filtered", "limit", "arm"),
    loop_views.three_loops: ("controller 1", "controller 3", "one arm"),
    speed_views.axis_and_lever: ("axis", "lever", "velocity"),
    vision_views.colour_solids_figure: ("RGB", "HSV", "hue is the angle"),
    tuning_views.ruler: ("rise time", "settling time", "overshoot", "rest error"),
}


def words(svg):
    """The texts of a drawing: matplotlib writes each beside its outline."""
    return re.findall(r"<!-- (.*?) -->", svg, re.DOTALL)


@pytest.mark.parametrize("show", SHOWN, ids=lambda show: show.__name__)
def test_a_drawing_has_its_words(show):
    said = " ".join(words(show().data))
    assert all(name in said for name in SHOWN[show])
    assert re.search(r'<img [^>]*alt="[^"]{30,}"', show()._repr_html_())


def test_the_files_are_what_the_recipe_draws(tmp_path):
    main(["--data", str(tmp_path)])
    assert sorted(path.stem for path in FOLDER.glob("*")) == sorted(DRAWINGS)
    for name in DRAWINGS:
        kept, made = ((folder / f"{name}.svg").read_text(encoding="utf-8") for folder in (FOLDER, tmp_path))
        assert words(kept) == words(made) and len(kept) < 200_000
