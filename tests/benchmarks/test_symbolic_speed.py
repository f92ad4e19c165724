"""Speed of the derivation beside SymPy's expression trees in one run: `pytest tests/benchmarks --benchmark-enable -s`.

The notebook derives the equations of motion while the student waits: below 0.2 s it feels live. SymPy alone needs
seconds, nearly all of them to simplify.
"""

import time

import numpy as np
import sympy

from ir50p_lab.modelling import IR50P
from ir50p_lab.modelling.symbolic import derive


def by_expression_trees(simplify):
    """M and g of the in-line arm by differentiation and sums of SymPy's expressions, simplified by the given function."""
    x, g = sympy.symbols("x1:4"), sympy.Symbol("g")
    l1, l2, c2, c3, m2, m3 = sympy.symbols("l1 l2 lc2 lc3 m2 m3")
    I1, I2z, I3z = sympy.symbols("Izz1 Izz2 Izz3")
    tilts = {2: x[1], 3: x[1] + x[2]}

    def direction(angle):
        return sympy.Matrix([sympy.cos(angle) * sympy.cos(x[0]), sympy.cos(angle) * sympy.sin(x[0]), sympy.sin(angle)])

    shoulder = sympy.Matrix([0, 0, l1])
    centres = {
        2: shoulder + c2 * direction(tilts[2]),
        3: shoulder + l2 * direction(tilts[2]) + c3 * direction(tilts[3]),
    }
    M = sympy.diag(I1, 0, 0) + sympy.diag(*sympy.symbols("j1:4"))
    for i, m, tensor in (2, m2, tensor_about_z(2, I2z)), (3, m3, tensor_about_z(3, I3z)):
        J = centres[i].jacobian(x)
        tilt = tilts[i]
        # angular velocity in the link's own axes: x along the link, z the joint's
        W = sympy.Matrix([[sympy.sin(tilt), 0, 0], [sympy.cos(tilt), 0, 0], [0, 1, 1 if i == 3 else 0]])
        M += m * J.T * J + W.T * tensor * W
    U = g * (m2 * centres[2][2] + m3 * centres[3][2])
    return M.applyfunc(simplify), sympy.Matrix([U.diff(xk) for xk in x]).applyfunc(simplify), x


def tensor_about_z(i, Izz):
    Ixx, Iyy = sympy.symbols(f"Ixx{i} Iyy{i}")
    return sympy.diag(Ixx, Iyy, Izz)


def seconds(call):
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def test_both_derive_the_same():
    M, g, x = by_expression_trees(lambda e: e)
    model = derive()
    numeric = model.numeric(IR50P)
    numbers = dict(zip((str(s) for s in model.symbols.values()), model.values(IR50P), strict=True))
    for q in np.random.default_rng(0).uniform(-3, 3, (5, 3)):
        at_q = {s: numbers[str(s)] for s in (M.free_symbols | g.free_symbols) - set(x)} | dict(zip(x, q, strict=True))
        np.testing.assert_allclose(np.array(M.subs(at_q), float), numeric.M(q), rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(np.array(g.subs(at_q), float).ravel(), numeric.g(q), rtol=1e-9, atol=1e-12)


def test_ratio_to_simplified_trees(request):
    measured = request.config.getoption("benchmark_enable")
    peer = seconds(lambda: by_expression_trees(sympy.simplify if measured else sympy.expand))
    ours = min(seconds(derive) for _ in range(5 if measured else 1))
    print(f"\nM and g by SymPy's simplify {peer:.1f} s; M, C and g by derive() {ours * 1e3:.0f} ms: {peer / ours:.0f}x")
    if measured:  # the plain test run, with a peer that simplifies less, only sees that it works
        assert ours < peer
        assert ours < 0.2  # s
