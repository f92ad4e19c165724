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


# Bench data of an older ROB3 (public repository eurobtec/rob3): counts of a 10-bit converter per rad of axes 1-3.
_SISTER_SLOPE = np.array([189.1, 122.1, 191.7])
_LOWEST, _MIDDLE, _HIGHEST = 20.0, 512.0, 1003.0  # counts; beyond, a potentiometer is at the end of its track


def nominal_calibration(arm):
    """What potentiometers of this arm would read, before anyone has measured them.

    Slopes of the sister arm, smaller where the travel of a joint would not fit into 20..1003 counts; the middle of the
    travel reads 512. A joint without limits is taken to turn from -pi to pi.
    Args: arm: Arm. Returns: Calibration, without standard errors.
    """
    low, high = (np.clip(limit, -np.pi, np.pi) for limit in (arm.q_min, arm.q_max))
    slope = np.minimum(_SISTER_SLOPE, 2 * min(_MIDDLE - _LOWEST, _HIGHEST - _MIDDLE) / (high - low))
    zero = _MIDDLE - slope * 0.5 * (low + high)
    return Calibration(slope=tuple(slope.tolist()), zero=tuple(zero.tolist()), source="nominal, not measured")
