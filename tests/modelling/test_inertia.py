"""Inertia tensors by integration against textbook formulae."""

import pytest
import sympy

from ir50p_lab.modelling import cylinder, integrate_solid

m, a, b, c, R, L = sympy.symbols("m a b c R L", positive=True)


def box():
    """A solid of one's own: edges a, b, c along x, y, z."""
    p = sympy.symbols("x y z", real=True)
    limits = [(coordinate, -edge / 2, edge / 2) for coordinate, edge in zip(p, (a, b, c), strict=True)]
    return integrate_solid(p, limits)


def cone():
    """A solid of one's own: base radius R at x = 0, tip at x = L."""
    x, rho, phi = sympy.symbols("x rho phi", real=True)
    p = (x, rho * sympy.cos(phi), rho * sympy.sin(phi))
    limits = [(phi, 0, 2 * sympy.pi), (rho, 0, R * (1 - x / L)), (x, 0, L)]
    return integrate_solid(p, limits, volume_element=rho)


TEXTBOOK = {  # any handbook of mechanics; the axis of the turned solids is x
    box: (m * (b**2 + c**2) / 12, m * (a**2 + c**2) / 12, m * (a**2 + b**2) / 12),
    cylinder: (m * R**2 / 2, *[m * (3 * R**2 + L**2) / 12] * 2),
    cone: (3 * m * R**2 / 10, *[3 * m * (4 * R**2 + L**2) / 80] * 2),
}


@pytest.mark.parametrize("make", TEXTBOOK, ids=lambda f: f.__name__)
def test_textbook_formulae(make):
    solid = make()
    assert sympy.simplify(solid.inertia - sympy.diag(*TEXTBOOK[make])) == sympy.zeros(3)
    assert list(solid.com) == ([L / 4, 0, 0] if make is cone else [0, 0, 0])


def test_own_solid_with_products_of_inertia():
    """A plate that is a right triangle: Ixy about the centre of mass is -m a b / 36 (handbook: -a^2 b^2 rho / 72)."""
    x, y = sympy.symbols("x y")
    plate = integrate_solid((x, y, 0), [(y, 0, b * (1 - x / a)), (x, 0, a)])
    assert list(plate.com) == [a / 3, b / 3, 0]
    assert sympy.simplify(plate.inertia[0, 1] - m * a * b / 36) == 0
