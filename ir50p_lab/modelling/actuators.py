"""The three DC motors with gears, in honest units (1.118)-(1.120 corrected)."""

from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np

from ir50p_lab.errors import ArmError
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.kernel import same_shape


@dataclass(frozen=True, kw_only=True)
class Actuators:
    """DC motors behind reduction gears, driven by a bridge in PWM counts.

    With u the voltage at the motor, tau the torque at the joint and the small inductance left out:

        u = Ra / (kt N) [tau + N^2 Jm qdd] + ke N qd        (1.118)-(1.120) corrected

    The thesis adds volts to newton metres, takes N Jm for the reflected inertia N^2 Jm and leaves the
    back-EMF out (it then hides in the viscous friction).

    ========= ======================================= ===================
    field     meaning                                 shape, unit
    ========= ======================================= ===================
    N         gear ratio, motor turns per joint turn  (3,)
    Jm        rotor inertia                           (3,) kg m^2
    kt        torque constant of the motor            (3,) N m/A
    ke        back-EMF constant of the motor          (3,) V s/rad
    Ra        armature resistance                     (3,) ohm
    V         supply voltage                          V
    limit_pwm PWM count that gives the full supply    counts
    ========= ======================================= ===================

    Raises ArmError if a value is not positive (Jm may be 0), InputError for wrong shapes and what is not a number.
    """

    N: tuple = field(metadata={"comment": "gear ratio"})
    Jm: tuple = field(metadata={"comment": "kg m^2, rotor"})
    kt: tuple = field(metadata={"comment": "N m/A"})
    ke: tuple = field(metadata={"comment": "V s/rad"})
    Ra: tuple = field(metadata={"comment": "ohm"})
    V: float = field(metadata={"comment": "V, supply"})
    limit_pwm: float = field(default=255.0, metadata={"comment": "counts that give the full supply"})

    def __post_init__(self):
        for each in fields(self):
            name, value = f"actuators {each.name}", getattr(self, each.name)
            value = number(name, value) if each.type is float else tuple(vector3(name, value, unit="SI").tolist())
            object.__setattr__(self, each.name, value)
            least = np.min(value)
            if least < 0 or (least == 0 and each.name != "Jm"):
                raise ArmError(f"{name} = {least}: must be a positive number")

    @classmethod
    def from_joint_data(cls, *, stall_torque, no_load_speed, reflected_inertia, N, V, limit_pwm=255.0):
        """Motors from what can be measured at the joint at supply `V`.

        Args: stall_torque (3,) N m, no_load_speed (3,) rad/s, reflected_inertia = N^2 Jm (3,) kg m^2,
        gear ratio N (3,), V volts. With kt = ke (SI, an ideal DC machine): ke = V/(N w0), Ra = kt N V/tau_stall.
        """
        stall_torque = vector3("stall_torque", stall_torque, unit="N m")
        no_load_speed = vector3("no_load_speed", no_load_speed, unit="rad/s")
        N = vector3("N", N, unit="1")
        for name, values in (("stall_torque", stall_torque), ("no_load_speed", no_load_speed), ("N", N)):
            if (values <= 0).any():
                raise ArmError(f"{name} = {values.tolist()}: every value must be positive")
        Jm = vector3("reflected_inertia", reflected_inertia, unit="kg m^2") / N**2
        k = V / (N * no_load_speed)
        return cls(N=N, Jm=Jm, kt=k, ke=k, Ra=k * N * V / stall_torque, V=V, limit_pwm=limit_pwm)

    def _array(self, name):
        return np.array(getattr(self, name))

    @cached_property
    def reflected_inertia(self):
        """N^2 Jm: rotor inertia felt at the joint, (3,) kg m^2."""
        return self._array("N") ** 2 * self._array("Jm")

    @cached_property
    def stall_torque(self):
        """Torque at the joint at full supply and no speed, (3,) N m."""
        return self._array("N") * self._array("kt") * self.V / self._array("Ra")

    @cached_property
    def no_load_speed(self):
        """Joint speed at full supply and no torque, (3,) rad/s."""
        return self.V / (self._array("N") * self._array("ke"))

    @cached_property
    def gain(self):
        """K: joint torque per PWM count at no speed, (3,) N m per count."""
        return self.stall_torque / self.limit_pwm

    @cached_property
    def back_emf_damping(self):
        """kt ke N^2 / Ra: the brake that a driven DC motor is, felt at the joint, (3,) N m s/rad."""
        return self._array("kt") * self._array("ke") * self._array("N") ** 2 / self._array("Ra")

    def voltage(self, tau, qd, qdd=(0.0, 0.0, 0.0)):
        """Motor voltage for joint torque tau at velocity qd and acceleration qdd (1.120 corrected), V.

        tau, qd, qdd: (3,) or (n, 3) in N m, rad/s, rad/s^2. The result may exceed the supply: compare with `V`.
        """
        tau, qd, qdd = same_shape(tau=tau, qd=qd, qdd=qdd)
        N = self._array("N")
        drive = tau + self.reflected_inertia * qdd
        return self._array("Ra") / (self._array("kt") * N) * drive + self._array("ke") * N * qd
