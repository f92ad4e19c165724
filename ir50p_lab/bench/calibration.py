"""From counts of the converter to joint angles: a straight line per joint, from an experiment (4.1.2)."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Calibration:
    """counts = zero + slope q, for each joint.

    slope: (3,) counts/rad; zero: (3,) counts at q = 0; stderr_slope, stderr_zero: (3,) or None; source: where it is
    from. Counts are those of a 10-bit converter, 0..1023.
    """

    slope: tuple
    zero: tuple
    stderr_slope: tuple | None = None
    stderr_zero: tuple | None = None
    source: str = "assumed"

    def __post_init__(self):
        object.__setattr__(self, "_slope", np.array(self.slope, dtype=float))
        object.__setattr__(self, "_zero", np.array(self.zero, dtype=float))

    def radians(self, counts):
        """Angles of counts; both (3,) or (n, 3)."""
        return (counts - self._zero) / self._slope

    def counts(self, q):
        """Counts at angles; both (3,) or (n, 3), not rounded."""
        return self._zero + self._slope * np.asarray(q, dtype=float)

    def header(self):
        """Lines for the head of a recording."""
        return {
            "counts_per_rad": " ".join(f"{x:.6g}" for x in self.slope),
            "counts_at_zero": " ".join(f"{x:.6g}" for x in self.zero),
            "calibration": self.source,
        }
