"""The printed equations of 1.5 are held as printed: each mistake is where the module says, and nowhere else."""

import pytest
import sympy

from ir50p_lab.course.printed import dynamics as printed
from ir50p_lab.modelling import derive, same_function, second_moment_tensor

wrong = printed.wrong_entries


@pytest.fixture(scope="module")
def thesis():
    return derive(links="thesis")


@pytest.fixture(scope="module")
def M(thesis):
    return thesis.M.subs({thesis.symbols[f"j{i}"]: 0 for i in "123"})


@pytest.mark.parametrize(
    ("matrix", "link", "places"),
    [
        (printed.SUMMAND_1_FIRST, 1, [(1, 1)]),
        (printed.SUMMAND_2, 2, [(1, 1), (2, 1)]),
        (printed.SUMMAND_3, 3, [(1, 2), (1, 3), (2, 1), (2, 2), (2, 3), (3, 1), (3, 2)]),
    ],
)
def test_summands(M, matrix, link, places):
    assert wrong(matrix, printed.of_link(link, M)) == places


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


def test_inertia_tensor():
    right = second_moment_tensor((printed.x, printed.y, printed.z))
    assert wrong(printed.INTEGRAND_1_102, right) == [(1, 1), (2, 2), (3, 3)]
    assert wrong(printed.INTEGRAND_1_103, right) == [(1, 3), (3, 1), (3, 2)]
    assert wrong(printed.TENSOR_1_104, printed.TENSOR) == [(1, 3), (3, 1)]
    assert [right[k, k] == m for k, m in enumerate(printed.MOMENTS_1_105_TO_1_107)] == [True, False, True]


def test_centres_of_mass_and_jacobians(thesis):
    model = derive()
    assert wrong(printed.P_C1, model.com[0]) == [(1, 1), (2, 1), (3, 1)]
    assert wrong(printed.P_C1, thesis.com[0]) == []  # the model of the thesis has it as printed
    assert wrong(printed.J_OMEGA_2, model.Jw[1]) == [(1, 2), (2, 2)]
    assert wrong(printed.J_OMEGA_3, model.Jw[2]) == [(1, 2), (1, 3), (2, 2), (2, 3)]
    assert wrong(printed.JV_3, thesis.Jv[2]) == [(2, 3)]
    assert wrong(printed.JV_3_IN_PRODUCT, thesis.Jv[2]) == [(3, 2)]
    assert wrong(printed.JV_2_IN_G, thesis.Jv[1]) == [(1, 2), (2, 2)]
    assert wrong(printed.I_N3, printed.TENSOR_3) == [(1, 1), (3, 3)]


def test_gravity(thesis):
    assert wrong(printed.G, thesis.g) == [(2, 1)]


def test_doubled_symbols_end_in_the_right_values(thesis, M):
    for name, source in printed.TWICE_B.items():
        i, j, k = (int(digit) - 1 for digit in source or "111")
        right = M[i, j].diff(thesis.q[k]) if source else 0
        assert same_function(2 * thesis.b(*map(int, name)), right)


def test_general_formulas_differ_from_the_derivation(thesis):
    qdd = thesis.qdd
    inertial = thesis.M * qdd + thesis.h
    assert wrong(printed.inertial_torque_1_81(thesis.M, qdd), inertial) == [(2, 1), (3, 1)]
    assert wrong(printed.h_1_95(thesis.M), thesis.h) == [(1, 1), (2, 1), (3, 1)]
    assert wrong(printed.h_1_98_and_1_99(thesis.b), thesis.h) == [(1, 1), (2, 1), (3, 1)]


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
