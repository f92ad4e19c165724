"""The equations of motion derived as formulas, in milliseconds: frames, Jacobians, M, C, g, energy (1.74)-(1.114)."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
import sympy

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice
from ir50p_lab.modelling import derivation
from ir50p_lab.modelling.symbolic_display import Formulas, short_names

_COM_AND_INERTIA = {
    "in-line": "lc1 lc2 lc3 Izz1 Ixx2 Iyy2 Izz2 Ixx3 Iyy3 Izz3",
    "general": "x1 y1 z1 x2 y2 z2 x3 y3 z3 "
    "Ixx1 Iyy1 Izz1 Ixy1 Ixz1 Iyz1 Ixx2 Iyy2 Izz2 Ixy2 Ixz2 Iyz2 Ixx3 Iyy3 Izz3 Ixy3 Ixz3 Iyz3",
    "thesis": "lc1 lc2 lc3 Izz1 Iyy2 Izz2 Iyz2 Iyy3 Izz3 Iyz3",
}


@dataclass(frozen=True)
class SymbolicModel:
    """The arm as formulas in q1, q2, q3, their rates and the physical parameters (SI units throughout).

    ========== ================================================================== ====================
    field      meaning                                                            shape
    ========== ================================================================== ====================
    q, qd, qdd symbols of the joint angles (rad), velocities and accelerations    (3, 1) each
    symbols    the physical parameters by name: symbols["m2"]                     dict
    frames     T^0_0 ... T^0_3 (1.31 corrected)                                   4 of (4, 4)
    J          geometric Jacobian of the tip, rows v then omega, base frame       (6, 3)
    com        centres of mass p_c1, p_c2, p_c3 in the base frame                 3 of (3, 1)
    Jv, Jw     Jacobians of the centres of mass and of the links' rotation        3 of (3, 3) each
    M          mass matrix (1.90 corrected), rotor inertias j on its diagonal     (3, 3) kg m^2
    C          Coriolis matrix by Christoffel symbols: dM/dt - 2 C is skew        (3, 3)
    g          gravity torque (1.114)                                             (3, 1) N m
    potential  potential energy, zero at the height of the base (1.111)           J
    ========== ================================================================== ====================
    """

    links: str
    q: sympy.Matrix
    qd: sympy.Matrix
    qdd: sympy.Matrix
    symbols: dict
    frames: tuple
    J: sympy.Matrix
    com: tuple
    Jv: tuple
    Jw: tuple
    M: sympy.Matrix
    C: sympy.Matrix
    g: sympy.Matrix
    potential: sympy.Expr
    _b: tuple

    def b(self, i, j, k):
        """Return the Christoffel symbol b_ijk = 1/2 (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i), i, j, k = 1, 2, 3 (1.96).

        Raises InputError for other indices.
        """
        if not {i, j, k} <= {1, 2, 3}:
            raise InputError(f"b({i}, {j}, {k}): the indices count the joints, 1 to 3, as in (1.96)")
        return self._b[i - 1][j - 1][k - 1]

    @property
    def h(self):
        """Centrifugal and Coriolis torque C(q, qd) qd, (3, 1) N m, sorted by products of velocities (1.97)."""
        pairs = [(j, k) for j in range(3) for k in range(j, 3)]
        return sympy.ImmutableMatrix(
            [sympy.Add(*[sympy.Mul(1 + (j != k), b[j][k], self.qd[j], self.qd[k]) for j, k in pairs]) for b in self._b]
        )

    @property
    def kinetic(self):
        """Kinetic energy 1/2 qd^T M qd, J (1.78)."""
        return (self.qd.T * self.M * self.qd)[0] / 2

    @property
    def tau(self):
        """Joint torque M qdd + C qd + g of the arm without friction, (3, 1) N m (1.74)."""
        return self.M * self.qdd + self.h + self.g

    def read(self, name):
        """Return the entries of "M", "C", "g", "h" or "tau" as equations to read, without those that are zero.

        Of M only the upper triangle is listed. A notebook shows them in the thesis's notation, c_23 = cos(q2 + q3).
        Returns: Formulas. Raises InputError for another name.
        """
        choice("name", name, ("M", "C", "g", "h", "tau"))
        matrix = getattr(self, name).xreplace(short_names(self.q))
        letter = {"tau": r"\tau"}.get(name, name)
        rows = []
        for i in range(3):
            for j in range(matrix.shape[1]):
                if matrix[i, j] != 0 and not (name == "M" and j < i):
                    place = f"{i + 1}{j + 1}" if matrix.shape[1] > 1 else f"{i + 1}"
                    rows.append((f"{letter}_{{{place}}}", matrix[i, j]))
        return Formulas(rows)

    def values(self, arm):
        """Return the numbers of an arm for `symbols`, in their order, as a list of floats.

        Args:
            arm: an Arm, or a mapping of parameter names to numbers in SI units ("l1", "m2", "Izz3", "g", ...).
                Inertias and the rotor inertias j1, j2, j3, may be left out; they are 0 then.

        Raises InputError for an unknown or missing name, for a number that is not finite, and for an Arm if `links`
        is "thesis" (its constant inertias belong to no rigid body: give a mapping).
        """
        if isinstance(arm, Mapping):
            given = arm
        elif self.links == "thesis":
            raise InputError(
                "the thesis's model holds constant products of inertia, which an Arm cannot: give a mapping of "
                "parameter names to numbers, or use derive() for this arm"
            )
        else:
            given = {name: value for name, value in _from_arm(arm).items() if name in self.symbols}
        for name, value in given.items():
            if name not in self.symbols:
                raise InputError(f"{name!r} is not a parameter of this model; it has {', '.join(self.symbols)}")
            if not np.isfinite(value):
                raise InputError(f"{name} = {value}: every parameter must be finite")
        missing = [name for name in self.symbols if name not in given and name[0] not in "Ij"]
        if missing:
            raise InputError(
                f"no number for {', '.join(missing)}; give them as {{'{missing[0]}': 1.0, ...}} in SI units"
            )
        return [float(given.get(name, 0.0)) for name in self.symbols]


def derive(*, links="in-line", general=False):
    """Derive the arm's equations of motion as formulas, from the DH table to M, C, g (1.29)-(1.114, corrected).

    Args:
        links: which mass distribution the links have.
            "in-line" (default) is what `Arm` describes: centre of mass lc_i on the link axis, moments Ixx, Iyy, Izz
            about it in the link frame (link 1: z along the column; links 2 and 3: x along the link, z = joint axis).
            "general": centre of mass (x_i, y_i, z_i) anywhere in the link frame, from the joint, and six components
            of inertia per link, I = [[Ixx, -Ixy, -Ixz], [-Ixy, Iyy, -Iyz], [-Ixz, -Iyz, Izz]] (1.104 corrected).
            "thesis": the thesis's model with its algebra put right: inertias that stay constant in the frame that
            turns with joint 1 only, and m1 lc1^2 in M11. No rigid body has them; kept to reproduce its numbers.
        general: True means the same as links="general".

    Returns: SymbolicModel. This takes about 0.1 s.

    Raises InputError for any other word.
    """
    links = "general" if general else choice("links", links, _COM_AND_INERTIA)
    q, qd, qdd = (sympy.ImmutableMatrix(sympy.symbols(f"{name}1:4", real=True)) for name in ("q", "qdot", "qddot"))
    names = f"g l1 l2 l3 m1 m2 m3 {_COM_AND_INERTIA[links]} j1 j2 j3".split()
    symbols = {name: sympy.Symbol(name, real=True) for name in names}
    by = [symbols[name] for name in names if name[0] in "mIj"]

    @cache  # the same sums come back
    def formula(expression):
        return derivation.ordered(expression, by)

    frames, rotations = derivation.chain(q, *(symbols[name] for name in ("l1", "l2", "l3")))
    centres, tensors = derivation.bodies(symbols, links, frames, rotations)
    Jv = [p.jacobian(q) for p in centres]
    Jw = derivation.angular_jacobians(frames)
    M = derivation.mass_matrix(q, symbols, Jv, Jw, tensors).applyfunc(formula)
    b = [[list(map(formula, row)) for row in block] for block in derivation.christoffel(q, M)]
    potential = formula(symbols["g"] * sum(symbols[f"m{i + 1}"] * centres[i][2] for i in range(3)))

    def tidy(matrix):
        return sympy.ImmutableMatrix(matrix.applyfunc(sympy.factor_terms))

    return SymbolicModel(
        links=links,
        q=q,
        qd=qd,
        qdd=qdd,
        symbols=symbols,
        frames=tuple(map(tidy, frames)),
        J=tidy(frames[3][:3, 3].jacobian(q).col_join(Jw[2])),
        com=tuple(map(tidy, centres)),
        Jv=tuple(map(tidy, Jv)),
        Jw=tuple(map(tidy, Jw)),
        M=sympy.ImmutableMatrix(M),
        C=sympy.ImmutableMatrix(3, 3, lambda i, j: sympy.Add(*[b[i][j][k] * qd[k] for k in range(3)])),
        g=sympy.ImmutableMatrix([formula(potential.diff(angle)) for angle in q]),
        potential=potential,
        _b=b,
    )


def same_function(a, b):
    """Return True if two formulas are the same function of the angles, proved exactly, not by trying numbers.

    Written with exponentials and expanded, such a function has only one form.

    Args:
        a, b: sympy expressions, or matrices of one shape, polynomial in sines and cosines of sums of symbols.
    """
    if isinstance(a, sympy.MatrixBase) or isinstance(b, sympy.MatrixBase):
        a, b = sympy.Matrix(a), sympy.Matrix(b)
        return a.shape == b.shape and all(map(same_function, a, b))
    difference = (sympy.sympify(a) - b).rewrite([sympy.sin, sympy.cos], sympy.exp)
    return sympy.expand(difference) == 0


def _from_arm(arm):
    """The numbers of an Arm by parameter name, for in-line and for general links."""
    rotors = (0.0, 0.0, 0.0) if arm.actuators is None else arm.actuators.reflected_inertia
    numbers = {"g": arm.g}
    for i in range(3):
        com = dict.fromkeys("xyz", 0.0) | {"z" if i == 0 else "x": arm.lc[i]}
        link = {"l": arm.l[i], "m": arm.m[i], "j": rotors[i], "lc": arm.lc[i], **com}
        link |= {name: getattr(arm, name)[i] for name in ("Ixx", "Iyy", "Izz")}
        numbers |= {f"{name}{i + 1}": value for name, value in link.items()}
    return numbers
