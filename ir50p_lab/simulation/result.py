"""What a simulation returns."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.modelling.dynamics import energy


@dataclass(frozen=True)
class StepMetrics:
    """How one joint answered a step, from `control.step_info`; times in s, angles in rad.

    overshoot and settling are about the final value reached (2 % band); error = set point - final value.
    """

    joint: int
    rise_time: float
    overshoot_percent: float
    settling_time: float
    peak: float
    final: float
    error: float
    peak_command: float


@dataclass(frozen=True)
class SimulationResult:
    """A simulated run, time first. Simulated: no number here was measured.

    t (n,) s; q, qd (n, 3) rad, rad/s; u (n, 3) applied command in `unit`, held from each sample to the next;
    reference (n, 3, 3): q, qd, qdd of the reference. energy: kinetic and potential energy (n,) J, where the arm has
    one (a theta with unequal rows has none). g: gravity given for a theta, m/s^2 (None: 9.81, or the Arm's own).
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
        """Energy of the run, (n,) J each; raises InputError for a theta with a row of its own per joint."""
        return energy(self.arm, self.q, self.qd, g=self.g)

    @property
    def error(self):
        """Reference minus angle, (n, 3) rad."""
        return self.reference[:, 0] - self.q

    @property
    def rms_error(self):
        """Root mean square of the error per joint, (3,) rad."""
        return np.sqrt(np.mean(self.error**2, axis=0))

    def metrics(self):
        """Step metrics of the three joints, a list of StepMetrics (`control.step_info`, about the final value).

        Raises InputError if the reference moves in the end: then there is no step to measure.
        """
        import control

        if not (self.reference[-1, 1:] == 0).all():
            raise InputError("the reference still moves at the end of the run; step metrics need a set point")
        found = []
        for joint in range(3):
            y, target = self.q[:, joint], self.reference[-1, 0, joint]
            moved = y - y[0]
            if abs(moved[-1]) < 1e-9:
                info = dict.fromkeys(("RiseTime", "Overshoot", "SettlingTime"), np.nan)
            else:
                info = control.step_info(moved, T=self.t, T_num=len(self.t))
            far = np.argmax(np.abs(moved))
            found.append(
                StepMetrics(
                    joint=joint + 1,
                    rise_time=float(info["RiseTime"]),
                    overshoot_percent=float(info["Overshoot"]),
                    settling_time=float(info["SettlingTime"]),
                    peak=float(y[far]),
                    final=float(y[-1]),
                    error=float(target - y[-1]),
                    peak_command=float(np.abs(self.u[:, joint]).max()),
                )
            )
        return found
