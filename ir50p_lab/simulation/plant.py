"""The arm as numbers for the compiled steps: rigid body, dry friction, drive, end stops, table."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.inputs import choice
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.dynamics import as_theta

_JOINTS, _VISCOUS, _COULOMB, _OFFSET = (0, 1, 2), (10, 12, 14), (11, 13, 15), (16, 17, 18)  # places in theta

# places in Plant.numbers; three values each unless said
GRAVITY, TABLE, DRY = 0, 1, 2  # one value each: m/s^2; height of the table, m; 1 if a step must be able to stick
FV, FC, FS, QS, TF, LIMIT, Q_MIN, Q_MAX, LENGTHS, FORCE_SCALE = 3, 6, 9, 12, 15, 18, 21, 24, 27, 30


@dataclass(frozen=True)
class Plant:
    """The arm as two flat arrays (structures of many arrays make the compiled loops ten times as slow).

    theta: (3, 20), of which the inertial part counts; numbers: (33,), with the places given above, in units of the
    command u (N m or PWM): friction, limit of |u|, end stops in rad (infinite: none), lengths in m, and FORCE_SCALE,
    which is 1 for N m and 1/K for PWM.
    """

    theta: np.ndarray
    numbers: np.ndarray

    @property
    def limit(self):
        """Limit of |u|, (3,), in the unit of the command."""
        return self.numbers[LIMIT : LIMIT + 3]

    @property
    def dry(self):
        """Whether the motion can stick or hit something."""
        return bool(self.numbers[DRY])


def make_plant(arm, *, unit="N m", stops=False, table=None, g=None):
    """Return the Plant of an Arm or a theta.

    Args:
        arm: Arm, or theta (3, 20), whose Coulomb friction is also its breakaway: theta holds no Stribeck part.
        unit: unit of the command. 'PWM' drives an Arm through its actuators: gain, back-EMF, saturation.
        stops: whether the joint limits are end stops (without rebound).
        table: height of a table that the tip cannot pass, m; None: no table. Only the tip touches it (an elbow
            passes through), and there is no friction in the contact.
        g: gravity for a theta, m/s^2, default 9.81 (a theta holds none; an Arm carries its own and refuses this).

    Raises: ArmError (no actuators for PWM, or a theta with negative friction), InputError (a table or end stops for a
    theta, g for an Arm, unknown unit).
    """
    choice("unit", unit, ("N m", "PWM"))
    theta, gravity = as_theta(arm, g)
    scale, limit = np.ones(3), np.full(3, np.inf)
    if isinstance(arm, Arm):
        if unit == "PWM":
            theta = arm.theta_pwm  # raises ArmError without actuators
            scale, limit = 1 / arm.actuators.gain, np.full(3, arm.actuators.limit_pwm)
        fs, qs, lengths = np.array(arm.friction.fs) * scale, arm.friction.qs, arm.l
    elif stops or table is not None:
        raise InputError("end stops and a table need an Arm (its limits and lengths); a theta holds neither")
    else:
        fs, qs, lengths = theta[_JOINTS, _COULOMB], np.full(3, 0.05), np.zeros(3)
    fv, fc, Tf = theta[_JOINTS, _VISCOUS], theta[_JOINTS, _COULOMB], theta[_JOINTS, _OFFSET]
    if (fc < 0).any() or (fv < 0).any():
        raise ArmError(f"friction of theta is negative (fv {fv.tolist()}, fc {fc.tolist()}): it would feed the arm")
    dry = (fs > 0).any() or stops or table is not None
    ends = (arm.q_min, arm.q_max) if stops else (np.full(3, -np.inf), np.full(3, np.inf))
    single = (gravity, -np.inf if table is None else table, dry)
    numbers = np.concatenate([single, fv, fc, fs, qs, Tf, limit, *ends, lengths, scale])
    return Plant(theta=np.array(theta), numbers=numbers)
