"""The printed equations of 1.5 are held as printed: each mistake is where the module says, and nowhere else."""

import numpy as np
import pytest
import sympy

from ir50p_lab.course import printed_dynamics as printed
from ir50p_lab.course.inertia_view import InertiaView, equal_energy
from ir50p_lab.course.thesis_reference import C_NUMBERS, COLUMNS, STATES, reference, same_quantities
from ir50p_lab.modelling import IR50P, THESIS_C, Friction, derive, friction_torque, mass_matrix, same_function

wrong = printed.wrong_entries


@pytest.fixture(scope="module")
def thesis():
    return derive(links="thesis")


@pytest.fixture(scope="module")
def M(thesis):
    return thesis.M.subs({thesis.symbols[f"j{i}"]: 0 for i in "123"})


def test_symbols_are_those_of_the_derivation(thesis):
    assert printed.q == tuple(thesis.q) and printed.qd == tuple(thesis.qd)
    assert printed.M_LIST.free_symbols <= set(thesis.symbols.values()) | set(thesis.q)


@pytest.mark.parametrize(
    ("matrix", "link", "places"),
    [
        (printed.SUMMAND_1_FIRST, 1, [(1, 1)]),
        (printed.SUMMAND_1, 1, []),
        (printed.SUMMAND_2_FIRST, 2, []),
        (printed.SUMMAND_2, 2, [(1, 1), (2, 1)]),
        (printed.SUMMAND_3, 3, [(1, 2), (1, 3), (2, 1), (2, 2), (2, 3), (3, 1), (3, 2)]),
    ],
)
def test_summands(M, matrix, link, places):
    assert wrong(matrix, printed.of_link(link, M)) == places


def test_the_shares_of_the_links_add_up_to_m(M):
    assert same_function(sum((printed.of_link(n, M) for n in (1, 2, 3)), sympy.zeros(3)), M)


def test_lists(thesis, M):
    assert wrong(printed.M_LIST, M) == [(1, 1)]
    right = printed.M_LIST.copy()
    right[0, 0] += printed.m2 * printed.lc2**2 * (printed.c2**2 - printed.c2)  # the one correction: c2 -> c2^2
    assert same_function(right, M)
    swapped = printed.DM["112"].xreplace({printed.m2: printed.m3})  # m3 for m2, but not in the term of link 2
    term = -2 * printed.lc2**2 * printed.c2 * printed.s2
    assert same_function(swapped + (printed.m2 - printed.m3) * term, M[0, 0].diff(printed.q2))
    assert same_function(-printed.DM["223"].xreplace({printed.m2: printed.m3}), M[1, 1].diff(printed.q3))
    assert same_function(printed.DM["233"], thesis.b(2, 3, 3))
    assert same_function(printed.B["322"].xreplace({printed.m2: printed.m3}), thesis.b(3, 2, 2))


def test_centres_of_mass_and_jacobians(thesis):
    for n, p in enumerate((printed.P_C1, printed.P_C2, printed.P_C3)):
        assert wrong(p, thesis.com[n]) == []
    assert wrong(printed.P_C1, derive().com[0]) == [(1, 1), (2, 1), (3, 1)]
    assert wrong(printed.JV_1, thesis.Jv[0]) == wrong(printed.JV_2, thesis.Jv[1]) == []
    assert wrong(printed.JV_3, thesis.Jv[2]) == [(2, 3)]
    assert wrong(printed.JV_3_IN_PRODUCT, thesis.Jv[2]) == [(3, 2)]


def test_right_equations_are_right(thesis):
    assert same_function(
        printed.rate(thesis.M[:1, :1])[0],
        sum(thesis.M[0, 0].diff(x) * v for x, v in zip(thesis.q, thesis.qd, strict=True)),
    )
    assert same_function(printed.christoffel_1_96(thesis.M, 2, 1, 1), thesis.b(2, 1, 1))
    v = np.array([-0.3, 0.01, 2.0])
    model = friction_torque(Friction(fv=(0.4,) * 3, fc=(0.2,) * 3, fs=(0.5,) * 3, qs=(0.1,) * 3), v)
    assert np.allclose([float(printed.friction_1_115(x, 0.4, 0.2, 0.5, 0.1)) for x in v], model)


def test_printed_input_has_no_motor_in_it():
    assert printed.input_1_120(2.0, 3.0, 1e-3, 50, Tf=0.1) == pytest.approx(1e-3 * 50 * 3 + 2 + 0.1)


def test_reference_numbers_of_model_c():
    (q, qd), row = STATES[1], reference("C")[1]
    numeric = derive(links="thesis").numeric(C_NUMBERS)
    found = same_quantities(mass_matrix(THESIS_C, q), numeric.C(q, qd) @ qd, numeric.g(q))
    assert len(COLUMNS) == 10 and np.allclose(found, row, atol=1e-12)
    with pytest.raises(KeyError):
        reference("D")


def test_equal_energy_is_equal():
    M = mass_matrix(IR50P, (0, 0.3, -1.2))[1:, 1:]
    v = equal_energy(M, kinetic=0.7, points=9)
    assert np.allclose(0.5 * np.einsum("ni,ij,nj->n", v, M, v), 0.7)


def test_inertia_view_shows_the_pose():
    view = InertiaView(IR50P)
    q = np.array([0.4, 0.5, -1.0])
    view.update(q)
    M = mass_matrix(IR50P, q)
    side, waist, joints = view.figure.axes
    dot, loop = waist.lines[1], joints.lines[0]
    assert np.allclose(dot.get_xydata(), [[np.degrees(0.5), M[0, 0]]])
    assert np.allclose(np.interp(dot.get_xdata(), *waist.lines[0].get_data()), M[0, 0], rtol=1e-3)
    assert np.allclose(0.5 * np.einsum("ni,ij,nj->n", loop.get_xydata(), M[1:, 1:], loop.get_xydata()), 1.0)
    assert f"{M[1, 1]:.3f}" in side.get_title()
    for ax in view.figure.axes:  # nothing runs out of its axes
        assert ax.get_xlabel() and ax.get_ylabel()
    assert np.abs(loop.get_xydata()).max() < joints.get_xlim()[1] and M[0, 0] < waist.get_ylim()[1]


def test_general_formulas_differ_from_the_derivation(thesis):
    qdd = thesis.qdd
    inertial = thesis.M * qdd + thesis.h
    assert wrong(printed.inertial_torque_1_81(thesis.M, qdd), inertial) == [(2, 1), (3, 1)]
    assert wrong(printed.h_1_95(thesis.M), thesis.h) == [(1, 1), (2, 1), (3, 1)]
    assert wrong(printed.h_1_98_and_1_99(thesis.b), thesis.h) == [(1, 1), (2, 1), (3, 1)]


def test_centrifugal_half_of_1_98_is_right(thesis):
    """With one joint moving at a time only squares are left, and there (1.98) and (1.99) agree with h."""
    for moving in thesis.qd:
        rest = {v: 0 for v in thesis.qd if v != moving}
        assert wrong(printed.h_1_98_and_1_99(thesis.b).xreplace(rest), thesis.h.xreplace(rest)) == []


def test_angular_jacobian_and_energy_as_printed():
    model = derive()
    axes = [T[:3, 2] for T in model.frames[:3]]
    places = [wrong(printed.J_omega_1_88(axes), Jw) for Jw in model.Jw]
    assert places == [[(1, 2), (1, 3), (2, 2), (2, 3)], [(1, 3), (2, 3)], []]
    tensor = sympy.diag(0, 0, printed.Izz1)
    column = printed.kinetic_1_89([sympy.zeros(3)], [model.Jw[0]], [0], [tensor])
    assert sympy.expand(column.subs({printed.b: 0, printed.c: 0}) - printed.Izz1 * printed.a**4 / 2) == 0  # not a^2
    moving = printed.kinetic_1_89([sympy.eye(3)], [sympy.zeros(3)], [printed.m1], [tensor])
    assert sympy.expand(moving - printed.m1 * sum(v**2 for v in printed.qd) / 2) == 0  # that half is right
