"""The scenes that the ball detector is measured on, drawn from a seed: frozen before any detector is tuned on them.

Each number is a choice with its reason beside it: what webcam pictures of a student's desk differ in. Later changes may
only make it broader.
"""

from dataclasses import replace

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.pinhole import Pinhole
from ir50p_lab.vision.rendering.places import look_at
from ir50p_lab.vision.rendering.scene import Scene, SceneBall
from tests.support.random_light import random_lens, random_lights, random_sensor
from tests.support.random_things import distractor, hider, random_red, random_table
from tests.support.scene_truth import scene_truth

KINDS = {
    "ball": "one red ball, at least 60 % visible, with or without distractors",
    "no_ball": "no red ball, one to five distractors",
    "several": "one to three red balls at least 60 % visible, and balls of other colours",
    "hidden": "one red ball of which 20 to 60 % are visible: a miss is forgiven, a wrong place is not",
}

# What is in use: phone crops and small classic pictures, VGA webcams most of all (thesis 5.3), HD webcams.
SIZES = ((224, 224), (320, 240), (640, 480), (800, 600), (1280, 720), (1920, 1080))
SIZE_SHARES = (0.10, 0.10, 0.45, 0.10, 0.15, 0.10)

RADIUS = (8.0, 80.0)  # pixels, of the image of the ball; even in the logarithm, so that small ones are as common
VISIBLE = {"ball": 0.6, "several": 0.6, "hidden": 0.2}
_TRIES = 200


def random_scene(seed, kind="ball"):
    """Scene number `seed` of one of the KINDS: the same for the same seed (and the same version of NumPy).

    Returns a Scene; its red balls have colours of their own (`random_red`): `is_red` of a SeenBall tells them.
    Raises InputError for an unknown kind.
    """
    if kind not in KINDS:
        raise InputError(f"kind = {kind!r}: give one of {', '.join(KINDS)}")
    rng = np.random.default_rng([int(seed), sorted(KINDS).index(kind)])
    for _ in range(_TRIES):
        scene, ball = _draw(rng, kind)
        if scene is not None and _as_promised(scene, kind):
            return _through_camera(rng, scene, ball)
    raise InputError(f"no scene of kind {kind!r} came out of seed {seed} in {_TRIES} tries: take another seed")


def _draw(rng, kind):
    size = SIZES[rng.choice(len(SIZES), p=SIZE_SHARES)]
    pinhole = random_pinhole(rng, size)
    ball = SceneBall(
        position=(rng.uniform(0.25, 0.55), rng.uniform(-0.25, 0.25), 0.0),
        radius=rng.uniform(0.015, 0.04),  # table tennis ball 20 mm, thesis 30 mm, tennis ball 33 mm
        colour=random_red(rng),
        # foam and felt to lacquered wood and wet plastic
        gloss=rng.choice([0.0, rng.uniform(0.05, 0.8)], p=[0.25, 0.75]),
        shininess=float(np.exp(rng.uniform(np.log(8), np.log(300)))),
    )
    # 15 % are not on the table, but in a hand or gripper, or on their way down
    height = ball.radius + (rng.uniform(0, 0.15) if rng.random() < 0.15 else 0.0)
    ball = replace(ball, position=(*ball.position[:2], height))
    T_cam_world = _see(rng, pinhole, ball)
    if T_cam_world is None:
        return None, None
    lights = random_lights(rng, ball.position)
    scene = Scene(
        pinhole=pinhole,
        T_cam_world=T_cam_world,
        table=random_table(rng, ball.position),
        lights=lights,
        texture_seed=int(rng.integers(1 << 30)),
    )
    return _furnish(rng, kind, scene, ball), ball


def _through_camera(rng, scene, ball):
    radius = scene.pinhole.fx * ball.radius / np.linalg.norm(ball.position - _place(scene.T_cam_world))
    scene = replace(scene, lens=random_lens(rng, radius, scene.pinhole.size))
    return replace(scene, sensor=random_sensor(rng, scene, ball.position))


def random_pinhole(rng, size):
    """A webcam of this picture size: 40 to 75 deg across, pixels square within 1 %, axis near the middle."""
    width, height = size
    f = width / 2 / np.tan(np.radians(rng.uniform(40, 75)) / 2)
    corner = np.hypot(width, height) / 2 / f
    # barrel more often than pincushion; up to 8 % at the corner, whatever the angle; the second term takes some back
    k1 = rng.uniform(-0.08, 0.02) / corner**2
    k2 = -rng.uniform(0.0, 0.4) * k1 / corner**2
    K = np.diag([f, f * rng.uniform(0.99, 1.01), 1.0])
    K[0, 2] = (width - 1) / 2 + rng.normal(0, 0.01) * width
    K[1, 2] = (height - 1) / 2 + rng.normal(0, 0.01) * width
    return Pinhole(K, (k1, k2, *rng.normal(0, 5e-4, 2)), size)


def _see(rng, pinhole, ball):
    """T_cam_world that shows the ball with a radius drawn from RADIUS at a place drawn over the picture."""
    width, height = pinhole.size
    top = min(RADIUS[1], 0.36 * min(width, height))
    radius = np.exp(rng.uniform(np.log(RADIUS[0]), np.log(top)))
    out = 0.5 * radius if rng.random() < 0.3 else -1.1 * radius  # 30 % may touch the border
    x, y = rng.uniform((-out, -out), (width - 1 + out, height - 1 + out))
    try:
        ray = pinhole.rays((x, y))
    except InputError:
        return None
    # f R / distance at the axis; aside from it the image grows by 1 / cos on the average
    distance = pinhole.fx * ball.radius / radius / ray[2] ** 1.5
    # from leaning over the desk (nearly straight down) to a webcam on a laptop's screen
    elevation, azimuth = np.radians(rng.uniform(15, 85)), rng.uniform(-np.pi, np.pi)
    centre = np.asarray(ball.position)
    eye = centre + distance * np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
    T = look_at(eye, centre)
    roll = np.radians(rng.normal(0, 5))  # hand-held, or a stand that is not level
    c, s = np.cos(roll), np.sin(roll)
    T[:3] = _turn((0.0, 0.0, 1.0), ray) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ T[:3]
    return T


def _turn(a, b):
    """The smallest rotation that takes unit vector a to unit vector b."""
    v, c = np.cross(a, b), float(np.dot(a, b))
    V = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + V + V @ V / (1 + c)


def _place(T):
    return -T[:3, :3].T @ T[:3, 3]


def _furnish(rng, kind, scene, ball):
    """The scene with its balls, distractors, and what hides a part."""
    camera = _place(scene.T_cam_world)
    objects, patches = [], []
    if kind != "no_ball":
        objects.append(ball)
    # a third of the ball scenes have nothing else on the table; pictures without ball always have something
    number = rng.integers(1, 6) if kind == "no_ball" else rng.choice([0, 1, 2, 3, 4], p=[0.34, 0.26, 0.2, 0.12, 0.08])
    for _ in range(number):
        things, flat = distractor(rng, camera, ball, near=kind != "no_ball")
        objects += things
        patches += flat
    if kind == "several":
        for _ in range(rng.integers(1, 4)):
            red = rng.random() < 0.4
            things, flat = distractor(rng, camera, ball, near=True, what="red ball" if red else "ball")
            objects += things
            patches += flat
    if kind == "hidden" or (kind in VISIBLE and rng.random() < 0.25):
        objects += hider(rng, camera, ball)
    return replace(scene, objects=tuple(objects), patches=tuple(patches))


def _as_promised(scene, kind):
    if kind == "no_ball":
        return True
    red = [ball for ball in scene_truth(scene).balls if ball.is_red]
    low = VISIBLE[kind]
    high = 0.6 if kind == "hidden" else 1.01
    return all(low <= ball.visible < high and RADIUS[0] <= ball.radius <= RADIUS[1] for ball in red)
