"""Inertia tensors by integration against textbook formulae, MuJoCo and the energy of points."""

import numpy as np
import pytest
import sympy
from refusals import refused

from ir50p_lab.errors import ArmError
from ir50p_lab.modelling import Arm, Body, cylinder, integrate_solid, rot_x, rot_z, tube

m, a, b, c, R, r, L = sympy.symbols("m a b c R r L", positive=True)


def box():
    """A solid of one's own: edges a, b, c along x, y, z."""
    p = sympy.symbols("x y z", real=True)
    limits = [(coordinate, -edge / 2, edge / 2) for coordinate, edge in zip(p, (a, b, c), strict=True)]
    return integrate_solid("box", p, limits)


def cone():
    """A solid of one's own: base radius R at x = 0, tip at x = L."""
    x, rho, phi = sympy.symbols("x rho phi", real=True)
    p = (x, rho * sympy.cos(phi), rho * sympy.sin(phi))
    limits = [(phi, 0, 2 * sympy.pi), (rho, 0, R * (1 - x / L)), (x, 0, L)]
    return integrate_solid("cone", p, limits, volume_element=rho)


TEXTBOOK = {  # any handbook of mechanics; the axis of the turned solids is x
    box: (m * (b**2 + c**2) / 12, m * (a**2 + c**2) / 12, m * (a**2 + b**2) / 12),
    cylinder: (m * R**2 / 2, *[m * (3 * R**2 + L**2) / 12] * 2),
    tube: (m * (R**2 + r**2) / 2, *[m * (3 * (R**2 + r**2) + L**2) / 12] * 2),
    cone: (3 * m * R**2 / 10, *[3 * m * (4 * R**2 + L**2) / 80] * 2),
}


@pytest.mark.parametrize("make", TEXTBOOK, ids=lambda f: f.__name__)
def test_textbook_formulae(make):
    solid = make()
    assert sympy.simplify(solid.inertia - sympy.diag(*TEXTBOOK[make])) == sympy.zeros(3)
    assert list(solid.com) == ([L / 4, 0, 0] if make is cone else [0, 0, 0])


def test_steiner_agrees_with_the_kinetic_energy_of_points():
    rng = np.random.default_rng(2)
    points, masses = rng.normal(size=(20, 3)), rng.uniform(0.1, 1, 20)
    body = sum((Body(mass, p) for mass, p in zip(masses, points, strict=True)), start=Body(0.0))
    turn = rot_z(0.4) @ rot_x(-1.1)
    pivot, omega = np.array([0.3, -0.2, 0.5]), np.array([0.7, -0.4, 1.2])
    velocity = np.cross(omega, points @ turn.T - pivot)
    kinetic = 0.5 * masses @ (velocity**2).sum(axis=1)
    turned = Body(body.mass, turn @ body.com, turn @ body.inertia @ turn.T)
    assert np.isclose(0.5 * omega @ turned.about(pivot) @ omega, kinetic, rtol=1e-13)
    assert np.isclose(body.mass, masses.sum())


def test_own_solid_with_products_of_inertia():
    """A plate that is a right triangle: Ixy about the centre of mass is -m a b / 36 (handbook: -a^2 b^2 rho / 72)."""
    x, y = sympy.symbols("x y")
    plate = integrate_solid("triangle", (x, y, 0), [(y, 0, b * (1 - x / a)), (x, 0, a)])
    assert list(plate.com) == [a / 3, b / 3, 0]
    assert sympy.simplify(plate.inertia[0, 1] - m * a * b / 36) == 0
    assert plate.sizes == (a, b)


def test_link_from_a_drawing_becomes_an_arm():
    pipe = tube().body(0.4, R=0.02, r=0.018, L=0.3).moved([0.15, 0, 0])
    motor = cylinder().body(0.6, R=0.03, L=0.06)
    link = pipe + motor
    com, inertia = [[0, 0, 0.1], link.com, link.com], [np.eye(3) * 0.01, link.inertia, link.inertia]
    arm = Arm.from_rigid_bodies(l=(0.2, 0.3, 0.3), m=(2, link.mass, link.mass), com=com, inertia=inertia)
    assert arm.lc[1] == pytest.approx(0.4 * 0.15 / 1.0)
    assert arm.Ixx[1] == pytest.approx(0.4 * (0.02**2 + 0.018**2) / 2 + 0.6 * 0.03**2 / 2)


def test_refusals_say_what_to_do():
    hidden = rot_x(0.7) @ np.diag([1.0, 1.0, 2.1]) @ rot_x(0.7).T  # by a rotation of the axes
    refused("triangle inequality", Body, 1.0, inertia=hidden, error=ArmError)
    refused("cannot be negative", Body, 1.0, inertia=np.diag([-0.1, 1.0, 1.0]), error=ArmError)
    refused("mass = -1", Body, -1.0, error=ArmError)
    refused("not symmetric", Body, 1.0, inertia=[[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], error=ArmError)
    refused("give \\(3,\\)", Body, 1.0, com=(0, 0))
    refused("sizes L, R", cylinder().body, 1.0, R=0.1)
    refused("must be a positive number", box().body, 1.0, a=0.1, b=-0.1, c=0.1)
    refused("not below the outer radius", tube().body, 1.0, R=0.1, r=0.2, L=1.0)
