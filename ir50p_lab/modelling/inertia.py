"""Inertia tensors of simple solids, by integration (1.100)-(1.110 corrected)."""

from dataclasses import dataclass

import sympy


def second_moment_tensor(p):
    """Return (p^T p) I3 - p p^T of one point, (3, 3), which (1.101) integrates over the solid (1.103 corrected).

    Args: p: (3,) coordinates, symbols or numbers. Returns: sympy matrix.
    """
    p = sympy.Matrix(p)
    return p.dot(p) * sympy.eye(3) - p * p.T


@dataclass(frozen=True)
class Solid:
    """A uniform solid as formulas: its centre of mass, and its inertia tensor about it.

    com: (3, 1) m in the solid's own frame; inertia: (3, 3) kg m^2 about the centre of mass. The mass is the symbol m.
    """

    com: sympy.Matrix
    inertia: sympy.Matrix


def integrate_solid(p, limits, *, volume_element=1):
    """Return the mass properties of a uniform solid by three nested integrals (1.101), (1.105)-(1.110 corrected).

    Args:
        p: (3,) position of a point of the solid, formulas in the three coordinates that are integrated.
        limits: [(coordinate, from, to), ...], innermost integral first; the other symbols are the solid's sizes.
        volume_element: dV divided by the product of the differentials, e.g. r in cylindrical coordinates.

    Returns: Solid, with the inertia about its centre of mass and the mass as the symbol m (density = m / volume).
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
    return Solid(sympy.ImmutableMatrix(com), sympy.ImmutableMatrix(about_com))


def cylinder():
    """Return the Solid of a full cylinder of radius R and length L along x, with R and L as symbols."""
    R, L = sympy.symbols("R L", positive=True)
    x, rho, phi = sympy.symbols("x rho phi", real=True)
    p = (x, rho * sympy.cos(phi), rho * sympy.sin(phi))
    return integrate_solid(p, [(x, -L / 2, L / 2), (phi, 0, 2 * sympy.pi), (rho, 0, R)], volume_element=rho)
