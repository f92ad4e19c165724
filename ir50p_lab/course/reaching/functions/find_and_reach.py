"""find_and_reach: from a picture to the pose above the ball in it, composed of earlier functions.

It is tried on drawn pictures, each of which shows one part of it; what is said then is in find_and_reach.txt.
"""

import numpy as np

from ir50p_lab.course.camera.functions.pixel_to_plane import pixel_to_plane
from ir50p_lab.course.checking.calling import call_or_fail
from ir50p_lab.course.checking.task import Failed, Task, sentences, text_of, words
from ir50p_lab.course.images.functions.hue_mask import hue_mask
from ir50p_lab.course.images.notebook_functions import edges_of, strongest, with_neighbours
from ir50p_lab.course.kinematics.functions.reach import reach
from ir50p_lab.modelling import IR50P, forward_kinematics

_EARLIER = ("hue_mask", "circle_votes", "pixel_to_plane", "reach", "inverse_kinematics", "frames", "forward_kinematics")
_NEAR = 0.004  # m: a pixel is 1 mm on the table, and the best place may be two pixels beside the middle
_WOOD, _RED, _GREEN, _PINK = (176, 148, 112), (200, 30, 40), (40, 160, 70), (200, 30, 110)
_SAYS = sentences("find_and_reach", __file__)


def find_and_reach(rgb, q_now, *, K, T_base_cam, l, limits, hue, tolerance, radii, ball_radius, above):
    """Return the pose (3,) rad with the tip `above` m over the ball in a straightened picture, or None."""
    mask = hue_mask(rgb, hue, tolerance)
    edges = edges_of(mask)
    best = 0.5
    pixel = None
    for radius in radii:
        share, middle = strongest(edges, radius, mask.shape)
        if share > best:
            best = share
            pixel = middle
    if pixel is None:
        return None
    place = pixel_to_plane(K, T_base_cam, pixel, ball_radius)
    return reach(place + np.array([0, 0, above]), l, q_now, limits)


# ------------------------------------------------------------------------------------------------------ drawn pictures
def _picture(*things):
    """A picture (240, 320, 3) of a table with flat things on it: (colour, function of rows and columns -> mask)."""
    rows, columns = np.indices((240, 320))
    image = np.full((240, 320, 3), _WOOD, dtype=np.uint8)
    for colour, covers in things:
        image[covers(rows, columns)] = colour
    return image


def _disc(x, y, radius, colour=_RED, share=1.0):
    """A disc, or a sector of it, this share of the whole."""

    def covers(rows, columns):
        turn = np.arctan2(rows - y, columns - x) % (2 * np.pi)
        return (np.hypot(columns - x, rows - y) <= radius) & (turn <= share * 2 * np.pi)

    return colour, covers


def _camera(x, y):
    """T_base_cam of a lens 0.75 m above a place, looking straight down, turned by 0.4 rad."""
    c, s = np.cos(0.4), np.sin(0.4)
    return np.array([[c, s, 0, x], [s, -c, 0, y], [0, 0, -1, 0.75], [0, 0, 0, 1]])


_BAR = (_RED, lambda rows, columns: (abs(rows - 60) < 8) & (abs(columns - 90) < 70))
_K = np.array([[700.0, 0, 160], [0, 690, 120], [0, 0, 1]])
_KNOWN = {"K": _K, "T_base_cam": _camera(0.38, 0.05), "l": np.array(IR50P.l), "hue": 0.0, "tolerance": 0.3}
_KNOWN |= {"limits": np.array([IR50P.q_min, IR50P.q_max]), "radii": range(18, 30), "ball_radius": 0.03, "above": 0.06}
_START, _BACK = np.array([0.0, 0.6, -1.2]), np.array([-2.9, 2.4, 1.3])  # the second bends over backwards
_WIDE = np.array([[-3.1] * 3, [3.1] * 3])


def _trials():
    """(key of the sentence, picture, what is known otherwise, q_now, pixel of the ball or None)."""
    yield "ball", _picture(_disc(250, 80, 24)), {}, _START, (250, 80)
    yield "ball", _picture(_disc(97, 150, 24), _BAR), {}, _START, (97, 150)
    for radius in (19, 21, 25, 28):
        yield "radius", _picture(_disc(120, 130, radius)), {}, _START, (120, 130)
    yield "radius", _picture(_disc(120, 130, 14)), {"radii": [13, 14, 15]}, _START, (120, 130)
    yield "nothing", _picture(), {}, _START, None
    yield "bar", _picture(_BAR), {}, _START, None
    yield "dot", _picture(_disc(120, 100, 4)), {}, _START, None
    yield "third", _picture(_disc(120, 130, 24, share=0.3)), {}, _START, None
    yield "covered", _picture(_disc(120, 130, 24, share=0.6)), {}, _START, (120, 130)
    yield "two", _picture(_disc(80, 150, 19), _disc(230, 150, 28, share=0.75)), {}, _START, (80, 150)
    yield "two", _picture(_disc(80, 150, 19, share=0.75), _disc(230, 150, 28)), {}, _START, (230, 150)
    yield "hue", _picture(_disc(97, 150, 24, _GREEN), _disc(220, 80, 24)), {"hue": 2.35}, _START, (97, 150)
    yield "tolerance", _picture(_disc(97, 150, 24, _PINK)), {"tolerance": 0.55}, _START, (97, 150)
    yield "K", _picture(_disc(200, 150, 24)), {"K": _K * [[1.3, 1, 1.1], [1, 1.2, 1], [1, 1, 1]]}, _START, (200, 150)
    yield "above", _picture(_disc(120, 130, 24)), {"above": 0.1}, _START, (120, 130)
    yield "height", _picture(_disc(60, 190, 24)), {"ball_radius": 0.08}, _START, (60, 190)
    yield "far", _picture(_disc(120, 130, 24)), {"T_base_cam": _camera(0.9, 0.1)}, _START, None
    yield "now", _picture(_disc(120, 130, 24)), {"limits": _WIDE}, _BACK, (120, 130)


def tried(function):
    """Try a function on all pictures. Raises Failed with the first symptom."""
    for key, picture, other, q_now, pixel in _trials():
        known, given = _KNOWN | other, (picture.copy(), q_now.copy())
        answer = call_or_fail(lambda: function(*given, **known), lambda: _SAYS["for"].format(_SAYS[f"of {key}"]))  # noqa: B023
        if not (np.array_equal(given[0], picture) and np.array_equal(given[1], q_now)):
            raise Failed(_SAYS["changes"])
        _judge(key, answer, known, q_now, pixel)
    return ""


def _judge(key, answer, known, q_now, pixel):
    """Raise Failed unless it is None where no pose is asked for, else the nearest pose with the tip near its goal."""
    if pixel is None or answer is None:
        if answer is not pixel:
            raise Failed(_SAYS["blind" if key == "ball" else key].format(0, 0))
        return
    if np.shape(answer) != (3,):
        raise Failed(_SAYS["shape"].format(np.shape(answer)))
    place, turned = (
        pixel_to_plane(known["K"], known["T_base_cam"], one, known["ball_radius"]) for one in (pixel, pixel[::-1])
    )
    goal, tip = place + np.array([0, 0, known["above"]]), forward_kinematics(IR50P, np.asarray(answer, dtype=float))
    if np.allclose(answer, goal, atol=_NEAR) or np.allclose(answer, place, atol=_NEAR):
        raise Failed(_SAYS["place"])
    if not np.linalg.norm(tip - goal) < _NEAR:
        beside, high = 1000 * np.hypot(*(tip - goal)[:2]), 1000 * (tip - goal)[2]
        key = "turned" if np.allclose(tip[:2], turned[:2], atol=_NEAR) else key
        key = "low" if key == "ball" and beside < abs(high) / 4 else key
        raise Failed(_SAYS[key].format(beside, high))
    if np.abs(answer - reach(goal, known["l"], q_now, known["limits"])).max() > 0.05:
        raise Failed(_SAYS["now"])


TASK = Task(
    "find_and_reach",
    reference=find_and_reach,
    solution_text=text_of(edges_of, with_neighbours, strongest, find_and_reach),
    given=text_of(edges_of, with_neighbours, strongest) + "\n\n\n",
    leans_on=_EARLIER,
    trial=tried,
    **words("find_and_reach", __file__),
)
