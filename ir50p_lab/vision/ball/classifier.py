"""Ball or not: small networks look at the samples around an outline and at what was measured of it.

Along each ray the samples pass a layer shared by all rays, with their neighbours, and a second one that looks further
around; mean and maximum over the rays do not depend on how the ball is turned. With the measures they decide. The
score is the mean of several such networks. `python -m tests.targets.train_ball_classifier` makes the weights.
"""

from functools import cache
from pathlib import Path

import numpy as np

from ir50p_lab.vision.ball.edge import directions
from ir50p_lab.vision.ball.evidence import beyond
from ir50p_lab.vision.ball.features import RADII, RAYS, median

WEIGHTS = Path(__file__).with_name("classifier.npz")
NEAR, FAR = (-1, 0, 1), (-4, -2, 0, 2, 4)  # rays that the first and the second layer look at
_JUST_OUTSIDE = 9  # among RADII


def rays_of(found, others=()):
    """What is seen along the rays of a Measured, (RAYS, channels) float32; less what `others` (Balls) cover."""
    samples, edges = found.samples, found.edges
    if others:
        o, (cos, sin) = found.outline, directions(RAYS)
        t = o.radii(cos, sin)[:, None] * RADII
        x, y = o.x + t * cos[:, None], o.y + t * sin[:, None]
        free = np.all([np.hypot(x - b.x, y - b.y) > 1.05 * b.radius + 1 for b in others], axis=0)
        samples = samples * free[:, :, None]
        edges = edges * free[:, [_JUST_OUTSIDE]]
    return np.concatenate([samples.reshape(RAYS, -1), edges], axis=1)


def measures(found, others=()):
    """What is measured of a Measured, (m,) float32, for the classifier; others: Balls that may touch it."""
    o = found.outline
    pixels = 0.3 + 0.01 * o.r
    disc = found.samples[:, :6]
    dark = (disc[:, :, 1] <= 0) & (disc[:, :, 5] > 0)  # the darker half of it shows its own hue, not the light's
    return np.float32(
        [
            np.log(o.r / 20),
            found.seen,
            found.support,
            found.seen - found.support,
            beyond(found, others),
            found.fill,
            found.bumps * o.r / pixels,
            found.oval * o.r / (0.4 + 0.06 * o.r),
            found.ragged * o.r / pixels,
            np.log(max(found.apart, 0.2)),
            found.through,
            min(found.gaps, 5),
            found.step,
            found.bumps * 20,
            found.ragged * 20,
            median(disc[:, :, 2]),
            median(disc[:, :, 2][dark]) if dark.any() else 0,
            median(disc[:, :, 3]),
            disc[:, :, 4].mean(),
        ]
    )


@cache
def around(layer):
    """Indices (RAYS, len(layer)) of the rays that a layer looks at from each."""
    return (np.arange(RAYS)[:, None] + np.array(layer)) % RAYS


@cache
def _networks():
    """The weights of all networks side by side, and the scales of their inputs."""
    with np.load(WEIGHTS) as file:
        return {name: file[name].astype(np.float32) for name in file.files}


def score(found, others=None):
    """Score 0..1 of each Measured in a list; others: for each the Balls that may touch it. Returns: (n,)."""
    if not found:
        return np.empty(0)
    others = others or [()] * len(found)
    net = _networks()
    rays = np.stack([rays_of(m, o) for m, o in zip(found, others, strict=True)])
    numbers = np.stack([measures(m, o) for m, o in zip(found, others, strict=True)])
    rays = (rays - net["ray_mean"]) / net["ray_std"]
    numbers = (numbers - net["number_mean"]) / net["number_std"]
    n, count = len(found), len(net["w2"])
    # a product for each candidate and network: so small ones stay on one thread, which a busy computer has to spare
    x1 = rays.take(around(NEAR), axis=1).reshape(n, 1, RAYS, -1)
    h1 = np.maximum(x1 @ net["w1"] + net["b1"][:, None], 0)
    x2 = h1.take(around(FAR), axis=2).reshape(n, count, RAYS, -1)
    h2 = np.maximum(x2 @ net["w2"] + net["b2"][:, None], 0)
    numbers = np.broadcast_to(numbers[:, None], (n, count, numbers.shape[1]))
    pooled = np.concatenate([h2.mean(axis=2), h2.max(axis=2), numbers], axis=2)[:, :, None]
    h3 = np.maximum(pooled @ net["w3"] + net["b3"][:, None], 0)
    odds = (h3 @ net["w4"][:, :, None])[:, :, 0, 0] + net["b4"]
    return 1 / (1 + np.exp(-odds.mean(axis=1)))
