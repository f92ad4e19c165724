"""A student's circle(t) in notebook 11: as it is right, and as it goes wrong."""

import re

_NO_CIRCLE_YET = re.compile(r"^    \.\.\..*\n    return \.\.\.\n", re.M)
_RIGHT = """\
    place = centre + radius * np.array([np.cos(turned), np.sin(turned), 0])
    q = my_robot.reach(place, arm.l, first, parts(arm).limits)
    J = my_robot.jacobian(my_robot.frames(q, arm.l), 3, place)[:3]
    v = radius * rate * np.array([-np.sin(turned), np.cos(turned), 0])
    return np.array([q, np.linalg.solve(J, v), np.zeros(3)])
"""
#: What in it, by what, words of what is said.
WRONG = [
    ("v = radius * rate", "v = rate", "its speeds are not the change of its angles"),
    ("(J, v)", "(J, np.zeros(3))", "its speeds are not the change of its angles"),
    ("centre + radius", "ball + radius", "rad from where the way ends"),
    ("np.sin(turned), 0])\n    q", "0, 0])\n    q", "from the centre"),
    ("centre + radius", "centre + 9 * radius", "`reach` gives None"),
    ("    place", "    turned, rate = 2 * turned, 2 * rate\n    place", "once round was asked for"),
]


def written(cell, old="", new=""):
    """The cell that asks for it, with the right lines in place of the dots, or with a mistake in them."""
    assert len(_NO_CIRCLE_YET.findall(cell)) == 1 and old in _RIGHT
    return _NO_CIRCLE_YET.sub(lambda _: _RIGHT.replace(old, new) if old else _RIGHT, cell)
