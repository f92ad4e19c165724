"""What speaks against a ball, in words: the classifier decides, this says why.

Each term is a weight times something measured, about 1 where it alone makes a ball doubtful.
"""

from math import log

import numpy as np

# what is measured, its weight, and what to say if it is the strongest objection
TERMS = (
    ("missing", 1.8, "{0:.0%} of the circle show no edge"),
    ("unseen", 4.3, "{0:.0%} of the circle lie outside the picture"),
    ("beyond", 5.6, "the colour goes on beyond {0:.0%} of the circle"),
    ("hollow", 5.5, "{0:.0%} of the disc have another colour"),
    ("bumps", 3.7, "the outline is not round: waves of {1:.2f} pixels on a radius of {2:.0f}"),
    ("oval", 1.0, "the outline is oval"),
    ("alike", 2.35, "it hardly stands out from its surroundings"),
    ("through", 1.4, "{0:.0%} of the part that is missing look like the background: nothing hides it"),
    ("broken", 0.4, "the outline is broken in {0:.0f} places more than one thing in front could do"),
    ("texture", 0.2, "the edges around it are those of a texture"),
    ("small", 2.9, "it is small, radius {2:.1f} pixels, and what is seen of it is not enough"),
    ("ragged", 1.95, "its edges scatter about a circle"),
)
NOTHING_SPECIAL = "taken together, edge and shading are not those of a ball"
_WELL_APART = 5.5  # standard deviations between ball and surroundings, usual for a ball


def evidence(found, others=()):
    """Name -> (amount, weighed) of each term for a Measured; others: Balls that may touch it."""
    o = found.outline
    pixels = 0.3 + 0.01 * o.r
    amounts = {
        "missing": max(found.seen - found.support, 0.0),
        "unseen": 1 - found.seen,
        "beyond": beyond(found, others),
        "hollow": 1 - found.fill,
        "bumps": found.bumps * o.r / pixels,
        "oval": found.oval * o.r / (0.4 + 0.06 * o.r),
        "alike": max(log(_WELL_APART / max(found.apart, 0.2)), 0.0),
        "through": found.through,
        "broken": max(found.gaps - 1, 0),
        "texture": max(found.step - 0.9, 0.0),
        "small": max(min(-log(o.r / 20), 2.0), 0.0),
        "ragged": found.ragged * o.r / pixels,
    }
    return {name: (amounts[name], weight * amounts[name]) for name, weight, _ in TERMS}


def objection(found, others=()):
    """The strongest objection to a Measured, as a text."""
    terms = evidence(found, others)
    worst = max(terms, key=lambda name: terms[name][1])
    text = next(text for name, _, text in TERMS if name == worst) if terms[worst][1] > 0.3 else NOTHING_SPECIAL
    o = found.outline
    return text.format(terms[worst][0], found.bumps * o.r, o.r)


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
