"""Rendered pictures against their truth, by routes that share no code with the renderer."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P, forward_kinematics
from ir50p_lab.vision import Pinhole
from ir50p_lab.vision.rendering import Patch, SceneBall, arm_sticks, bench_camera, bench_scene, render_scene


def test_same_seed_same_bytes():
    scene = bench_scene()
    first, other = render_scene(scene, seed=3)[0], render_scene(scene, seed=4)[0]
    assert first.shape == (480, 640, 3) and first.dtype == np.uint8
    assert (first == render_scene(scene, seed=3)[0]).all() and (first != other).any()


def coverage(scene):
    """Part (h, w) of each pixel that a black ball in the air hides: one minus the quotient of two pictures' light."""
    scene = replace(scene, exposure=1.3)
    with_ball, without = (
        np.mean([(render_scene(one, seed=k)[0] / 255.0) ** 2.2 for k in range(3)], axis=0).sum(axis=2)
        for one in (scene, replace(scene, objects=()))
    )
    return 1 - with_ball / without


@pytest.mark.parametrize(
    "ball",
    [
        SceneBall(position=(0.80, -0.05, 0.45), radius=0.02, colour=(0, 0, 0), gloss=0.0),
        SceneBall(position=(0.75, -0.08, 0.40), radius=0.035, colour=(0, 0, 0), gloss=0.0),
    ],
)
def test_outline_of_a_ball_is_where_the_truth_says(ball):
    # lens of the bench, but stronger: the outline is no ellipse then
    camera = bench_camera()[0]
    scene = bench_scene(ball, pinhole=Pinhole(camera.K, (-0.3, 0.12, 0.002, -0.001), camera.size))
    truth = render_scene(scene)[1].balls[0]
    part = coverage(scene)
    y, x = np.mgrid[: part.shape[0], : part.shape[1]]
    part[np.hypot(x - truth.outline_x, y - truth.outline_y) > 1.2 * truth.radius + 3] = 0  # noise, its shadow
    assert np.sum(part * x) / part.sum() == pytest.approx(truth.outline_x, abs=0.1)
    assert np.sum(part * y) / part.sum() == pytest.approx(truth.outline_y, abs=0.1)
    assert np.sqrt(part.sum() / np.pi) == pytest.approx(truth.radius, rel=0.01)


def test_centre_of_a_ball_is_its_projection_not_the_middle_of_its_outline():
    ball = SceneBall(position=(0.85, -0.20, 0.45), radius=0.03)  # near the camera and aside: the worst case
    (camera, T), truth = bench_camera(), render_scene(bench_scene(ball))[1].balls[0]
    theirs, _ = cv2.projectPoints(
        np.array([ball.position]), cv2.Rodrigues(T[:3, :3])[0], T[:3, 3], camera.K, camera.distortion
    )
    assert (truth.x, truth.y) == pytest.approx(theirs[0, 0])
    assert np.hypot(truth.x - truth.outline_x, truth.y - truth.outline_y) > 0.5


def test_a_ball_behind_the_camera_has_no_place():
    truth = render_scene(bench_scene(SceneBall(position=(2.0, 0.0, 0.03))))[1].balls[0]
    assert np.isnan([truth.x, truth.y, truth.radius]).all()


def test_a_ball_beyond_the_fold_of_the_lens_has_no_place():
    """At 45 degrees to the axis the distortion of this lens no longer grows."""
    camera = Pinhole.simple(700, distortion=(-1 / 3, 0))
    for x, seen in ((0.8, True), (1.2, False)):
        scene = bench_scene(SceneBall(position=(x, 0.0, 1.0)), pinhole=camera, T_cam_world=np.eye(4))
        assert np.isfinite(render_scene(scene)[1].balls[0].x) == seen


def test_the_nearer_ball_hides_the_farther():
    camera = np.linalg.inv(bench_camera()[1])[:3, 3]
    far = SceneBall(position=(0.4, 0.0, 0.03), colour="blue")
    near = SceneBall(position=tuple(0.7 * np.array(far.position) + 0.3 * camera))
    for objects in ((far, near), (near, far)):
        image, truth = render_scene(bench_scene(*objects))
        red = truth.balls[0]
        assert np.argmax(image[round(red.y), round(red.x)]) == 0
        blue = next(ball for ball in truth.balls if ball.colour == "blue")
        assert np.argmax(image[round(blue.y), round(blue.x)]) == 0


def light_at(image, scene, *points):
    """Mean level around where points (3,) m of the table are seen."""
    pixels = scene.pinhole.project(scene.T_cam_world, np.array(points, dtype=float)).round().astype(int)
    return [image[y - 2 : y + 3, x - 2 : x + 3].mean() for x, y in pixels]


def test_shadow_lies_away_from_the_sun_and_a_patch_where_it_was_laid():
    paper = Patch(position=(0.40, 0.0), size=(0.3, 0.3), colour=(240, 240, 240))
    scene = bench_scene(SceneBall(), patches=(paper,))
    image, _ = render_scene(scene)
    shaded, lit, beside = light_at(image, scene, (0.365, -0.035, 0), (0.46, 0.06, 0), (0.60, 0.2, 0))
    assert shaded < 0.8 * lit and beside < 0.9 * lit


def test_the_arm_that_is_drawn_ends_where_the_tip_is():
    q = np.array([0.3, 0.6, -1.2])
    ends = np.array([stick.end for stick in arm_sticks(q, IR50P)][-2:])
    assert np.allclose(ends.mean(axis=0), forward_kinematics(IR50P, q))


def test_an_unknown_colour_is_refused():
    with pytest.raises(InputError, match=r"colour 'reddish'.*green"):
        render_scene(bench_scene(SceneBall(colour="reddish")))
