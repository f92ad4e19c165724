"""The pictures of notebook 16: the bench with the ball moved, in full and in dim light, and without it. Rendered.

`python -m data.make_bench_16` writes `data/bench_16*.jpg` again, in red and in blue.
"""

from ir50p_lab.home import PROJECT
from ir50p_lab.modelling.named_arms import IR50P
from ir50p_lab.vision.image import save_image
from ir50p_lab.vision.rendering import Patch, SceneBall, arm_sticks, bench_scene, render_scene

BALL = (0.38, 0.10, 0.03)  # m
COLOURS = {"bench_16": ("red", "orange"), "bench_16_blue": ("blue", "green")}  # of the ball and of a smaller one


def look(name, *, light=1.0, ball=True):
    """One of the pictures (480, 640, 3), and where its ball is (BallTruth)."""
    colour, other = COLOURS[name]
    patches = (
        Patch(position=(0.50, -0.05), size=(0.14, 0.02), angle=0.5, colour=colour),  # tape
        Patch(position=(0.42, 0.27), size=(0.10, 0.06), colour="skin", round=True),
    )
    moved = SceneBall(position=BALL, colour=colour)
    small = SceneBall(position=(0.30, -0.12, 0.025), radius=0.025, colour=other)
    arm = arm_sticks([2.6, 0.5, -1.0], IR50P)
    scene = bench_scene(*([moved] * ball), small, patches=patches, arm=arm, exposure=light)
    image, truth = render_scene(scene, seed=1)
    return image, truth.balls[0]


def main(target=PROJECT / "data"):
    """Write the six pictures into a folder."""
    for name in COLOURS:
        for more, options in (("", {}), ("_dim", {"light": 0.4}), ("_empty", {"ball": False})):
            save_image(target / f"{name}{more}.jpg", look(name, **options)[0], rendered=True, quality=92)


if __name__ == "__main__":
    main()
