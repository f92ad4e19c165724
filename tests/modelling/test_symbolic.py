"""The symbolic derivation against routes that share nothing with it: MuJoCo, numbers of the errata."""

from types import SimpleNamespace

import numpy as np
import pytest
import sympy
from arms import random_arm, random_states
from refusals import refused
from thesis_numbers import C_NUMBERS, STATES, reference, same_quantities

from ir50p_lab.modelling import (
    IR50P,
    THESIS_A,
    THESIS_RODS,
    coriolis_matrix,
    energy,
    forward_kinematics,
    gravity,
    inverse_dynamics,
    jacobian,
    mass_matrix,
)
from ir50p_lab.modelling.symbolic import derive, same_function
from ir50p_lab.modelling.symbolic_display import short_names

KINDS = ("in-line", "general", "thesis")


@pytest.fixture(scope="module", params=KINDS)
def model(request):
    return derive(links=request.param)


@pytest.fixture(scope="module")
def inline():
    return derive()


def numeric(model, arm):
    """M(q), C(q, qd) and g(q) of the formulas, as functions of numbers: an independent route, not a fast one."""
    values, parameters = model.values(arm), list(model.symbols.values())

    def function(formula, *state):
        compiled = sympy.lambdify([*map(list, state), parameters], formula, "numpy", cse=True)
        return lambda *numbers: np.squeeze(np.array(compiled(*numbers, values), dtype=float))

    q, qd = model.q, model.qd
    return SimpleNamespace(M=function(model.M, q), C=function(model.C, q, qd), g=function(model.g, q))


# ---- properties every mechanical system has -------------------------------------------------------------------------


def test_mass_matrix_is_symmetric_and_free_of_q1(model):
    assert model.M == model.M.T
    assert model.q[0] not in model.M.free_symbols | model.g.free_symbols | model.C.free_symbols
    assert model.q[1] not in model.M[1:, 1:].free_symbols  # shoulder and elbow are parallel


def test_m_dot_minus_2c_is_skew_exactly(model):
    Mdot = sum((model.M.diff(q) * qd for q, qd in zip(model.q, model.qd, strict=True)), sympy.zeros(3))
    N = Mdot - 2 * model.C
    assert same_function(N + N.T, sympy.zeros(3))
    assert not same_function(N, sympy.zeros(3))


def test_c_qd_is_the_sorted_sum_of_christoffel_symbols(model):
    assert same_function(model.C * model.qd, model.h)
    assert model.b(1, 1, 2) == model.b(1, 2, 1)
    assert same_function(2 * model.b(1, 1, 2), model.M[0, 0].diff(model.q[1]))


def test_forms_of_the_errata(inline):
    """M11, alpha, beta, k and g as ERRATA 1.4 gives them for rigid in-line links."""
    s = inline.symbols
    q2, q3 = inline.q[1:]
    c2, s2, c23, s23 = sympy.cos(q2), sympy.sin(q2), sympy.cos(q2 + q3), sympy.sin(q2 + q3)
    k = s["m3"] * s["lc3"] * s["l2"] * sympy.sin(q3)
    reach3 = s["l2"] * c2 + s["lc3"] * c23
    M11 = s["j1"] + s["Izz1"] + s["m2"] * s["lc2"] ** 2 * c2**2 + s["m3"] * reach3**2
    M11 += s["Ixx2"] * s2**2 + s["Iyy2"] * c2**2 + s["Ixx3"] * s23**2 + s["Iyy3"] * c23**2
    assert same_function(inline.M[0, 0], M11)
    assert same_function(inline.b(2, 3, 3), -k)
    assert same_function(inline.b(3, 2, 2), k)
    g2 = s["g"] * (s["m2"] * s["lc2"] * c2 + s["m3"] * reach3)
    assert same_function(inline.g, sympy.Matrix([0, g2, s["g"] * s["m3"] * s["lc3"] * c23]))


# ---- numbers ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["A", "B", "C"])
def test_reference_values_of_the_thesis_models(name):
    if name == "C":
        numbers = numeric(derive(links="thesis"), C_NUMBERS)
    else:
        numbers = numeric(derive(), THESIS_A if name == "A" else THESIS_RODS)
    for (q, qd), row in zip(STATES, reference(name), strict=True):
        M, h, g = numbers.M(q), numbers.C(q, qd) @ qd, numbers.g(q)
        assert np.allclose(same_quantities(M, h, g), row, rtol=0, atol=6e-13)
        assert (M[0, 2], g[0]) == (0, 0)


@pytest.mark.parametrize("arm", [IR50P, THESIS_A, random_arm(np.random.default_rng(0))], ids=lambda a: a.name)
@pytest.mark.parametrize("links", ["in-line", "general"])
def test_equal_to_the_closed_form(arm, links):
    model = derive(links=links)
    formulas = numeric(model, arm)
    kinematics = sympy.lambdify(
        [*map(list, (model.q, model.qd, model.symbols.values()))],
        [model.frames[3][:3, 3].T, model.J, model.kinetic + model.potential],
    )
    bare = arm.without_friction()
    offsets = []
    for q, qd, qdd in zip(*random_states(np.random.default_rng(5), 60), strict=True):
        close = {"rtol": 1e-12, "atol": 1e-12}
        assert np.allclose(formulas.M(q), mass_matrix(arm, q), **close)
        assert np.allclose(formulas.C(q, qd), coriolis_matrix(arm, q, qd), **close)
        assert np.allclose(formulas.g(q), gravity(arm, q), **close)
        tau = formulas.M(q) @ qdd + formulas.C(q, qd) @ qd + formulas.g(q)
        assert np.allclose(tau, inverse_dynamics(bare, q, qd, qdd), **close)
        p, J, total = kinematics(q, qd, model.values(arm))
        assert np.allclose(p, forward_kinematics(arm, q), **close)
        assert np.allclose(J, jacobian(arm, q), **close)
        offsets.append(total - energy(arm, q, qd).total)
    assert np.ptp(offsets) < 1e-11  # the zero of height is free


def test_general_arm_equals_mujoco():
    """Centres of mass off the links and full inertia tensors: what no theta expresses."""
    mujoco = pytest.importorskip("mujoco")
    rng = np.random.default_rng(7)
    l, m, j, com = (
        rng.uniform(0.2, 0.5, 3),
        rng.uniform(0.5, 3, 3),
        rng.uniform(0.01, 0.1, 3),
        rng.normal(0, 0.1, (3, 3)),
    )
    tensors = []
    for _ in range(3):
        points = rng.normal(0, 0.1, (5, 3))  # the tensor of five point masses is a possible one
        tensors.append(sum((p @ p) * np.eye(3) - np.outer(p, p) for p in points))
    numbers = {"g": 9.81}
    for i in range(3):
        I = tensors[i]
        numbers |= {f"l{i + 1}": l[i], f"m{i + 1}": m[i], f"j{i + 1}": j[i]}
        numbers |= {f"{axis}{i + 1}": com[i][k] for k, axis in enumerate("xyz")}
        numbers |= {f"I{a}{i + 1}": I[k, k] for k, a in enumerate(("xx", "yy", "zz"))}
        numbers |= {f"I{a}{i + 1}": -I[r, c] for a, r, c in (("xy", 0, 1), ("xz", 0, 2), ("yz", 1, 2))}

    def inertial(i):
        I = tensors[i]
        full = " ".join(repr(float(x)) for x in (I[0, 0], I[1, 1], I[2, 2], I[0, 1], I[0, 2], I[1, 2]))
        pos = " ".join(repr(float(x)) for x in com[i])
        return f'<inertial pos="{pos}" mass="{float(m[i])!r}" fullinertia="{full}"/>'

    def joint(i):
        return f'<joint name="q{i + 1}" type="hinge" axis="0 0 1" armature="{float(j[i])!r}"/>'

    xml = f"""<mujoco><compiler angle="radian"/><option gravity="0 0 -9.81"/><worldbody>
      <body>{joint(0)}{inertial(0)}
        <body pos="0 0 {float(l[0])!r}" quat="0.7071067811865476 0.7071067811865476 0 0">{joint(1)}{inertial(1)}
          <body pos="{float(l[1])!r} 0 0">{joint(2)}{inertial(2)}</body></body></body></worldbody></mujoco>"""
    engine = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(engine)
    formulas = numeric(derive(general=True), numbers)
    for q, qd, qdd in zip(*random_states(np.random.default_rng(8), 50), strict=True):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, qd, qdd
        mujoco.mj_inverse(engine, data)
        tau = formulas.M(q) @ qdd + formulas.C(q, qd) @ qd + formulas.g(q)
        assert np.allclose(tau, data.qfrc_inverse, rtol=1e-9, atol=1e-9)


# ---- reading, refusals -----------------------------------------------------------------------------------------------


def test_formulas_to_read(inline):
    read = inline.read("M")
    assert [name for name, _ in read.rows] == ["M_{11}", "M_{22}", "M_{23}", "M_{33}"]
    assert r"M_{33} &= I_{zz3} + j_{3} + m_{3} l_{c3}^{2}" in read._repr_latex_()
    assert "M_33 = Izz3 + j3 + lc3**2*m3" in str(read)
    h = inline.read("h")
    assert r"h_{2} &= - 2 m_{3} l_{2} l_{c3} s_{3} \dot{q}_{2} \dot{q}_{3}" in h._repr_latex_()
    assert r"\quad - m_{3} l_{2} l_{c3} s_{3} \dot{q}_{3}^{2}" in h._repr_latex_()  # too long for one line
    assert [name for name, _ in inline.read("tau").rows] == [r"\tau_{1}", r"\tau_{2}", r"\tau_{3}"]
    assert r"\ddot{q}_{1}" in inline.read("tau")._repr_latex_()
    back = {v: k for k, v in short_names(inline.q).items()}
    assert [e.xreplace(back) for _, e in inline.read("g").rows] == list(inline.g[1:])


def test_same_function_tells_apart():
    x, y = sympy.symbols("x y")
    assert same_function(sympy.cos(x + y) + sympy.sin(x) * sympy.sin(y), sympy.cos(x) * sympy.cos(y))
    assert same_function(sympy.sin(2 * x), 2 * sympy.sin(x) * sympy.cos(x))
    assert not same_function(sympy.sin(x) ** 2, sympy.sin(x))
    assert not same_function(sympy.eye(2), sympy.eye(3))


def test_refusals_say_what_to_do(inline):
    refused("choose 'in-line' or 'general' or 'thesis'", derive, links="bent")
    refused("'lc4' is not a parameter", inline.values, {"lc4": 1})
    refused(r"no number for .*m3", inline.values, {"g": 9.81, "l1": 1})
    refused("m1 = nan", inline.values, {"m1": float("nan")})
    refused("give a mapping", derive(links="thesis").values, IR50P)
    refused("choose 'M'", inline.read, "K")
    refused("1 to 3", inline.b, 0, 1, 1)
