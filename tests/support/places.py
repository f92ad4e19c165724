"""Places drawn at random."""

import numpy as np


def places_in(area, rng, n, height=0.03):
    """n places, evenly spread over a WorkArea, (n, 3) m at `height`."""
    r = np.sqrt(rng.uniform(area.r_min**2, area.r_max**2, n))
    a = rng.uniform(-area.angle, area.angle, n)
    return np.column_stack([r * np.cos(a), r * np.sin(a), np.full(n, float(height))])
