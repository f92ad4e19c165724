"""Things that lie about on a desk, drawn at random: tables, red paints, what may be taken for a red ball."""

import colorsys

import numpy as np

from ir50p_lab.vision.rendering.places import pose
from ir50p_lab.vision.rendering.scene import Patch, SceneBall, Stick
from tests.support.desk import TEXTURES, Box, DeskTable

# Tables: light wood, dark wood, white laminate, grey, black, green cutting mat, blue cloth, reddish wood (the hardest)
TABLES = (
    (186, 156, 118), (110, 75, 50), (225, 222, 215), (128, 128, 128), (45, 45, 48), (60, 105, 85), (70, 90, 130),
    (150, 90, 65),
)  # fmt: skip
WALLS = ((150, 148, 142), (205, 200, 190), (90, 95, 105), (120, 105, 90), (60, 60, 62))


def rgb(hue_deg, saturation, value):
    """(r, g, b) 0..255 of hue in degrees, saturation and value 0..1."""
    return tuple(round(255 * c, 1) for c in colorsys.hsv_to_rgb(hue_deg / 360 % 1, saturation, value))


def random_red(rng):
    """A red paint: hue 350 to 8 deg, either side of the seam; saturation 0.72 to 0.97, value 0.45 to 0.92.

    Thesis 4.5.1 takes hue 340 to 360 and saturation up to 0.8: a clean red ball has more (ERRATA 4.5.1).
    """
    return rgb(rng.uniform(-10, 8), rng.uniform(0.72, 0.97), rng.uniform(0.45, 0.92))


def other_colour(rng):
    """A ball paint that nobody calls red: orange (hue 20 and more) to purple (300), or hardly coloured.

    Pink is left out: whether it is red is a question of words, not of seeing.
    """
    kind = rng.choice(["orange", "coloured", "pale"], p=[0.35, 0.45, 0.2])
    if kind == "orange":
        return rgb(rng.uniform(20, 34), rng.uniform(0.75, 0.97), rng.uniform(0.7, 0.97))
    if kind == "coloured":
        return rgb(rng.uniform(45, 295), rng.uniform(0.4, 0.95), rng.uniform(0.3, 0.9))
    return rgb(rng.uniform(0, 360), rng.uniform(0.0, 0.2), rng.uniform(0.25, 0.95))


def skin(rng):
    """A skin colour, light to dark: hue 10 to 26 deg, saturation 0.25 to 0.6."""
    return rgb(rng.uniform(10, 26), rng.uniform(0.25, 0.6), rng.uniform(0.35, 0.92))


def red_thing(rng):
    """The colour of a red thing that is no ball: as red as the balls, or a shade further off."""
    return rgb(rng.uniform(-14, 12), rng.uniform(0.6, 0.97), rng.uniform(0.4, 0.92))


def random_table(rng, position):
    """A table under the ball; one in five ends close behind it, so that the room is seen."""
    x, y = position[:2]
    ends = rng.uniform(0.15, 0.4, 4) if rng.random() < 0.2 else rng.uniform(0.5, 3.0, 4)
    return DeskTable(
        texture=TEXTURES[str(rng.choice(list(TEXTURES), p=[0.25, 0.3, 0.2, 0.15, 0.1]))],
        colour=TABLES[rng.integers(len(TABLES))],
        contrast=rng.uniform(0.03, 0.5),
        grain=rng.uniform(0.01, 0.06),
        angle=rng.uniform(0, np.pi),
        x=(x - ends[0], x + ends[1]),
        y=(y - ends[2], y + ends[3]),
        room=WALLS[rng.integers(len(WALLS))],
    )


# how often: half are red things, as tape, books and pens are what a desk really has
DISTRACTORS = {
    "tape": 0.15, "red blob": 0.08, "red box": 0.10, "red stick": 0.09, "red cable": 0.06, "ball": 0.21, "skin": 0.12,
    "paper": 0.03, "box": 0.05, "magazine": 0.07, "bottle": 0.04,
}  # fmt: skip


def distractor(rng, camera, ball, *, near, what=None):
    """One thing of DISTRACTORS beside the ball: (objects, patches).

    camera (3,) m: sticks are laid across the view, because end-on a round stick is a ball. near: keep clear of the ball
    by at least its radius (touching tape is drawn on purpose, one time in five).
    """
    what = what or str(rng.choice(list(DISTRACTORS), p=list(DISTRACTORS.values())))
    scale = np.linalg.norm(np.asarray(ball.position) - camera)  # far cameras see larger things
    size = ball.radius * np.exp(rng.uniform(np.log(0.5), np.log(2.5)))
    away = (ball.radius + size) * rng.uniform(1.3, 6.0) if near else scale * rng.uniform(0, 0.3)
    angle, turn = rng.uniform(0, 2 * np.pi, 2)
    x, y = ball.position[0] + away * np.cos(angle), ball.position[1] + away * np.sin(angle)
    if what == "tape":
        if near and rng.random() < 0.2:
            x, y = ball.position[:2]
        length, width = size * rng.uniform(2, 12), rng.uniform(0.008, 0.03)
        return [], [Patch(position=(x, y), size=(max(length, 2 * width), width), angle=turn, colour=red_thing(rng))]
    if what == "red blob":
        outline = {"outline": "blob", "seed": int(rng.integers(1 << 30))}
        return [], [Patch(position=(x, y), size=(3.6 * size, 1.5 * size), angle=turn, colour=red_thing(rng), **outline)]
    if what == "paper":
        return [], [Patch(position=(x, y), size=(0.21, 0.297), angle=turn, colour=(240, 240, 236))]
    if what in ("red box", "box"):
        colour = red_thing(rng) if what == "red box" else other_colour(rng)
        sides = size * rng.uniform(0.8, 3.0, 3)
        return [Box(T_world_box=pose((x, y, sides[2] / 2), (0, 0, turn)), size=tuple(sides), colour=colour)], []
    if what in ("red stick", "red cable"):
        across = np.arctan2(camera[1] - y, camera[0] - x) + np.pi / 2 + rng.uniform(-0.7, 0.7)
        if what == "red stick":
            r = rng.uniform(0.003, 0.009)  # pens and markers; a thick round end seen past a box would be half a ball
            half = r * rng.uniform(5, 14) * np.array([np.cos(across), np.sin(across)])
            low, high = np.array((x, y)) - half, np.array((x, y)) + half
            return [
                Stick(start=(*low, r), end=(*high, r), radius=r, colour=red_thing(rng), gloss=rng.uniform(0, 0.6))
            ], []
        return _cable(rng, (x, y), across), []
    if what == "magazine":
        return [], _magazine(rng, (x, y), turn)
    if what == "bottle":  # never red: a red one seen from above is a red disc
        r, paint = rng.uniform(0.02, 0.04), other_colour(rng)
        height = rng.uniform(0.06, 0.22)
        return [Stick(start=(x, y, 0), end=(x, y, height), radius=r, colour=paint, gloss=rng.uniform(0, 0.7))], []
    if what == "skin":
        return _hand(rng, (x, y), turn, size=rng.uniform(0.8, 1.2)), []
    if what in ("ball", "red ball"):
        paint = random_red(rng) if what == "red ball" else other_colour(rng)
        return [SceneBall(position=(x, y, size), radius=size, colour=paint, gloss=rng.uniform(0, 0.7))], []
    raise ValueError(what)


def hider(rng, camera, ball):
    """What stands between camera and ball and hides a part: fingers, a link of the arm, a carton."""
    centre = np.asarray(ball.position)
    view = camera - centre
    distance = np.linalg.norm(view)
    view = view / distance
    side = np.cross(view, (0, 0, 1.0))
    side /= np.linalg.norm(side)
    up = np.cross(side, view)
    angle = rng.uniform(0, 2 * np.pi)
    out, along = np.cos(angle) * side + np.sin(angle) * up, -np.sin(angle) * side + np.cos(angle) * up
    # between ball and camera, at most half way, so that it is about as sharp as the ball
    middle = centre + view * ball.radius * rng.uniform(1.5, min(4.0, 0.5 * distance / ball.radius + 1.5))
    radius = ball.radius * rng.uniform(0.3, 1.5)
    middle = middle + out * (ball.radius * rng.uniform(-0.2, 1.0) + radius)
    half = along * ball.radius * rng.uniform(2, 10)
    colour = skin(rng) if rng.random() < 0.5 else rgb(rng.uniform(30, 300), rng.uniform(0, 0.5), rng.uniform(0.1, 0.9))
    return [Stick(start=tuple(middle - half), end=tuple(middle + half), radius=radius, colour=colour)]


def _hand(rng, place, turn, size):
    """A skin-coloured hand lying on the table: a palm and some fingers."""
    colour, forward = skin(rng), np.array([np.cos(turn), np.sin(turn)])
    sideways = np.array([-forward[1], forward[0]])
    thick = 0.011 * size
    parts = []
    for i in range(4):
        root = place + (i - 1.5) * 0.021 * size * sideways
        tip = root + forward * size * rng.uniform(0.05, 0.085) + sideways * rng.uniform(-0.01, 0.01)
        parts.append(Stick(start=(*root, 0.02), end=(*tip, thick), radius=thick, colour=colour))
        parts.append(
            Stick(start=(*root, 0.02), end=(*(place - 0.07 * size * forward), 0.022), radius=0.02 * size, colour=colour)
        )
    if rng.random() < 0.6:
        arm = place - forward * 0.35
        parts.append(
            Stick(start=(*(place - 0.06 * forward), 0.03), end=(*arm, 0.04), radius=0.03 * size, colour=colour)
        )
    return parts


def _magazine(rng, place, turn):
    """A printed page: lines of text, a picture or two of any colour, a headline that is often red."""
    c, s = np.cos(turn), np.sin(turn)

    def rectangle(x, y, width, height, colour):
        middle = (place[0] + c * x - s * y, place[1] + s * x + c * y)
        return Patch(position=middle, size=(width, height), angle=turn, colour=colour)

    page = [rectangle(0, 0, 0.20, 0.28, rgb(rng.uniform(30, 60), rng.uniform(0, 0.1), rng.uniform(0.75, 0.95)))]
    headline = red_thing(rng) if rng.random() < 0.5 else other_colour(rng)
    page.append(rectangle(rng.uniform(-0.02, 0.02), 0.115, rng.uniform(0.08, 0.17), rng.uniform(0.012, 0.03), headline))
    for _ in range(rng.integers(0, 3)):
        colour = red_thing(rng) if rng.random() < 0.3 else other_colour(rng)
        width, height = rng.uniform(0.03, 0.09, 2)
        page.append(rectangle(*rng.uniform((-0.05, -0.09), (0.05, 0.05)), width, height, colour))
    for line in range(rng.integers(4, 12)):
        width = rng.uniform(0.05, 0.08)
        page.append(rectangle(-0.09 + width / 2, 0.08 - 0.013 * line, width, 0.004, (60, 60, 62)))
    return page


def _cable(rng, place, across):
    """A bent red cable of short pieces."""
    colour, r, heading = red_thing(rng), rng.uniform(0.002, 0.006), across
    point, parts = np.array(place, dtype=float), []
    for _ in range(rng.integers(4, 9)):
        heading += rng.normal(0, 0.4)
        end = point + rng.uniform(0.03, 0.06) * np.array([np.cos(heading), np.sin(heading)])
        parts.append(Stick(start=(*point, r), end=(*end, r), radius=r, colour=colour))
        point = end
    return parts
