"""Inertia tensors of simple solids by integration, and of links put together from them (1.100)-(1.110 corrected)."""

from dataclasses import dataclass

import numpy as np
import sympy

from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.modelling.arm import read_only, refuse_impossible_inertia

_TOLERANCE = 1e-9  # relative: rounding in tensors that were rotated or moved


def second_moment_tensor(p):
    """(p^T p) I3 - p p^T of one point, (3, 3): what (1.101) integrates over the solid (1.103 corrected).

    Args: p: (3,) coordinates, symbols or numbers. Returns: sympy matrix.
    """
    p = sympy.Matrix(p)
    return p.dot(p) * sympy.eye(3) - p * p.T


@dataclass(frozen=True)
class Solid:
    """A uniform solid as formulas: centre of mass and inertia tensor about it.

    sizes: the symbols of its dimensions, m.  mass: its symbol, kg.
    com (3, 1) m in the solid's own frame, inertia (3, 3) kg m^2 about the centre of mass.
    """

    name: str
    mass: sympy.Symbol
    sizes: tuple
    com: sympy.Matrix
    inertia: sympy.Matrix

    def body(self, mass, **sizes):
        """Numbers put in: a Body with this mass (kg) and these sizes (m), by the names in `sizes`.

        Raises InputError if a size is missing, unknown or not positive (or mass is not).
        """
        names = [str(s) for s in self.sizes]
        if sorted(names) != sorted(sizes):
            raise InputError(f"a {self.name} has the sizes {', '.join(names)} (m); got {', '.join(sizes) or 'none'}")
        for name, value in {"mass": mass, **sizes}.items():
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"{name} = {value} of the {self.name} must be a positive number (SI units)")
        if sizes.get("r", 0) >= sizes.get("R", np.inf):
            raise InputError(f"inner radius r = {sizes['r']} m is not below the outer radius R = {sizes['R']} m")
        table = {self.mass: float(mass), **{s: float(sizes[str(s)]) for s in self.sizes}}
        com = np.array(self.com.subs(table), dtype=float).ravel()
        return Body(mass=mass, com=com, inertia=np.array(self.inertia.subs(table), dtype=float))


def integrate_solid(name, p, limits, *, volume_element=1):
    """Mass properties of a uniform solid by three nested integrals (1.101), (1.105)-(1.110 corrected).

    Args:
        name: what to call it.
        p: (3,) position of a point of the solid, formulas in the three coordinates that are integrated.
        limits: [(coordinate, from, to), ...], innermost integral first; the other symbols become the sizes.
        volume_element: dV over the product of the differentials, e.g. r in cylindrical coordinates.

    Returns: Solid, inertia about its centre of mass, mass as the symbol m (density = m / volume).
    """

    def integral(f):
        for coordinate, low, high in limits:
            f = sympy.integrate(f, (coordinate, low, high))
        return f

    p = sympy.Matrix(p)
    m = sympy.Symbol("m", positive=True)
    volume = integral(sympy.sympify(volume_element))
    density = m / volume
    com = p.applyfunc(lambda x: sympy.factor(integral(sympy.expand(x * volume_element)) / volume))
    about_origin = second_moment_tensor(p).applyfunc(lambda f: density * integral(sympy.expand(f * volume_element)))
    about_com = (about_origin - m * second_moment_tensor(com)).applyfunc(sympy.factor)
    sizes = tuple(sorted(sympy.Tuple(volume, *com).free_symbols, key=str))
    return Solid(name, m, sizes, sympy.ImmutableMatrix(com), sympy.ImmutableMatrix(about_com))


def cylinder():
    """A solid cylinder of radius R and length L along x."""
    return _turned("cylinder", 0, sympy.Symbol("R", positive=True))


def tube():
    """A hollow cylinder of outer radius R, inner radius r and length L along x."""
    r, R = sympy.symbols("r R", positive=True)
    return _turned("tube", r, R)


def _turned(name, inner, outer):
    L, x, rho, phi = sympy.Symbol("L", positive=True), *sympy.symbols("x rho phi", real=True)
    p = (x, rho * sympy.cos(phi), rho * sympy.sin(phi))
    return integrate_solid(
        name, p, [(x, -L / 2, L / 2), (phi, 0, 2 * sympy.pi), (rho, inner, outer)], volume_element=rho
    )


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body in numbers: mass kg, com (3,) m, inertia (3, 3) kg m^2 about the centre of mass.

    The inertia tensor is I = [[Ixx, -Ixy, -Ixz], [-Ixy, Iyy, -Iyz], [-Ixz, -Iyz, Izz]] (1.104 corrected).
    Bodies can be moved and added: a link is a tube plus a motor.

    Raises InputError on wrong shapes, ArmError for a tensor that no rigid body has (not symmetric, a negative
    principal moment, or one larger than the sum of the other two).
    """

    mass: float
    com: np.ndarray = (0.0, 0.0, 0.0)
    inertia: np.ndarray = ((0.0, 0.0, 0.0),) * 3

    def __post_init__(self):
        com, inertia = np.array(self.com, dtype=float), np.array(self.inertia, dtype=float)
        if com.shape != (3,) or inertia.shape != (3, 3):
            raise InputError(f"com has shape {com.shape}, inertia {inertia.shape}; give (3,) in m and (3, 3) in kg m^2")
        if not (np.isfinite(self.mass) and np.isfinite(com).all() and np.isfinite(inertia).all()):
            raise InputError("mass, com and inertia of a body must be finite numbers")
        if self.mass < 0:
            raise ArmError(f"mass = {self.mass} kg: a mass cannot be negative")
        if np.abs(inertia - inertia.T).max() > _TOLERANCE * np.abs(inertia).max():
            raise ArmError("the inertia tensor is not symmetric: entries (i, j) and (j, i) are the same integral")
        principal = np.linalg.eigvalsh(inertia)
        principal[np.abs(principal) < _TOLERANCE * np.abs(principal).max()] = 0.0  # a slender rod has an exact zero
        refuse_impossible_inertia("the body (principal axes)", principal)
        object.__setattr__(self, "com", read_only(com))
        object.__setattr__(self, "inertia", read_only(inertia))
        object.__setattr__(self, "mass", float(self.mass))

    def about(self, point=(0.0, 0.0, 0.0)):
        """Inertia tensor about another point by Steiner's theorem: I + m (d^T d I3 - d d^T), (3, 3) kg m^2.

        point: (3,) m. d is the vector from the point to the centre of mass.
        """
        d = self.com - np.asarray(point, dtype=float)
        return self.inertia + self.mass * (d @ d * np.eye(3) - np.outer(d, d))

    def moved(self, by):
        """The same body shifted by (3,) m; its inertia about its own centre of mass stays."""
        return Body(self.mass, self.com + np.asarray(by, dtype=float), self.inertia)

    def __add__(self, other):
        """Both bodies as one: masses add, tensors add about the common centre of mass."""
        mass = self.mass + other.mass
        com = (self.mass * self.com + other.mass * other.com) / mass
        return Body(mass, com, self.about(com) + other.about(com))
