"""What a simulation returns."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np

from ir50p_lab.modelling.dynamics import energy


@dataclass(frozen=True)
class SimulationResult:
    """A simulated run, time first. No number here was measured.

    t: (n,) s; q, qd: (n, 3) rad, rad/s; u: (n, 3), applied command in `unit`, held from each sample to the next;
    reference: (n, 3, 3), q, qd, qdd of the reference. energy: kinetic and potential energy, (n,) J, if the arm has
    one (a theta with unequal rows has none). g: the gravity given for a theta, m/s^2 (None: 9.81, or the Arm's own).
    unstable: what looked unstable in the run, "" if nothing did.
    """

    t: np.ndarray
    q: np.ndarray
    qd: np.ndarray
    u: np.ndarray
    unit: str
    reference: np.ndarray
    arm: object = field(repr=False)
    g: float | None = None
    unstable: str = ""
    simulated: ClassVar = True

    @cached_property
    def energy(self):
        """Energy of the run, (n,) J each. Raises InputError for a theta whose joints have unequal rows."""
        return energy(self.arm, self.q, self.qd, g=self.g)

    @property
    def error(self):
        """Reference minus measured angle, (n, 3) rad."""
        return self.reference[:, 0] - self.q

    @property
    def rms_error(self):
        """Root mean square of the error of each joint, (3,) rad."""
        return np.sqrt(np.mean(self.error**2, axis=0))
