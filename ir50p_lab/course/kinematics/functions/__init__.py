"""The functions of notebooks 00 to 03, one file each, and the sample arms on which they are tried."""

import numpy as np

LENGTHS = np.array([[0.285, 0.2, 0.372], [0.3, 0.25, 0.15], [0.0, 1.0, 0.8]])  # m


def some_arms(count, seed):
    """Return cases (q, l): poses of three arms, the first at rest."""
    rng = np.random.default_rng(seed)
    poses = rng.uniform(-2.0, 2.0, (count, 3))
    return [(q, LENGTHS[k % 3].copy()) for k, q in enumerate([np.zeros(3), *poses])]
