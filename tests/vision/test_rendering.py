"""Rendered pictures against their truth, by routes that share no code with the renderer."""

from dataclasses import replace
from functools import cache

import cv2
import numpy as np
import pytest

from ir50p_lab.errors import InputError
from ir50p_lab.vision import Charuco, Pinhole
from ir50p_lab.vision.rendering import (
    Lens,
    Patch,
    SceneBall,
    Sky,
    Sun,
    Tabletop,
    bench_camera,
    bench_scene,
    pose,
    render_scene,
)
from ir50p_lab.vision.rendering.colours import to_bytes, to_linear, to_srgb
from ir50p_lab.vision.rendering.render import table_light
from ir50p_lab.vision.rendering.sensor import expose
from tests.support.desk import TEXTURES, BentBoard, BentSheetShape, Box, LinearSensor, disc, mosaic, streak
from tests.support.drawn_board import NO_TABLE, Board
from tests.support.random_scene import SIZES, random_scene
from tests.support.scene_truth import scene_truth


def clean(scene, exposure=1.0):
    """The scene through a perfect lens and sensor: sharp, no noise, no JPEG, bytes proportional to light."""
    sensor = LinearSensor(read_noise=0.0, shot_noise=0.0, jpeg=None, exposure=exposure)
    return replace(scene, lens=Lens(sigma=0.0, vignetting=0.0), sensor=sensor)


PLAIN = Tabletop(contrast=0.0)
ON_TABLE = np.diag([1.0, -1.0, -1.0, 1.0])


def test_same_seed_same_bytes():
    scene = bench_scene()
    first, other = render_scene(scene, seed=3)[0], render_scene(scene, seed=4)[0]
    assert first.shape == (480, 640, 3) and first.dtype == np.uint8
    assert (first == render_scene(scene, seed=3)[0]).all() and (first != other).any()


def aligned(corners, truth):
    """Corners in the order of the truth: a finder may start at the other end of a board."""
    return corners[::-1] if np.linalg.norm(corners[0] - truth[0]) > np.linalg.norm(corners[-1] - truth[0]) else corners


def corners_by_opencv(scene, sigma=0.7):
    image, _ = render_scene(replace(clean(scene), lens=Lens(sigma=sigma, vignetting=0)))
    truth = scene_truth(scene)
    grey = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    found, corners = cv2.findChessboardCorners(grey, (9, 6))
    assert found
    corners = cv2.cornerSubPix(grey, corners, (5, 5), (-1, -1), (cv2.TERM_CRITERIA_EPS, 100, 1e-5))[:, 0]
    return aligned(corners, truth.boards[0].corners) - truth.boards[0].corners


# the corner finder itself errs by 0.025 pixels (rms) whatever the picture: on four times as many pixels by a quarter
@pytest.mark.parametrize(("scale", "rms", "bias"), [(1, 0.045, 0.012), (3, 0.025, 0.008)])
def test_corners_agree_with_opencv(scale, rms, bias):
    board = Board(T_world_board=pose((0.5, 0.08, 0.35), (0.1, 0.2, 0.3)) @ ON_TABLE)
    scene = bench_scene(board, table=PLAIN)
    error = corners_by_opencv(replace(scene, pinhole=scene.pinhole.scaled((640 * scale, 480 * scale)))) / scale
    assert np.sqrt(np.mean(error**2)) < rms and np.abs(error.mean(axis=0)).max() < bias
    assert np.abs(error).max() < (0.12 if scale == 1 else 0.05)


def test_board_lies_where_the_truth_says_by_opencv():
    board = Board(T_world_board=pose((0.28, 0.08, 0.0)) @ ON_TABLE)
    truth = scene_truth(bench_scene(board)).boards[0]
    R, t = truth.T_cam_board[:3, :3], truth.T_cam_board[:3, 3]
    K, distortion = bench_camera()[0].K, bench_camera()[0].distortion
    theirs, _ = cv2.projectPoints(truth.object_points, cv2.Rodrigues(R)[0], t, K, distortion)
    assert np.abs(theirs[:, 0] - truth.corners).max() < 1e-6
    assert truth.inside.all()


def test_bent_board_keeps_its_arc_length_and_shows_its_corners():
    board = BentBoard(T_world_board=pose((0.5, 0.08, 0.35)) @ ON_TABLE, bend=1.5)
    flat = replace(board, bend=0.0)
    error = corners_by_opencv(bench_scene(board, table=PLAIN))
    assert np.sqrt(np.mean(error**2)) < 0.06
    moved = scene_truth(bench_scene(board)).boards[0].corners - scene_truth(bench_scene(flat)).boards[0].corners
    assert np.abs(moved).max() > 1
    u = np.linspace(0, 0.2, 2001)
    X = BentSheetShape(np.eye(4), (0, 0.2), (0, 0.1), 1.5).place(u, 0 * u)
    assert np.linalg.norm(np.diff(X, axis=0), axis=1).sum() == pytest.approx(0.2, abs=1e-7)


def test_charuco_board_is_read_by_opencv():
    board = Board(T_world_board=pose((0.5, 0.08, 0.35), (0.1, 0.2, 0.3)) @ ON_TABLE, kind="charuco")
    image, truth = render_scene(replace(clean(bench_scene(board, table=PLAIN)), lens=Lens(vignetting=0)))
    truth = scene_truth(truth.scene)
    detector = cv2.aruco.CharucoDetector(Charuco(board.pattern, board.square, board.marker, board.dictionary).opencv())
    corners, numbers, _, _ = detector.detectBoard(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY))
    assert len(numbers) == 54
    error = corners[:, 0] - truth.boards[0].corners[numbers.ravel()]
    assert np.median(np.abs(error)) < 0.06 and np.abs(np.median(error, axis=0)).max() < 0.03


def coverage(ball, **camera):
    """Part (h, w) of each pixel that a black ball hides of a bright room: one minus the quotient of two pictures."""
    scene = bench_scene(
        replace(ball, colour=(0, 0, 0), gloss=0.0), table=NO_TABLE, lights=(Sky(strength=0.0),), **camera
    )
    scene = clean(scene, exposure=3.0)
    with_ball, _ = render_scene(scene)
    without, _ = render_scene(replace(scene, objects=()))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.nan_to_num(1 - with_ball[..., 1] / without[..., 1].astype(float)), scene_truth(scene).balls[0]


@pytest.mark.parametrize(
    "ball",
    [
        SceneBall(),
        SceneBall(position=(0.35, 0.25, 0.03)),
        SceneBall(position=(0.85, -0.05, 0.45), radius=0.02),
        SceneBall(position=(0.6, -0.26, 0.015), radius=0.015),
    ],
)
def test_outline_of_a_ball_is_where_the_truth_says(ball):
    # lens of the bench, but stronger: the outline is no ellipse then
    camera = bench_camera()[0]
    part, truth = coverage(ball, pinhole=Pinhole(camera.K, (-0.3, 0.12, 0.002, -0.001), camera.size))
    y, x = np.mgrid[: part.shape[0], : part.shape[1]]
    assert np.sum(part * x) / part.sum() == pytest.approx(truth.outline_x, abs=0.02)
    assert np.sum(part * y) / part.sum() == pytest.approx(truth.outline_y, abs=0.02)
    assert np.sqrt(part.sum() / np.pi) == pytest.approx(truth.radius, abs=0.02)
    assert truth.visible == 1.0


def test_centre_of_a_ball_is_its_projection_not_the_middle_of_its_outline():
    ball = SceneBall(position=(0.85, -0.20, 0.45), radius=0.03)  # near the camera and aside: the worst case
    (camera, T), truth = bench_camera(), scene_truth(bench_scene(ball)).balls[0]
    theirs, _ = cv2.projectPoints(
        np.array([ball.position]), cv2.Rodrigues(T[:3, :3])[0], T[:3, 3], camera.K, camera.distortion
    )
    assert (truth.x, truth.y) == pytest.approx(theirs[0, 0])
    assert np.hypot(truth.x - truth.outline_x, truth.y - truth.outline_y) > 0.5


def test_visible_part():
    ball = SceneBall(position=(0.4, 0.0, 0.03))
    half = Box(T_world_box=look_from_camera(ball), size=(1.0, 0.5, 0.001))  # its edge runs through the ball's centre
    truth = scene_truth(bench_scene(ball, half)).balls[0]
    assert truth.visible == pytest.approx(0.5, abs=0.02)
    camera = bench_camera()[0]
    shifted = np.array(camera.K)
    shifted[0, 2] -= truth.outline_x + 0.5  # the border of the picture runs through the middle of its outline
    cut = scene_truth(bench_scene(ball, pinhole=Pinhole(shifted, (), camera.size))).balls[0]
    assert cut.visible == pytest.approx(0.5, abs=0.03)
    assert scene_truth(bench_scene(replace(ball, position=(2.0, 0.0, 0.03)))).balls[0].visible == 0  # behind


def look_from_camera(ball):
    """Pose of a card between camera and ball whose edge is on the line of sight."""
    T_world_cam = np.linalg.inv(bench_camera()[1])
    centre = np.linalg.inv(T_world_cam) @ (*ball.position, 1)
    near = centre[:3] * 0.9
    return T_world_cam @ pose(near + np.array((0, 0.25, 0)))


def test_the_nearer_ball_hides_the_farther():
    camera = np.linalg.inv(bench_camera()[1])[:3, 3]
    far = SceneBall(position=(0.4, 0.0, 0.03), colour="blue")
    near = SceneBall(position=tuple(0.7 * np.array(far.position) + 0.3 * camera))
    for objects in ((far, near), (near, far)):
        truth = scene_truth(bench_scene(*objects))
        seen = {ball.colour: ball.visible for ball in truth.balls}
        assert seen["red"] == 1 and seen["blue"] < 0.05
    assert [ball.colour for ball in truth.red_balls] == ["red"]


def test_shadow_lies_away_from_the_sun_and_under_the_ball():
    lights = (Sky(strength=0.3), Sun(towards=(0.0, 1.0, 1.0), strength=0.7, softness=0.01))
    table = Tabletop(contrast=0.0, colour="white")
    scene = clean(bench_scene(SceneBall(), lights=lights, table=table))
    lit = np.diff([table_light(scene, np.array([0.4]), np.array([y]))[0, 1] for y in (-0.03, 0.2)])
    hidden_sky = 0.3 * 0.03 * 0.03**2 / np.hypot(0.03, 0.03) ** 3
    assert lit[0] == pytest.approx(0.7 / np.sqrt(2) + hidden_sky, rel=0.01)
    # sky only: the light under a ball is what a hemisphere of directions leaves, counted ray by ray
    rng = np.random.default_rng(0)
    u, phi = rng.random(400_000), rng.uniform(0, 2 * np.pi, 400_000)
    d = np.stack([np.sqrt(u) * np.cos(phi), np.sqrt(u) * np.sin(phi), np.sqrt(1 - u)], axis=1)  # by cosine
    for y in (0.031, 0.05, 0.1):
        centre = np.array([0, -y, 0.03])
        along = d @ centre
        hidden = np.mean((along > 0) & (centre @ centre - along**2 < 0.03**2))
        sky = replace(scene, lights=(Sky(strength=1.0),))
        light = table_light(sky, np.array([0.4]), np.array([y]))[0, 0]
        assert light == pytest.approx(1 - hidden, abs=0.02)


def test_tone_curve_and_its_inverse():
    light = np.linspace(0, 1, 1001)
    assert to_linear(to_srgb(light)) == pytest.approx(light, abs=1e-12)
    exact = np.rint(255 * to_srgb(light))
    assert np.abs(to_bytes(light.astype(np.float32)) - exact).max() <= 1
    assert (to_bytes(np.float32([-1, 2])) == (0, 255)).all()


@pytest.mark.parametrize(
    "kernel", [disc(0.001), disc(0.5), disc(3.0), disc(7.3), streak(4, 0), streak(-3, 5.5), streak(0.1, 0.1)]
)
def test_blur_moves_nothing(kernel):
    n = kernel.shape[0] // 2
    y, x = np.mgrid[-n : n + 1, -n : n + 1]
    assert kernel.sum() == pytest.approx(1, abs=1e-6)
    assert (np.sum(kernel * x), np.sum(kernel * y)) == pytest.approx((0, 0), abs=1e-6)


def test_disc_and_streak_are_as_wide_as_asked():
    x = np.arange(-10, 11)
    kernel = np.pad(disc(9.0), (10 - disc(9.0).shape[0] // 2,))
    assert np.sum(kernel * x * x) == pytest.approx(4.5**2 / 4 + 1 / 12, rel=0.01)  # a disc's r^2 / 4, and the pixel
    assert np.sum(streak(6, 0) * np.mgrid[-4:5, -4:5][1] ** 2) == pytest.approx(6**2 / 12 + 1 / 6, rel=0.02)


def test_mosaic_shifts_nothing_and_keeps_even_areas():
    y, x = np.mgrid[:60, :80]
    spot = np.exp(-((x - 40.3) ** 2 + (y - 29.6) ** 2) / 50)
    light = np.stack([spot, 0.5 * spot, 0.2 * spot], axis=-1).astype(np.float32)
    for channel in range(3):
        filled = mosaic(light)[..., channel]
        assert np.sum(filled * x) / filled.sum() == pytest.approx(40.3, abs=0.01)
        assert np.sum(filled * y) / filled.sum() == pytest.approx(29.6, abs=0.01)
    even = np.full((8, 8, 3), 0.4, np.float32)
    assert mosaic(even) == pytest.approx(even)


def test_noise_has_the_size_asked_for():
    sensor = LinearSensor(read_noise=0.01, shot_noise=0.02, jpeg=None)
    for level in (0.05, 0.5):
        image = expose(np.full((200, 200, 3), level, np.float32), sensor, np.random.default_rng(0))
        wanted = 255 * np.sqrt(0.01**2 + 0.02**2 * level)
        assert image.std() == pytest.approx(np.sqrt(wanted**2 + 1 / 12), rel=0.02)


def test_fast_enough_for_a_thousand_scenes(benchmark):
    scene = bench_scene()
    image, _ = benchmark(render_scene, scene)
    assert image.shape == (480, 640, 3)


REFUSED = [
    (lambda: SceneBall(radius=0), "radius = 0"),
    (lambda: SceneBall(position=(1, 2)), "position has shape"),
    (lambda: render_scene(bench_scene(SceneBall(colour="reddish"))), "colour 'reddish'"),
    (lambda: render_scene(bench_scene(patches=(Patch(outline="star"),))), "outline 'star'"),
    (lambda: bench_scene(pinhole=np.eye(3)), "Pinhole"),
    (lambda: bench_scene(T_cam_world=np.zeros((4, 4))), "rigid"),
    (lambda: render_scene(bench_scene("ball")), "none of the objects"),
    (lambda: render_scene(bench_scene(pinhole=Pinhole.simple(300, distortion=(-0.9, 0)))), "sends no ray"),
]


@pytest.mark.parametrize(("make", "words"), REFUSED)
def test_refusals(make, words):
    with pytest.raises(InputError, match=words):
        make()


@cache
def truth_of(seed, kind):
    return scene_truth(random_scene(seed, kind))


@pytest.mark.parametrize("kind", ["ball", "no_ball", "several", "hidden"])
def test_scenes_keep_what_their_kind_promises(kind):
    for seed in range(12):
        truth = truth_of(seed, kind)
        red = truth.red_balls
        if kind == "no_ball":
            assert not red and (truth.scene.objects or truth.scene.patches)
            continue
        low, high = (0.2, 0.6) if kind == "hidden" else (0.6, 1.01)
        assert red and all(low <= ball.visible < high and 8 <= ball.radius <= 80 for ball in red)


def test_random_scenes_are_as_wide_as_meant():
    truths = [truth_of(seed, "ball") for seed in range(60)]
    scenes, balls = [truth.scene for truth in truths], [truth.red_balls[0] for truth in truths]
    assert {scene.pinhole.size for scene in scenes} == set(SIZES)
    assert {scene.table.texture for scene in scenes} == set(TEXTURES.values())
    radius = np.array([ball.radius for ball in balls])
    assert radius.min() < 10 and radius.max() > 65 and 15 < np.median(radius) < 40
    assert 0.1 < np.mean([ball.visible < 0.99 for ball in balls]) < 0.5
    hues = np.array([ball.colour[2] > ball.colour[1] for ball in balls])
    assert 0.3 < hues.mean() < 0.8  # both sides of the seam of the hue circle


@pytest.mark.parametrize("kind", ["ball", "no_ball"])
def test_random_scenes_can_be_drawn_and_red_is_where_the_ball_is(kind):
    drawn = 0
    for seed in range(15):
        scene = truth_of(seed, kind).scene
        width, height = scene.pinhole.size
        if width > 640:
            continue
        image, _ = render_scene(scene, seed)
        assert image.shape == (height, width, 3) and 3 < image.mean() < 254
        for ball in truth_of(seed, kind).red_balls:
            y, x = np.mgrid[:height, :width]
            inside = np.hypot(x - ball.outline_x, y - ball.outline_y) < 0.8 * ball.radius
            r, g, b = np.median(image[inside], axis=0)
            drawn += r > 1.2 * max(g, b)
    assert drawn >= 6 or kind == "no_ball"
