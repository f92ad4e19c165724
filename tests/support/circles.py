"""A student's circle(t) in notebook 11: as it is right, and as it goes wrong."""

import re
import textwrap

_NO_CIRCLE_YET = re.compile(r"^    \.\.\..*\n    return \.\.\.\n", re.M)
_RIGHT = """\
    place = centre + radius * np.array([np.cos(turned), np.sin(turned), 0])
    q = my_robot.reach(place, arm.l, first, parts(arm).limits)
    J = my_robot.jacobian(my_robot.frames(q, arm.l), 3, place)[:3]
    v = radius * rate * np.array([-np.sin(turned), np.cos(turned), 0])
    return np.array([q, np.linalg.solve(J, v), np.zeros(3)])
"""
#: What in it, by what, words of what is said by its own cell or by the claims after it.
WRONG = [
    ("v = radius * rate", "v = rate", "does not hold: angles change as speeds say"),
    ("(J, v)", "(J, np.zeros(3))", "does not hold: angles change as speeds say"),
    ("centre + radius", "ball + radius", "does not hold: the tip is on the circle; outwards and upwards"),
    ("np.sin(turned), 0])\n    q", "0, 0])\n    q", "does not hold: the tip is on the circle; outwards and upwards"),
    ("centre + radius", "centre + 9 * radius", "there it should be [ 0.48 -0.15  0.13] m"),
    ("place = centre +", "place = centre\n    place +=", "changes an array that others use, too: work on a copy"),
    ("    place", "    if t > lap:\n        return None\n    place", "is its `return` reached in every case?"),
    ("[q, ", "[np.degrees(q), ", "does not hold: joints keep their limits"),
    ("    J", "    q = q if turned < np.pi else q * [1, 1, -1]\n    J", "does not hold: joints keep their limits"),
    ("    place", "    turned = 2 * np.pi * t / lap\n    place", "does not hold: it begins, ends and waits at `first`"),
    ("np.linalg.solve(J, v)", "q", "does not hold: it begins, ends and waits at rest"),
    ("    place", "    turned, rate = 2 * turned, 2 * rate\n    place", "does not hold: rounds at half time"),
]


def written(cell, old="", new=""):
    """The cell that asks for it, with the right lines in place of the dots, or with a mistake in them."""
    assert len(_NO_CIRCLE_YET.findall(cell)) == 1 and old in _RIGHT
    return _NO_CIRCLE_YET.sub(lambda _: _RIGHT.replace(old, new) if old else _RIGHT, cell)


def judged(cell, claims, old, new):
    """The cell with a mistake, and the claims that follow it; the one that does not hold is printed."""
    told = textwrap.indent("\n".join(claims), "    ")
    return f"{written(cell, old, new)}\ntry:\n{told}\nexcept AssertionError as told:\n    print(told)"
