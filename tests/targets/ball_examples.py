"""Examples for the classifier of the ball detector: what the search proposes in rendered scenes, and in changed copies of them.

The copies differ in size, light, sharpness, noise, compression, in what hides a part and where the picture ends, and
into some shapes are painted: the classifier is to know a ball, not the renderer.
"""

import cv2
import numpy as np

from ir50p_lab.vision import RED, Colour, render_scene
from ir50p_lab.vision.ball.classifier import measures, rays_of
from ir50p_lab.vision.ball.evidence import NoBallError, check_colour
from ir50p_lab.vision.ball.fit import view_of
from ir50p_lab.vision.ball.measure import measure
from ir50p_lab.vision.ball.regions import coarse, guess_circles, guess_closer
from tests.support.random_scene import random_scene
from tests.support.scene_truth import scene_truth
from tests.targets.crowded_scene import crowded_scene

LEAST_RADIUS = 6.0
BALL, NEARLY, NOTHING, UNCLEAR = 1, 2, 0, -1  # NEARLY: of a ball, the outline a little off
_COPIES = {"ball": 4, "no_ball": 3}  # of each scene, changed


def scene(seed, kind, draw=random_scene):
    """Picture of a scene, and its red balls (n, 4): x, y, radius, visible share; draw: function of seed and kind."""
    image, truth = render_scene(draw(seed, kind), seed=seed)
    balls = [(b.x, b.y, b.radius, b.visible) for b in scene_truth(truth.scene).red_balls]
    return image, np.array(balls).reshape(-1, 4)


def examples(seed, kind, *, shapes=True):
    """Rays (n, 32, channels), measures (n, m) and labels (n,) of one scene and of changed copies of it.

    shapes: whether shapes are painted into a scene without a ball, too.
    """
    rng = np.random.default_rng([seed, kind == "ball", 77])
    image, balls = scene(seed, kind)
    guesses = _guesses(image, most=18)
    found = _look(image, guesses, balls, RED)
    for _ in range(_COPIES[kind]):
        found += _look(*_changed(rng, image, guesses, balls), _another_red(rng))
    if shapes and kind == "no_ball":
        found += painted(seed) + behind(seed)
    return found


def crowded_examples(seed, kind, *, copies=2):
    """As `examples`, of a crowded scene: small pictures that show much of what is easily taken for a ball."""
    rng = np.random.default_rng([seed, kind == "ball", 80])
    image, balls = scene(seed, kind, crowded_scene)
    guesses = _guesses(image, most=30)
    found = _look(image, guesses, balls, RED)
    for _ in range(copies):
        found += _look(*_changed(rng, image, guesses, balls, most=20), _another_red(rng))
    return found


def _guesses(image, most):
    return np.concatenate(
        [guess(image, coarse(image, RED), RED, LEAST_RADIUS)[:most] for guess in (guess_circles, guess_closer)]
    )


def _look(image, guesses, balls, colour):
    view, known, found = view_of(image.shape), [], []
    for guess in guesses:
        try:
            check_colour(image, tuple(guess), colour)
            m = measure(image, tuple(guess), view, colour, least_radius=LEAST_RADIUS)
        except NoBallError:
            continue
        o = m.outline
        if any(np.hypot(o.x - x, o.y - y) + abs(o.r - r) < 0.05 * r for x, y, r in known):
            continue
        known.append((o.x, o.y, o.r))
        label = _label(o, balls)
        if label != UNCLEAR:
            found.append((rays_of(m).astype(np.float16), measures(m), label))
    return found


def _label(o, balls):
    for x, y, r, visible in balls:
        off, misfit = np.hypot(o.x - x, o.y - y), abs(o.r - r)
        if off < max(1.2, 0.10 * r) and misfit < max(1.0, 0.13 * r):
            return BALL if visible >= 0.57 else UNCLEAR
        if off < 0.6 + 0.25 * r and misfit < 0.6 + 0.25 * r and visible >= 0.57:
            return NEARLY
        if off < 0.34 * r and o.r > 0.5 * r:
            return UNCLEAR
    return NOTHING


def _another_red(rng):
    """As RED, or as a click or a patch would have learnt it."""
    if rng.random() < 0.4:
        return RED
    # not so wide that an orange ball is one of this colour
    return Colour(hue=rng.uniform(351, 358), tolerance=rng.uniform(15, 22), saturation=rng.uniform(0.18, 0.4))


def _changed(rng, image, guesses, balls, most=10):
    """A copy of the picture as another camera, light or desk would show it; with its guesses and balls."""
    guesses, balls = guesses.copy(), balls.copy()
    keep = rng.permutation(len(guesses))
    if len(balls):
        x, y, r = balls[0, :3]
        near = np.hypot(guesses[keep, 0] - x, guesses[keep, 1] - y) + np.abs(guesses[keep, 2] - r) < 0.6 * r + 1
        keep = np.concatenate([keep[near][:3], keep[~near]])
    guesses = guesses[keep[:most]]
    image, guesses, balls = _resized(rng, image, guesses, balls)
    if rng.random() < 0.5:
        image = image[:, ::-1]
        guesses[:, 0], balls[:, 0] = image.shape[1] - 1 - guesses[:, 0], image.shape[1] - 1 - balls[:, 0]
    if rng.random() < 0.3:
        image = image[::-1]
        guesses[:, 1], balls[:, 1] = image.shape[0] - 1 - guesses[:, 1], image.shape[0] - 1 - balls[:, 1]
    image = np.ascontiguousarray(image)
    target = balls[0, :3] if len(balls) else guesses[0] if len(guesses) else None
    if target is not None and rng.random() < 0.3:
        balls = _hidden(rng, image, target, balls)
    if target is not None and rng.random() < 0.3:
        image, guesses, balls = _cut(rng, image, target, guesses, balls)
    return _seen(rng, image), guesses, balls


def _resized(rng, image, guesses, balls):
    longer = max(image.shape)
    low = max(7.5 / balls[0, 2] if len(balls) else 0.3, 120 / min(image.shape[:2]))
    scale = float(np.exp(rng.uniform(np.log(min(low, 1)), np.log(min(1, max(640 / longer, low))))))
    if scale > 0.97:
        return image.copy(), guesses, balls
    size = round(image.shape[1] * scale), round(image.shape[0] * scale)
    guesses[:, :2], balls[:, :2] = (guesses[:, :2] + 0.5) * scale - 0.5, (balls[:, :2] + 0.5) * scale - 0.5
    guesses[:, 2] *= scale
    balls[:, 2] *= scale
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA), guesses, balls


def _hidden(rng, image, target, balls):
    """Paint a bar over a part of the target, in place; what is left visible of the ball is estimated."""
    x, y, r = target
    angle, reach = rng.uniform(0, 2 * np.pi), rng.uniform(-0.2, 0.95) * r
    along = np.array([np.cos(angle), np.sin(angle)])
    across, wide = np.array([-along[1], along[0]]), rng.uniform(0.2, 2.5) * r
    corners = np.array([x, y]) + np.array(
        [reach * along + s * 8 * r * across for s in (-1, 1)]
        + [(reach + wide) * along + s * 8 * r * across for s in (1, -1)]
    )
    colour = _paint(rng, red=rng.random() < 0.1)
    _fill(image, corners, colour, colour, rng)
    rows, cols = np.mgrid[-1:1:41j, -1:1:41j]
    disc = rows**2 + cols**2 < 1
    depth = (cols * along[0] + rows * along[1]) * r
    left = 1 - (disc & (depth > reach) & (depth < reach + wide)).sum() / disc.sum()
    balls[:1, 3] *= left
    return balls


def _cut(rng, image, target, guesses, balls):
    """End the picture near or in the target, on one side."""
    x, y, r = target
    side, edge = rng.integers(4), rng.uniform(-0.75, 1.5) * r
    height, width = image.shape[:2]
    x0, y0, x1, y1 = 0, 0, width, height
    if side == 0:
        x0 = int(max(x - edge, 0))
    elif side == 1:
        x1 = int(min(x + edge, width))
    elif side == 2:
        y0 = int(max(y - edge, 0))
    else:
        y1 = int(min(y + edge, height))
    if x1 - x0 < 60 or y1 - y0 < 60:
        return image, guesses, balls
    rows, cols = np.mgrid[-1:1:41j, -1:1:41j]
    disc = rows**2 + cols**2 < 1

    def within(x0, y0, x1, y1):
        px, py = x + r * cols, y + r * rows
        return (disc & (px >= x0) & (px < x1) & (py >= y0) & (py < y1)).sum()

    balls[:1, 3] *= within(x0, y0, x1, y1) / max(within(0, 0, width, height), 1)
    guesses[:, :2] -= (x0, y0)
    balls[:, :2] -= (x0, y0)
    return np.ascontiguousarray(image[y0:y1, x0:x1]), guesses, balls


def _paint(rng, *, red):
    hue = rng.normal(0, 6) % 180 if red else rng.integers(180)
    saturation, value = (rng.uniform(130, 250), rng.uniform(60, 250)) if red else rng.uniform((0, 20), (200, 250))
    return cv2.cvtColor(np.uint8([[[hue % 180, saturation, value]]]), cv2.COLOR_HSV2RGB)[0, 0].astype(float)


def _fill(image, corners, colour, other, rng):
    """Fill a polygon (n, 2), in place: from one colour to the other across it, smoothed, with some grain."""
    mask = np.zeros(image.shape[:2], np.uint8)
    cv2.fillPoly(mask, [np.round(np.asarray(corners) * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    _blend(image, mask, colour, other, rng)


def _blend(image, mask, colour, other, rng):
    mask = cv2.GaussianBlur(mask, (0, 0), rng.uniform(0.5, 1.2)).astype(np.float32)[..., None] / 255
    height, width = image.shape[:2]
    turn = rng.uniform(0, 2 * np.pi)
    rows, cols = np.mgrid[:height, :width].astype(np.float32)
    share = np.clip(0.5 + (np.cos(turn) * (cols - width / 2) + np.sin(turn) * (rows - height / 2)) / width, 0, 1)[
        ..., None
    ]
    paint = np.asarray(colour, np.float32) * share + np.asarray(other, np.float32) * (1 - share)
    paint += rng.normal(0, rng.uniform(0, 5), image.shape).astype(np.float32)
    image[:] = np.clip(image * (1 - mask) + paint * mask, 0, 255).astype(np.uint8)


def painted(seed, turn=0):
    """Examples of shapes painted into a scene without a ball: discs count as balls, polygons, ovals, rings do not."""
    rng = np.random.default_rng([seed, turn, 78])
    image, balls = scene(seed, "no_ball")
    image, _, balls = _resized(rng, image, np.empty((0, 3)), balls)
    image, guesses, discs = _painted(rng, np.ascontiguousarray(image), count=6)
    return _look(_seen(rng, image), guesses, discs, _another_red(rng))


def _painted(rng, image, count):
    """Paint shapes of red; returns also guesses (n, 3) that they may lead to, and the discs (n, 4) as `scene`."""
    height, width = image.shape[:2]
    guesses, discs, taken = [], [], []
    for _ in range(count):
        r = float(np.exp(rng.uniform(np.log(7), np.log(0.25 * min(height, width)))))
        x, y = rng.uniform((r, r), (width - r, height - r))
        if any(np.hypot(x - a, y - b) < 1.3 * (r + c) for a, b, c in taken):
            continue
        taken.append((x, y, r))
        colour = _paint(rng, red=True)
        other = colour * rng.uniform(0.35, 1.0)
        names = ("disc", "polygon", "oval", "ring", "bar", "cuboid", "capsule")
        what = rng.choice(names, p=[0.22, 0.22, 0.1, 0.04, 0.1, 0.22, 0.1])
        turn = rng.uniform(0, 2 * np.pi)
        mask = np.zeros((height, width), np.uint8)
        middle = (round(16 * x), round(16 * y))
        if what == "disc":
            cv2.circle(mask, middle, round(16 * r), 255, -1, cv2.LINE_AA, 4)
            discs.append((x, y, r, 1.0))
        elif what == "polygon":
            n = int(rng.integers(3, 5.5 + min(r / 9, 4)))  # a small one with many corners is a disc
            angle = turn + (np.arange(n) + rng.uniform(-1, 1, n) * rng.uniform(0, 0.15)) * 2 * np.pi / n
            corners = np.array([x, y]) + r * np.stack([np.cos(angle), np.sin(angle)], axis=1)
            cv2.fillPoly(mask, [np.round(16 * corners).astype(np.int32)], 255, cv2.LINE_AA, 4)
        elif what == "oval":
            axes = round(16 * r), round(16 * r * rng.uniform(0.4, 0.8))
            cv2.ellipse(mask, middle, axes, np.degrees(turn), 0, 360, 255, -1, cv2.LINE_AA, 4)
        elif what == "ring":
            cv2.circle(mask, middle, round(16 * r), 255, -1, cv2.LINE_AA, 4)
            cv2.circle(mask, middle, round(16 * r * rng.uniform(0.45, 0.8)), 0, -1, cv2.LINE_AA, 4)
        elif what == "cuboid":
            _cuboid(rng, image, (x, y), r, turn, colour)
            guesses += [(x, y, r * scale) for scale in (0.95, 0.85, 0.7)]
            continue
        elif what == "capsule":
            wide, along = r * rng.uniform(0.2, 0.7), np.array([np.cos(turn), np.sin(turn)])
            ends = [np.array([x, y]) + s * (r - wide) * along for s in (-1, 1)]
            for end in ends:
                cv2.circle(mask, tuple(np.round(16 * end).astype(int)), round(16 * wide), 255, -1, cv2.LINE_AA, 4)
            across = wide * np.array([-along[1], along[0]])
            corners = np.array([ends[0] + across, ends[1] + across, ends[1] - across, ends[0] - across])
            cv2.fillPoly(mask, [np.round(16 * corners).astype(np.int32)], 255, cv2.LINE_AA, 4)
            guesses += [(*end, wide) for end in ends]
        else:
            wide = r * rng.uniform(0.15, 1.0)
            corners = cv2.boxPoints(((x, y), (2 * r, 2 * wide), float(np.degrees(turn))))
            cv2.fillPoly(mask, [np.round(16 * corners).astype(np.int32)], 255, cv2.LINE_AA, 4)
            along = np.array([np.cos(turn), np.sin(turn)])
            guesses += [(*(np.array([x, y]) + end * (r - wide) * along), 1.05 * wide) for end in (-1, 0, 1)]
        _blend(image, mask, colour, other, rng)
        guesses += [(x, y, r * scale) for scale in ((1.0,) if what == "disc" else (0.97, 0.88))]
    return image, np.array(guesses).reshape(-1, 3), np.array(discs).reshape(-1, 4)


def behind(seed, turn=0):
    """Examples of balls and of rods with round ends, shaded alike, half behind something: a rod's sides are straight."""
    rng = np.random.default_rng([seed, turn, 79])
    image, balls = scene(seed, "no_ball")
    image, _, balls = _resized(rng, image, np.empty((0, 3)), balls)
    image = np.ascontiguousarray(image)
    height, width = image.shape[:2]
    guesses, shown, taken = [], [], []
    for _ in range(8):
        r = float(np.exp(rng.uniform(np.log(6.5), np.log(0.12 * min(height, width)))))
        x, y = rng.uniform((r, r), (width - r, height - r))
        if any(np.hypot(x - a, y - b) < 4 * (r + c) for a, b, c in taken):
            continue
        taken.append((x, y, r))
        turn, left = rng.uniform(0, 2 * np.pi), rng.uniform(0.2, 1.1)  # of r, from the middle to what is in front
        along = np.array([np.cos(turn), np.sin(turn)])
        rod = left > 0.4 and rng.random() < 0.6  # a shorter stump of a rod cannot be told from a ball
        _shaded(rng, image, (x, y), along * (rng.uniform(0.8, 5) * r if rod else 0), r, _paint(rng, red=True))
        _in_front(rng, image, np.array([x, y]) + left * r * along, turn, r)
        cut = min(left, 1.0)
        share = 0.5 + (cut * np.sqrt(1 - cut**2) + np.arcsin(cut)) / np.pi
        if not rod:
            shown.append((x, y, r, share))
        guesses += [(x, y, r * scale) for scale in (1.0, 0.9)] + [(*(np.array([x, y]) + 0.15 * r * along), r)]
    shown = np.array(shown).reshape(-1, 4)
    return _look(_seen(rng, image), np.array(guesses).reshape(-1, 3), shown, _another_red(rng))


def _shaded(rng, image, end, axis, r, colour):
    """A rod from `end` along `axis` (2,), of radius r, in place; a ball if the axis is 0: matt with a highlight."""
    height, width = image.shape[:2]
    rows, cols = np.mgrid[:height, :width].astype(np.float32)
    dx, dy = cols - end[0], rows - end[1]
    along = np.clip((dx * axis[0] + dy * axis[1]) / max(axis @ axis, 1e-9), 0, 1) if axis.any() else 0
    dx, dy = (dx - along * axis[0]) / r, (dy - along * axis[1]) / r
    square = dx**2 + dy**2
    normal = np.stack([dx, dy, np.sqrt(np.maximum(1 - square, 0))], axis=-1)
    light = np.array([*rng.uniform(-0.7, 0.7, 2), 1.0])
    light /= np.linalg.norm(light)
    matt = rng.uniform(0.2, 0.6)
    bright = matt + (1 - matt) * np.maximum(normal @ light, 0)
    half = light + np.array([0.0, 0.0, 1.0])  # Blinn: the highlight is where the surface faces half way to the light
    half /= np.linalg.norm(half)
    shine = rng.choice([0, 1]) * rng.uniform(40, 220) * np.maximum(normal @ half, 0) ** rng.uniform(15, 120)
    paint = np.asarray(colour) * bright[..., None] + shine[..., None]
    cover = np.clip((1 - np.sqrt(square)) * r + 0.5, 0, 1)[..., None]
    image[:] = np.clip(image * (1 - cover) + paint * cover, 0, 255).astype(np.uint8)


def _in_front(rng, image, at, turn, r):
    """Something that ends at a point (2,), in place: a large ball, or a board with a straight edge."""
    if rng.random() < 0.4:
        colour = _paint(rng, red=False)
        large = r * rng.uniform(1.2, 4)
        tilt = turn + rng.uniform(-0.3, 0.3)
        _shaded(rng, image, at + large * np.array([np.cos(tilt), np.sin(tilt)]), np.zeros(2), large, colour)
        return
    colour = _paint(rng, red=rng.random() < 0.25)
    tilt, wide = turn + rng.uniform(-0.6, 0.6), r * rng.uniform(1.0, 5)
    along, across = np.array([np.cos(tilt), np.sin(tilt)]), np.array([-np.sin(tilt), np.cos(tilt)])
    reach = r * rng.uniform(2.5, 8)
    corners = [at + s * reach * across for s in (-1, 1)] + [at + wide * along + s * reach * across for s in (1, -1)]
    _fill(image, corners, colour, colour * rng.uniform(0.6, 1.0), rng)


def _cuboid(rng, image, middle, r, turn, colour):
    """Three faces of a box around the corner that is nearest to the camera, in place, each in its own light."""
    angles = turn + np.array([0, 2, 4]) * np.pi / 3 + rng.uniform(-0.5, 0.5, 3)
    edges = np.stack([np.cos(angles), np.sin(angles)], axis=1) * r * rng.uniform(0.45, 1.0, 3)[:, None]
    for k in range(3):
        a, b = edges[k], edges[(k + 1) % 3]
        corners = np.array(middle) + np.array([(0, 0), a, a + b, b])
        light = colour * rng.uniform(0.35, 1.0)
        _fill(image, corners, light, light * rng.uniform(0.85, 1.0), rng)


def _seen(rng, image):
    """Another light and another camera: gains, gamma, blur, noise, compression; what was overexposed stays so."""
    gain = rng.uniform(0.55, 1.4) * rng.uniform(0.93, 1.07, 3)
    table = (np.arange(256)[:, None] / 255) ** rng.uniform(0.75, 1.3)
    table = 255 * np.where(gain < 1, gain * table / (1 - (1 - gain) * table), np.minimum(gain * table, 1))
    image = cv2.LUT(image, np.rint(table).astype(np.uint8)[:, None])
    if rng.random() < 0.5:
        image = cv2.GaussianBlur(image, (0, 0), rng.uniform(0.4, 1.3))
    if rng.random() < 0.6:
        fine = rng.normal(0, rng.uniform(0.5, 8), image.shape).astype(np.float32)
        if rng.random() < 0.4:  # as cameras smooth it
            fine = cv2.GaussianBlur(fine, (0, 0), 0.8) * 1.8
        image = np.clip(image + fine, 0, 255).astype(np.uint8)
    if rng.random() < 0.6:
        quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(40, 97))]
        image = cv2.imdecode(cv2.imencode(".jpg", image[..., ::-1], quality)[1], cv2.IMREAD_COLOR)[..., ::-1]
    return np.ascontiguousarray(image)
