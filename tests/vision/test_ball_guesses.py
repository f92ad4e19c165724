"""Guesses where a ball might be, and the edges around them, against plain NumPy and OpenCV."""

import cv2
import numpy as np
import pytest
from drawn_balls import add_ball, add_polygon, empty, photograph

from ir50p_lab.vision import RED, find_balls
from ir50p_lab.vision.ball.edge import cast, contrast_axis, directions, find_edges, slope_kernel
from ir50p_lab.vision.ball.evidence import paint_of
from ir50p_lab.vision.ball.regions import circles_in, circles_through_three, coarse, guess_closer, vote

SEEDS = range(6)


def rays_of(seed):
    """A picture of noise and a disc, and the samples along 60 rays from nearly its middle."""
    rng = np.random.default_rng(seed)
    picture = cv2.GaussianBlur(rng.integers(0, 255, (120, 160, 3), dtype=np.uint8), (0, 0), 2)
    cv2.circle(picture, (70, 60), 25, (200, 30, 40), -1)
    place = np.array([70, 60]) + rng.uniform(-3, 3, 2)
    relative = 1 + np.linspace(-0.7, 1.5, 30, dtype=np.float32)
    return picture, place, relative, cast(picture, *place, np.array([28.0]), relative, directions(60))


@pytest.mark.parametrize("seed", SEEDS)
def test_samples_along_rays_are_those_of_opencv(seed):
    picture, (x, y), _, (rho, rgb, within) = rays_of(seed)
    cos, sin = directions(60)
    px, py = (x + rho * cos[:, None]).astype(np.float32), (y + rho * sin[:, None]).astype(np.float32)
    plain = cv2.remap(picture, px, py, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    assert np.abs(plain.astype(int) - rgb).max() <= 3  # OpenCV counts in 32nds of a pixel
    np.testing.assert_array_equal(within, (px >= -0.5) & (px <= 159.5) & (py >= -0.5) & (py <= 119.5))
    assert 0 < within.mean() < 1


@pytest.mark.parametrize("seed", SEEDS)
def test_contrast_is_fishers(seed):
    *_, (_, rgb, within) = rays_of(seed)
    weights, middle, apart = contrast_axis(rgb, within, 8, 14)
    inside = rgb[:, :8][within[:, :8]].astype(float)
    outside = rgb[:, 14:][within[:, 14:]].astype(float)
    scatter = (np.cov(inside.T, bias=True) + np.cov(outside.T, bias=True)) / 2 + 64 * np.eye(3)
    step = inside.mean(axis=0) - outside.mean(axis=0)
    assert apart**2 == pytest.approx(step @ np.linalg.solve(scatter, step), rel=1e-6)
    assert weights @ step == pytest.approx(1, rel=1e-4)
    assert middle == pytest.approx(weights @ (inside.mean(axis=0) + outside.mean(axis=0)) / 2, rel=1e-3, abs=1e-3)


@pytest.mark.parametrize("seed", SEEDS)
def test_edges_lie_on_the_circle(seed):
    _, (x, y), _, rays = rays_of(seed)
    weights, *_ = contrast_axis(*rays[1:], 8, 14)
    rho, height = find_edges(*rays, weights, slope_kernel(1.2), 9, 4.0)
    cos, sin = directions(60)
    strong = height > 0.3
    off = np.hypot(x + rho * cos - 70, y + rho * sin - 60)[strong] - 25
    assert strong.mean() > 0.9 and np.median(np.abs(off)) < 1


@pytest.mark.parametrize("seed", SEEDS)
def test_a_ball_on_a_tape_is_not_lost_to_the_tapes_long_sides(seed):
    """The outline of both in one: two arcs of a small circle between four long, nearly straight lines."""
    rng = np.random.default_rng(seed)
    radius, angle = rng.uniform(9, 16), rng.uniform(0, np.pi)
    centre, along = np.array([150.0, 150.0]), np.array([np.cos(angle), np.sin(angle)])
    half = 0.45 * radius * np.array([-along[1], along[0]])
    mask = np.zeros((300, 300), np.uint8)
    ends = [centre + side * 110 * along + edge * half for side, edge in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    cv2.fillPoly(mask, [np.round(ends).astype(np.int32)], 255)
    cv2.circle(mask, (150, 150), round(radius), 255, -1)
    (outline,), _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    found = circles_in(outline[:, 0].astype(float), mask.shape, 4.0)
    assert min(np.hypot(x - 150, y - 150) + abs(r - radius) for x, y, r in found) < 0.5 * radius


def test_a_ball_on_a_stick_that_bends_a_little_is_not_lost_to_the_bend():
    """The outline of both lies near a large circle, of which it is a small part. Of 30 at least 28 are guessed."""
    guessed = 0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        radius, bend = rng.uniform(14, 20), rng.uniform(250, 300)
        angle = np.linspace(-0.6, 0.6, 9)
        stick = np.column_stack([bend * np.cos(angle) - bend + 80, bend * np.sin(angle) + 200])
        centre = stick[rng.integers(3, 6)]
        mask = np.zeros((400, 640), np.uint8)
        cv2.polylines(mask, [np.round(stick).astype(np.int32)], False, 255, round(0.5 * radius))
        cv2.circle(mask, np.round(centre).astype(int).tolist(), round(radius), 255, -1)
        (outline,), _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        found = circles_in(outline[:, 0].astype(float), mask.shape, 4.0)
        guessed += min(np.hypot(x - centre[0], y - centre[1]) + abs(r - radius) for x, y, r in found) < 0.3 * radius
    assert guessed >= 28


@pytest.mark.parametrize("seed", SEEDS)
def test_votes_kept_from_a_longer_outline_choose_the_same_circle(seed):
    rng = np.random.default_rng(seed)
    angle = np.arange(120) * (2 * np.pi / 120)
    r = 40 + sum(rng.normal(0, 5) * np.cos(k * angle + rng.uniform(0, 6)) for k in range(2, 6))
    p = np.column_stack([r * np.cos(angle), r * np.sin(angle)]) + 100
    usable, apart = np.ones(120, bool), np.array([4, 8, 16, 32])
    along = -(np.roll(p, -1, axis=0) - np.roll(p, 1, axis=0))
    kept = circles_through_three(p, usable, apart, 4.0, 150.0, -1)
    for _ in range(8):
        x, y, radius = vote(p, along, usable, kept, 1.0)
        fresh = circles_through_three(p, usable, apart, 4.0, 150.0, -1)
        assert (x, y, radius) == vote(p, along, usable, fresh, 1.0)
        usable &= np.abs(np.hypot(*(p - (x, y)).T) - radius) > 0.1 * radius
    assert 0 < usable.sum() < 110


@pytest.mark.parametrize("seed", SEEDS)
def test_the_ball_is_among_the_first_guesses_of_a_cluttered_picture(seed):
    rng = np.random.default_rng(seed)
    light = empty(grain=0.05, seed=seed)
    for _ in range(25):
        corners = rng.uniform((0, 0), (640, 480)) + rng.uniform(-35, 35, (5, 2))
        add_polygon(light, corners, (rng.uniform(0.2, 0.5), 0.05, 0.05))
    centre = rng.uniform((80, 80), (560, 400))
    add_ball(light, 700, centre, 24)
    picture = photograph(light, seed=seed)
    guesses = guess_closer(picture, coarse(picture, RED), RED, 6.0)
    near = [np.hypot(x - centre[0], y - centre[1]) < 8 and abs(r - 24) < 8 for x, y, r in guesses]
    assert len(guesses) > 10 and any(near[:5])


@pytest.mark.parametrize("seed", SEEDS)
def test_gloss_makes_no_skin_of_a_red(seed):
    """Half of the disc is paled by gloss: the purest fifth tells; skin is pale everywhere."""
    rng = np.random.default_rng(seed)
    red, skin = np.zeros((2, 400, 3), np.uint8)
    for disc, saturation in ((red, np.linspace(60, 220, 400)), (skin, np.full(400, 115.0))):
        disc[:, 0] = 110 - rng.integers(0, 3, 400)
        disc[:, 1] = np.clip(saturation + rng.normal(0, 8, 400), 0, 255)
        disc[:, 2] = rng.normal(120, 8, 400)
    assert paint_of(red, RED.centre, RED.swaps)[1] > 0.65
    assert paint_of(skin, RED.centre, RED.swaps)[1] < 0.6


def test_a_picture_of_a_few_pixels():
    for shape in ((1, 1, 3), (2, 2, 3)):
        picture = np.zeros(shape, np.uint8)
        picture[..., 0] = 200
        assert find_balls(picture) == []
