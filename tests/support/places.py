"""Where balls may lie for an arm, and places drawn at random there."""

import contextlib
from collections import namedtuple

import numpy as np

from ir50p_lab.errors import UnreachableError
from ir50p_lab.vision import reach_pose

HEIGHT = 0.09  # m: height of the tip for which the area holds, 30 mm over the top of a ball of 60 mm
ANGLE = 0.52  # rad: it spans no more than this to each side of x

#: A part of a ring on the table, r_min..r_max m, -angle..angle rad about x.
WorkArea = namedtuple("WorkArea", "r_min r_max angle")


def work_area(arm):
    """From the inner edge of what the arm reaches to 30 mm past the outer one: who lays a ball there gets a refusal."""
    near = []
    for r in np.arange(0.02, sum(arm.l) + 0.01, 0.005):
        with contextlib.suppress(UnreachableError):
            reach_pose(arm, [r, 0.0, HEIGHT])
            near.append(float(r))
    return WorkArea(near[0], near[-1] + 0.03, float(min(ANGLE, arm.q_max[0], -arm.q_min[0])))


def places_in(area, rng, n, height=0.03):
    """n places, evenly spread over a WorkArea, (n, 3) m at `height`."""
    r = np.sqrt(rng.uniform(area.r_min**2, area.r_max**2, n))
    a = rng.uniform(-area.angle, area.angle, n)
    return np.column_stack([r * np.cos(a), r * np.sin(a), np.full(n, float(height))])
