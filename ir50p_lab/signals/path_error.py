"""How far the tip was from its path, in millimetres."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.signals.reference import time_vector


@dataclass(frozen=True)
class PathError:
    """Errors of the tip, at times t (n,) s.

    tip, wanted: (n, 3) m, where it was (forward kinematics of the measured joints) and should have been at that time.
    tracking_mm: (n,) distance of the two.
    """

    t: np.ndarray
    tip: np.ndarray
    wanted: np.ndarray
    tracking_mm: np.ndarray

    @property
    def rms_mm(self):
        """Root mean square of the tracking error, mm."""
        return float(np.sqrt(np.mean(self.tracking_mm**2)))


def path_error(arm, measured, path, *, t=None):
    """Compare where the tip was with where `path` wanted it.

    Args:
        arm: Arm. measured: a Recording or SimulationResult (its .t and .q), or q (n, 3) rad with its times.
        path: CartesianPath, or any Reference: its samples lead the tip.
        t: (n,) s, only with q.

    Returns: PathError. Raises InputError on shapes that do not fit or numbers that are not finite.
    """
    if hasattr(measured, "q"):
        t, q = measured.t, measured.q
    elif t is None:
        raise InputError("q alone has no times: give path_error(arm, q, path, t=t), or a recording")
    else:
        q = measured
    t, q = time_vector("t", t), vectors3("q", q)
    if q.shape != (len(t), 3) or len(t) == 0:
        raise InputError(f"t {t.shape} and q {q.shape} do not fit: give n >= 1 times and q of shape (n, 3)")
    tip = forward_kinematics(arm, q)
    wanted = forward_kinematics(arm, path.sample(t)[:, 0])
    return PathError(t, tip, wanted, 1e3 * np.linalg.norm(tip - wanted, axis=1))
