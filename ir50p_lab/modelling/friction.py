"""Joint friction: viscous, Coulomb, Stribeck and a constant offset (1.115)-(1.117)."""

from dataclasses import dataclass, field, fields

import numpy as np

from ir50p_lab.errors import ArmError
from ir50p_lab.inputs import vector3, vectors3


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Friction of the three joints, as seen at the joint.

    ===== ============================== ==============
    field meaning                        shape, unit
    ===== ============================== ==============
    fv    viscous coefficient            (3,) N m s/rad
    fc    Coulomb torque                 (3,) N m
    fs    breakaway torque, fs >= fc     (3,) N m (default: fc, no Stribeck effect)
    qs    Stribeck velocity              (3,) rad/s
    Tf    offset, the same at any speed  (3,) N m
    ===== ============================== ==============

    Raises ArmError if a coefficient is negative, if fs < fc, or if a Stribeck velocity is not positive.
    """

    fv: tuple = field(default=(0.0, 0.0, 0.0), metadata={"comment": "N m s/rad, viscous"})
    fc: tuple = field(default=(0.0, 0.0, 0.0), metadata={"comment": "N m, Coulomb"})
    fs: tuple | None = field(default=None, metadata={"comment": "N m, breakaway (>= fc)"})
    qs: tuple = field(default=(0.05, 0.05, 0.05), metadata={"comment": "rad/s, Stribeck velocity"})
    Tf: tuple = field(default=(0.0, 0.0, 0.0), metadata={"comment": "N m, offset"})

    def __post_init__(self):
        if self.fs is None:
            object.__setattr__(self, "fs", self.fc)
        for name in (each.name for each in fields(self)):
            values = vector3(f"friction {name}", getattr(self, name), unit="N m, rad/s")
            object.__setattr__(self, name, tuple(values.tolist()))
        for joint, (fv, fc, fs, qs) in enumerate(zip(self.fv, self.fc, self.fs, self.qs, strict=True), start=1):
            for name, value in (("fv", fv), ("fc", fc)):
                if value < 0:
                    raise ArmError(f"friction {name} of joint {joint} is {value}: it must be >= 0, as it takes energy")
            if fs < fc:
                raise ArmError(f"breakaway torque fs = {fs} N m of joint {joint} is below its Coulomb torque, {fc} N m")
            if qs <= 0:
                raise ArmError(f"Stribeck velocity qs = {qs} rad/s of joint {joint} must be > 0")


def friction_torque(friction, qd):
    """Return the friction torque at joint velocity `qd`, with the sign that it has in (1.74): it opposes motion.

    F(qd) = fv qd + sgn(qd) [fc + (fs - fc) exp(-(qd/qs)^2)] + Tf    (1.115)-(1.117), Tf from (1.118)

    Args:
        friction: Friction, or an Arm.
        qd: (3,) or (n, 3), rad/s.

    Returns: the shape of `qd`, N m. At qd = 0 dry friction has no single value (it is anything up to fs); here
    sgn(0) = 0, while the simulation handles sticking properly.

    Raises InputError on a wrong shape or a number that is not finite.
    """
    friction = getattr(friction, "friction", friction)
    qd = vectors3("qd", qd, unit="rad/s")
    fv, fc, fs, qs, Tf = (np.array(getattr(friction, name)) for name in ("fv", "fc", "fs", "qs", "Tf"))
    stribeck = (fs - fc) * np.exp(-((qd / qs) ** 2))
    return fv * qd + np.sign(qd) * (fc + stribeck) + Tf
