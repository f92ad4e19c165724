"""Hard pictures of a desk, drawn from a seed: with a red ball or with what is taken for one, in all kinds of light.

Each number is a choice: what webcam pictures of a student's desk differ in. Later changes may only make it broader.
"""

import colorsys

import cv2
import numpy as np

from ir50p_lab.vision import Pinhole, render_scene
from ir50p_lab.vision.rendering import Patch, Scene, SceneBall, Stick, look_at

SIZES = ((320, 240), (640, 480), (800, 600))
RADIUS = (8.0, 80.0)  # px, of the ball's image; even in the logarithm
TABLES = ((110, 75, 50), (225, 222, 215), (128, 128, 128), (45, 45, 48), (60, 105, 85), (70, 90, 130), (150, 90, 65))


def random_picture(seed, kind="ball"):
    """(image, SceneTruth) number `seed`. kind: 'ball', a red one, first of the truth's, at least 60 % of it to be seen;
    'no_ball', one to five other things."""
    rng = np.random.default_rng([seed, kind == "ball"])
    scene = _scene(rng, kind == "ball")
    while kind == "ball" and not _well_seen(scene):
        scene = _scene(rng, True)
    image, truth = render_scene(scene, seed=seed)
    return _photographed(rng, image, truth.balls[0].radius if kind == "ball" else 20.0), truth


def _scene(rng, with_ball):
    width, height = SIZES[rng.choice(3, p=(0.2, 0.6, 0.2))]
    f = width / 2 / np.tan(np.radians(rng.uniform(40, 75)) / 2)
    radius = rng.uniform(0.015, 0.04)  # table tennis ball 20 mm, thesis 30 mm, tennis ball 33 mm
    red = _paint(rng.uniform(-10, 8), rng.uniform(0.72, 0.97), rng.uniform(0.45, 0.92))
    x, y, z = rng.uniform((0.0, -0.25, 0), (0.5, 0.25, 0.1))
    ball = SceneBall(position=(x, y, radius + z * (z > 0.085)), radius=radius, colour=red, gloss=rng.uniform(0, 0.8))
    far = f * radius / np.exp(rng.uniform(*np.log((RADIUS[0], min(RADIUS[1], 0.36 * height)))))
    up, round_about = np.radians(rng.uniform(15, 80)), rng.uniform(-np.pi, np.pi)
    eye = ball.position + far * np.array(
        [np.cos(up) * np.cos(round_about), np.cos(up) * np.sin(round_about), np.sin(up)]
    )
    aside = rng.uniform(-0.4, 0.4, 2) * far * height / f
    target = ball.position + np.array([*aside, 0.0])
    things = [_thing(rng, ball, eye, far) for _ in range(rng.integers(0, 4) if with_ball else rng.integers(1, 6))]
    if with_ball:
        things.append(ball)
        if rng.random() < 0.25:
            things.append(_hider(rng, ball, eye))
    flat = [one for one in things if isinstance(one, Patch)]
    if rng.random() < 0.7:  # another table than wood
        flat.insert(0, Patch(position=(0.25, 0.0), size=(1.7, 1.6), colour=TABLES[rng.integers(len(TABLES))]))
    return Scene(
        pinhole=Pinhole.simple(f, (width, height), (rng.uniform(-0.2, 0.05), rng.uniform(0, 0.05))),
        T_cam_world=look_at(eye, target),
        objects=tuple(sorted((one for one in things if not isinstance(one, Patch)), key=lambda one: one is not ball)),
        patches=tuple(flat),
        exposure=float(np.exp(rng.uniform(np.log(0.4), np.log(1.6)))),
    )


def _thing(rng, ball, eye, far):
    """What lies beside the ball: tape, a stain, a pen or cable, another ball, fingers; half of them red."""
    size = ball.radius * rng.uniform(0.5, 2)
    angle, turn = rng.uniform(0, 2 * np.pi, 2)
    away = (ball.radius + size) * rng.uniform(1.3, 6)
    x, y = ball.position[:2] + away * np.array([np.cos(angle), np.sin(angle)])
    red = _paint(rng.uniform(-14, 12), rng.uniform(0.6, 0.97), rng.uniform(0.4, 0.92))
    other = _paint(
        rng.choice((rng.uniform(20, 34), rng.uniform(45, 295))), rng.uniform(0.4, 0.95), rng.uniform(0.3, 0.95)
    )
    skin = _paint(rng.uniform(10, 26), rng.uniform(0.25, 0.6), rng.uniform(0.35, 0.92))
    what = rng.choice(["tape", "stain", "pen", "ball", "finger"], p=(0.25, 0.1, 0.2, 0.25, 0.2))
    if what == "tape":
        return Patch(position=(x, y), size=(size * rng.uniform(2, 12), rng.uniform(0.01, 0.03)), angle=turn, colour=red)
    if what == "stain":
        return Patch(position=(x, y), size=(3.6 * size, 1.5 * size), angle=turn, colour=red, round=True)
    if what == "ball":
        return SceneBall(position=(x, y, size), radius=size, colour=other, gloss=rng.uniform(0, 0.7))
    r = rng.uniform(0.003, 0.009) if what == "pen" else rng.uniform(0.008, 0.012)
    # end-on a round stick is a ball: they are laid across the view
    turn = np.arctan2(eye[1] - y, eye[0] - x) + np.pi / 2 + rng.uniform(-0.7, 0.7)
    half = r * rng.uniform(5, 14) * np.array([np.cos(turn), np.sin(turn)])
    ends = [(*(np.array((x, y)) + side * half), r) for side in (-1, 1)]
    return Stick(start=ends[0], end=ends[1], radius=r, colour=red if what == "pen" else skin, gloss=rng.uniform(0, 0.5))


def _hider(rng, ball, eye):
    """A stick between camera and ball that hides up to 40 % of it."""
    view = (eye - ball.position) / np.linalg.norm(eye - ball.position)
    side = np.cross(view, (0, 0, 1.0))
    side /= np.linalg.norm(side)
    turn, r = rng.uniform(0, 2 * np.pi), ball.radius * rng.uniform(0.3, 1.2)
    out, along = (np.cos(a) * side + np.sin(a) * np.cross(side, view) for a in (turn, turn + np.pi / 2))
    middle = ball.position + 1.5 * (ball.radius + r) * view + (ball.radius * rng.uniform(0.2, 1.0) + r) * out
    half = 6 * ball.radius * along
    colour = _paint(rng.uniform(30, 300), rng.uniform(0, 0.5), rng.uniform(0.1, 0.9))
    return Stick(start=tuple(middle - half), end=tuple(middle + half), radius=r, colour=colour)


def _well_seen(scene):
    """Whether most of the first ball lies in the picture, in the wanted size, and no other ball before it."""
    balls = [one for one in scene.objects if isinstance(one, SceneBall)]
    T, (width, height) = scene.T_cam_world, scene.pinhole.size
    centres = np.array([T[:3, :3] @ one.position + T[:3, 3] for one in balls])
    if (centres[:, 2] < 0.05).any():
        return False
    (x, y), *others = scene.pinhole.project(np.eye(4), centres)
    radius, *radii = scene.pinhole.fx * np.array([one.radius for one in balls]) / np.linalg.norm(centres, axis=1)
    inside = abs(x - width / 2) < width / 2 + 0.2 * radius and abs(y - height / 2) < height / 2 + 0.2 * radius
    apart = (np.hypot(*(one - (x, y))) - radius - r for one, r in zip(others, radii, strict=True))
    return RADIUS[0] < radius < RADIUS[1] and inside and all(gap > -0.3 * radius for gap in apart)


def _photographed(rng, image, radius):
    """The picture in coloured light, a little out of focus or shaken, noisy, compressed."""
    warm = rng.uniform(-0.3, 0.7)
    light = image * (np.array([1 + 0.08 * warm, 1.0, 1 - 0.25 * warm]) * rng.uniform(0.95, 1.05, 3))
    light = cv2.GaussianBlur(light, (0, 0), rng.uniform(0.2, max(0.4, min(0.12 * radius, 2.0))))
    light += rng.uniform(0, 7) * rng.standard_normal(light.shape)
    data = cv2.imencode(".jpg", np.clip(light[..., ::-1], 0, 255).astype(np.uint8), (1, int(rng.integers(50, 96))))[1]
    return np.ascontiguousarray(cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1])


def _paint(hue_deg, saturation, value):
    return tuple(255 * c for c in colorsys.hsv_to_rgb(hue_deg / 360 % 1, saturation, value))
