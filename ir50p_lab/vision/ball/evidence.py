"""What speaks against a ball, in words: the classifier decides, this says why.

Each objection has a weight times something measured, about 1 where it alone makes a ball doubtful.
"""

from math import log

import numpy as np

_WELL_APART = 5.5  # standard deviations between ball and surroundings, usual for a ball


def objection(found, others=()):
    """The strongest objection to a Measured, as a text; others: Balls that may touch it."""
    o = found.outline
    waves, pixels = found.bumps * o.r, 0.3 + 0.01 * o.r
    missing, outside, colourless = max(found.seen - found.support, 0.0), 1 - found.seen, 1 - found.fill
    goes_on = beyond(found, others)
    said = (
        (1.8 * missing, f"{missing:.0%} of the circle show no edge"),
        (4.3 * outside, f"{outside:.0%} of the circle lie outside the picture"),
        (5.6 * goes_on, f"the colour goes on beyond {goes_on:.0%} of the circle"),
        (5.5 * colourless, f"{colourless:.0%} of the disc have another colour"),
        (3.7 * waves / pixels, f"the outline is not round: waves of {waves:.2f} pixels on a radius of {o.r:.0f}"),
        (found.oval * o.r / (0.4 + 0.06 * o.r), "the outline is oval"),
        (2.35 * log(_WELL_APART / max(found.apart, 0.2)), "it hardly stands out from its surroundings"),
        (2.9 * min(-log(o.r / 20), 2.0), f"it is small, radius {o.r:.1f} pixels, and what is seen is not enough"),
    )
    weight, text = max(said, key=lambda one: one[0])
    return text if weight > 0.3 else "taken together, edge and shading are not those of a ball"


def beyond(found, others=()):
    """Share of the circle beyond which the colour goes on, and no other ball explains it."""
    here = found.beyond
    if others and here.any():
        angle = np.arange(len(here)) * (2 * np.pi / len(here))
        o = found.outline
        x, y = o.x + 1.1 * o.r * np.cos(angle), o.y + 1.1 * o.r * np.sin(angle)
        for other in others:
            here = here & (np.hypot(x - other.x, y - other.y) > 1.1 * other.radius + 1)
    return float(here.mean())
