"""The three DC motors with their gears, in consistent units (1.118)-(1.120 corrected)."""

from dataclasses import dataclass, field, fields
from functools import cached_property

import numpy as np

from ir50p_lab.errors import ArmError
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.kernel import same_shape


@dataclass(frozen=True, kw_only=True)
class Actuators:
    """DC motors behind reduction gears, driven by a bridge whose command is given in PWM counts.

    With u the voltage at the motor, tau the torque at the joint, and the small inductance neglected:

        u = Ra / (kt N) [tau + N^2 Jm qdd] + ke N qd        (1.118)-(1.120) corrected

    The thesis adds volts to newton metres, takes N Jm for the reflected inertia N^2 Jm and leaves out the
    back-EMF (which then hides in the viscous friction).

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

    Raises ArmError if a value is not positive (Jm may be 0), and InputError if a shape is wrong or a value is
    not a number.
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
        """Make the Actuators from what can be measured at the joints with supply `V`.

        The motors are taken as ideal DC machines, kt = ke in SI units: ke = V/(N w0) and Ra = kt N V/tau_stall,
        with w0 the no-load speed of the joint.

        Args:
            stall_torque: (3,) N m; no_load_speed: (3,) rad/s; both at the joint, > 0.
            reflected_inertia: N^2 Jm, (3,) kg m^2. N: gear ratio, (3,), > 0. V: supply, V.
            limit_pwm: PWM count that gives the full supply.

        Returns: Actuators. Raises ArmError for values that are not positive, InputError for wrong shapes.
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
        """Rotor inertia N^2 Jm as it is felt at the joint, (3,) kg m^2."""
        return self._array("N") ** 2 * self._array("Jm")

    @cached_property
    def stall_torque(self):
        """Torque at the joint with full supply and at standstill, (3,) N m."""
        return self._array("N") * self._array("kt") * self.V / self._array("Ra")

    @cached_property
    def no_load_speed(self):
        """Speed of the joint with full supply and without torque, (3,) rad/s."""
        return self.V / (self._array("N") * self._array("ke"))

    @cached_property
    def gain(self):
        """Gain K: the joint torque that one PWM count makes at standstill, (3,) N m per count."""
        return self.stall_torque / self.limit_pwm

    @cached_property
    def back_emf_damping(self):
        """Damping kt ke N^2 / Ra, by which a driven DC motor brakes itself, as felt at the joint, (3,) N m s/rad."""
        return self._array("kt") * self._array("ke") * self._array("N") ** 2 / self._array("Ra")

    def voltage(self, tau, qd, qdd=(0.0, 0.0, 0.0)):
        """Return the motor voltage for joint torque tau at velocity qd and acceleration qdd (1.120 corrected).

        Args: tau, qd, qdd: (3,) or (n, 3), N m, rad/s and rad/s^2; qdd is zero by default.
        Returns: the same shape, V. It may exceed the supply: compare it with `V`. Raises InputError for wrong shapes.
        """
        tau, qd, qdd = same_shape(tau=tau, qd=qd, qdd=qdd)
        N = self._array("N")
        drive = tau + self.reflected_inertia * qdd
        return self._array("Ra") / (self._array("kt") * N) * drive + self._array("ke") * N * qd
