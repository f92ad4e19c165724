"""The arm: a 3-DOF elbow manipulator, described by its lengths, masses and inertias, and checked when it is made."""

import dataclasses
import warnings
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ir50p_lab.errors import ArmError, SuspiciousArmWarning
from ir50p_lab.inputs import number, numbers, vector3, vectors3
from ir50p_lab.modelling.actuators import Actuators
from ir50p_lab.modelling.arm_file import read_arm, write_arm
from ir50p_lab.modelling.friction import Friction

_VECTORS = {"l": "m", "m": "kg", "lc": "m", "Ixx": "kg m^2", "Iyy": "kg m^2", "Izz": "kg m^2"}
_RELATIVE_SLACK = 1e-9  # share of Ixx + Iyy + Izz allowed for rounding: a slender rod meets Ixx + Iyy = Izz exactly


@dataclass(frozen=True, kw_only=True)
class Arm:
    """A 3-DOF elbow arm with in-line links: waist (vertical axis), shoulder, elbow.

    Standard DH (Table 1.1 corrected): theta = q; d = (l1, 0, 0); a = (0, l2, l3); alpha = (+90, 0, -90) deg.
    In the zero pose upper arm and forearm lie stretched along x, horizontally; q2 > 0 and q3 > 0 lift them.

    ========= ================================================================== ============
    field     meaning                                                            unit
    ========= ================================================================== ============
    l         height of the column, lengths of upper arm and forearm             (3,) m
    m         masses of the links                                                (3,) kg
    lc        centre of mass on the link axis, from the joint (link 1: height)   (3,) m
    Ixx..Izz  moments of inertia about the centre of mass in the link frame      (3,) kg m^2
    friction  Friction at the joints                                             N m
    actuators Actuators, or None for an arm driven by torque                     SI
    q_min/max joint limits                                                       (3,) rad
    g         gravitational acceleration                                         m/s^2
    payload   mass at the tip, already counted in link 3 (see `with_payload`)    kg
    ========= ================================================================== ============

    Link frames: link 1 has z along the column; links 2 and 3 have x along the link and z along the joint axis.
    The 20 parameters theta are exact for such in-line links only. `Arm.from_rigid_bodies` takes full centres of
    mass and inertia tensors and refuses every arm that is not in-line; `derive(general=True)` can still derive it.

    Raises ArmError for what no rigid body can have, and InputError if a shape is wrong or a value is not a number.
    Warns (SuspiciousArmWarning) of what is possible but hardly meant; `suspicions` keeps these sentences.
    """

    name: str = "my arm"
    l: tuple = field(metadata={"comment": "m: column height, upper arm, forearm"})
    m: tuple = field(metadata={"comment": "kg"})
    lc: tuple = field(metadata={"comment": "m: centre of mass on the link axis, from the joint (link 1: height)"})
    Ixx: tuple = field(
        default=(0.0, 0.0, 0.0),
        metadata={"comment": "kg m^2, about the centre of mass; x along links 2 and 3, z along the joint axis"},
    )
    Iyy: tuple = field(default=(0.0, 0.0, 0.0), metadata={"comment": "kg m^2"})
    Izz: tuple = field(default=(0.0, 0.0, 0.0), metadata={"comment": "kg m^2 (link 1: about the column)"})
    friction: Friction = Friction()
    actuators: Actuators | None = None
    q_min: tuple = field(default=(-np.inf, -np.inf, -np.inf), metadata={"comment": "rad"})
    q_max: tuple = field(default=(np.inf, np.inf, np.inf), metadata={"comment": "rad"})
    g: float = field(default=9.81, metadata={"comment": "m/s^2"})
    payload: float = field(default=0.0, metadata={"comment": "kg at the tip, counted in m, lc, Iyy and Izz of link 3"})

    def __post_init__(self):
        if not isinstance(self.name, str) or "$" in self.name:
            raise ArmError(f"name = {self.name!r}: give a text without $, which figures take for mathematics")
        for name, unit in _VECTORS.items():
            object.__setattr__(self, name, tuple(vector3(name, getattr(self, name), unit=unit).tolist()))
        for name in ("q_min", "q_max"):
            values = numbers(name, getattr(self, name), unit="rad")
            if values.shape != (3,) or np.isnan(values).any():
                raise ArmError(f"{name} = {getattr(self, name)!r}: give three angles in rad (inf for no limit)")
            object.__setattr__(self, name, tuple(values.tolist()))
        object.__setattr__(self, "g", number("g", self.g, ">= 0", unit="m/s^2", hint="the base z axis points up"))
        object.__setattr__(self, "payload", number("payload", self.payload, unit="kg"))
        self._refuse_impossible()
        for text in self.suspicions:
            warnings.warn(f"{self.name}: {text}", SuspiciousArmWarning, stacklevel=3)

    def _refuse_impossible(self):
        for i in range(3):
            if self.l[i] < 0 or (i > 0 and self.l[i] == 0):
                raise ArmError(f"l{i + 1} = {self.l[i]} m: the column may be 0, upper arm and forearm must be > 0")
            if self.m[i] < 0:
                raise ArmError(f"m{i + 1} = {self.m[i]} kg: a mass cannot be negative")
            refuse_impossible_inertia(f"link {i + 1}", (self.Ixx[i], self.Iyy[i], self.Izz[i]))
            if abs(self.lc[i]) > 3 * sum(self.l):
                raise ArmError(
                    f"lc{i + 1} = {self.lc[i]} m: the centre of mass lies {abs(self.lc[i]) / sum(self.l):.0f} times "
                    "the whole arm away from its joint; is it in millimetres? Give metres"
                )
            if self.q_min[i] >= self.q_max[i]:
                raise ArmError(f"joint {i + 1}: q_min = {self.q_min[i]} rad is not below q_max = {self.q_max[i]} rad")

    @cached_property
    def suspicions(self):
        """What is possible but hardly meant, as a tuple of sentences; it is empty for a plausible arm."""
        found = []
        for i, (l, lc, *limits) in enumerate(zip(self.l, self.lc, self.q_min, self.q_max, strict=True), start=1):
            if l > 0 and lc > l:
                found.append(
                    f"the centre of mass of link {i} is {lc / l:.2g} link lengths out (lc = {lc} m, l = {l} m)"
                )
            if lc < 0:
                found.append(f"the centre of mass of link {i} is behind its joint (lc = {lc} m)")
            if l > 10:
                found.append(f"l{i} = {l} m is longer than 10 m: is it in millimetres?")
            for limit in limits:
                if np.isfinite(limit) and abs(limit) > 4 * np.pi:
                    found.append(f"a limit of joint {i} is {limit} rad, over two turns: is it in degrees?")
        return tuple(found)

    @classmethod
    def from_rigid_bodies(cls, *, l, m, com, inertia, **options):
        """Make an arm from full centres of mass and inertia tensors; refuse one that is not in-line, with the reason.

        Args:
            l, m: as in Arm.
            com: (3, 3) m, centres of mass, one row per link, in the link frame with its origin at the joint.
            inertia: (3, 3, 3) kg m^2, one tensor per link about its centre of mass, in the link frame.
            options: the other fields of Arm.

        Returns: Arm. Raises ArmError if a shape is wrong, a centre of mass is off the link axis, or a tensor has
        products of inertia (1.104 corrected: I = [[Ixx, -Ixy, -Ixz], ...]).
        """
        com, inertia = vectors3("com", com, unit="m"), np.asarray(inertia, dtype=float)
        if com.shape != (3, 3) or inertia.shape != (3, 3, 3) or not np.isfinite(inertia).all():
            raise ArmError(f"com has shape {com.shape}, inertia {inertia.shape}; give (3, 3) and (3, 3, 3), all finite")
        along = (2, 0, 0)  # the link's own axis: z of the column, x of the others
        for i in range(3):
            beside = np.hypot(*np.delete(com[i], along[i]))
            product = np.abs(inertia[i] - np.diag(np.diag(inertia[i]))).max()
            if beside > 1e-9 or product > 1e-9 * np.abs(inertia[i]).max():
                raise ArmError(
                    f"the centre of mass of link {i + 1} is {beside:.3g} m off the link axis and its products of "
                    f"inertia reach {product:.3g} kg m^2; the 20 parameters theta hold only links in line, which have "
                    "neither. derive(general=True) derives the others"
                )
        Ixx, Iyy, Izz = np.diagonal(inertia, axis1=1, axis2=2).T
        return cls(l=l, m=m, lc=com[range(3), along], Ixx=Ixx, Iyy=Iyy, Izz=Izz, **options)

    @property
    def reach(self):
        """The largest distance of the tip from the shoulder, l2 + l3, m."""
        return self.l[1] + self.l[2]

    @cached_property
    def theta(self):
        """The 20 parameters as (3, 20), three equal rows; with them torques are in N m.

        They are, in order: the rigid in-line arm with rotors, then fv and fc of each joint, Tf, j3 (2.50 corrected).
        theta 7 and 8 (the thesis's constant products of inertia) are 0, because no rigid body has them.
        The Stribeck part of the friction is not linear in the parameters, so theta does not hold it.
        """
        (_, m2, m3), (_, l2, _), (_, lc2, lc3) = self.m, self.l, self.lc
        _, X2, X3 = self.Ixx
        _, Y2, Y3 = self.Iyy
        Z1, Z2, Z3 = self.Izz
        j1, j2, j3 = (0.0, 0.0, 0.0) if self.actuators is None else self.actuators.reflected_inertia
        f = self.friction
        inertial = [
            j1 + Z1 + X2 + X3,
            m2 * lc2**2 + m3 * l2**2 + Y2 - X2,
            m2 * lc2 + m3 * l2,
            m3 * lc3,
            m3 * lc3**2 + Y3 - X3,
            m3 * lc3 * l2,
            0.0,
            0.0,
            Z2 - Y2 + X2 + j2,
            Z3 - Y3 + X3,
        ]
        dry = [value for joint in range(3) for value in (f.fv[joint], f.fc[joint])]
        return read_only(np.tile([*inertial, *dry, *f.Tf, j3], (3, 1)))

    @cached_property
    def lengths(self):
        """The lengths `l` as an array, (3,) m, for the compiled kernels."""
        return read_only(np.array(self.l))

    @cached_property
    def theta_pwm(self):
        """The 20 parameters of the arm as seen from the PWM counts, (3, 20): row i is divided by the gain K_i.

        u_i = (row i of Phi theta) / K_i, with the back-EMF as viscous friction. The rows differ if the motors
        do: then a fit with one theta for all joints is wrong (2.47 corrected). Raises ArmError for an arm
        without actuators.
        """
        if self.actuators is None:
            raise ArmError(f"{self.name} has no actuators: it is driven by torque, use theta (N m)")
        rows = self.theta.copy()
        rows[:, [10, 12, 14]] += self.actuators.back_emf_damping
        return read_only(rows / self.actuators.gain[:, None])

    def without_friction(self):
        """Return the same arm with no friction at all; the rotor inertia stays."""
        return dataclasses.replace(self, friction=Friction())

    def with_payload(self, mass):
        """Return the arm with a point mass `mass` (kg) at its tip.

        Mass, centre of mass and inertia of link 3 change with it, and `payload` grows by `mass`.
        """
        m3, lc3, l3 = self.m[2], self.lc[2], self.l[2]
        total = m3 + mass
        centre = (m3 * lc3 + mass * l3) / total
        more = m3 * lc3**2 + mass * l3**2 - total * centre**2  # Steiner, both parts
        return dataclasses.replace(
            self,
            m=(*self.m[:2], total),
            lc=(*self.lc[:2], centre),
            Iyy=(*self.Iyy[:2], self.Iyy[2] + more),
            Izz=(*self.Izz[:2], self.Izz[2] + more),
            payload=self.payload + mass,
        )

    @cached_property
    def bare(self):
        """The arm without its payload."""
        return self.with_payload(-self.payload) if self.payload else self

    def save(self, path):
        """Write the arm to `path` as TOML, with the units in comments. Arm.load reads it back."""
        write_arm(self, path)

    @classmethod
    def load(cls, path):
        """Read an arm from a TOML file at `path`. Raises ArmError, which names the file and what is wrong in it."""
        return read_arm(cls, path)


def refuse_impossible_inertia(who, principal):
    """Raise ArmError if no rigid body has the moments of inertia `principal` (3,) kg m^2 about axes through one point.

    None may be negative, and none may exceed the sum of the other two: Ixx + Iyy - Izz = 2 int z^2 dm >= 0.
    `who` names the body in the message.
    """
    (least, least_axis), _, (most, most_axis) = sorted(zip(principal, ("Ixx", "Iyy", "Izz"), strict=True))
    if least < 0:
        raise ArmError(f"{least_axis} of {who} is {least} kg m^2: a moment of inertia cannot be negative")
    others = sum(principal) - most
    if most > others + _RELATIVE_SLACK * sum(principal):
        raise ArmError(
            f"{most_axis} = {most:.6g} kg m^2 of {who} exceeds the sum of the other two, {others:.6g}: "
            "no rigid body has that (triangle inequality). Check the axes: x runs along links 2 and 3"
        )


def read_only(array):
    """Lock an array that is shared, so that no student's cell changes an arm by accident; return the array."""
    array.setflags(write=False)
    return array
