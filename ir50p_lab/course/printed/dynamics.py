"""What the thesis prints in 1.5, equation by equation, as SymPy objects: mistakes included.

Only for A1 and its tests. For calculations use `ir50p_lab.modelling`.
The remark after 'wrong:' says what is wrong; an equation without one is right as printed. Symbols are those of
`derive(links="thesis")`, so that printed and derived formulas can be compared at once.
"""

from sympy import Matrix, Rational, cos, diag, eye, sin, symbols, zeros

from ir50p_lab.modelling.symbolic import same_function

q = q1, q2, q3 = symbols("q1:4", real=True)
qd = a, b, c = symbols("qdot1:4", real=True)
g, l1, l2, l3, m1, m2, m3, lc1, lc2, lc3 = symbols("g l1 l2 l3 m1 m2 m3 lc1 lc2 lc3", real=True)
Izz1, Iyy2, Izz2, Iyz2, Iyy3, Izz3, Iyz3 = symbols("Izz1 Iyy2 Izz2 Iyz2 Iyy3 Izz3 Iyz3", real=True)
Ixx3, Ixy2, Ixy3, Ixz2, Ixz3 = symbols("Ixx3 Ixy2 Ixy3 Ixz2 Ixz3", real=True)
x, y, z = symbols("x y z", real=True)
Ixx, Iyy, Izz, Ixy, Ixz, Iyz = symbols("Ixx Iyy Izz Ixy Ixz Iyz", real=True)

c1, s1, c2, s2, c3, s3 = cos(q1), sin(q1), cos(q2), sin(q2), cos(q3), sin(q3)
c23, s23 = cos(q2 + q3), sin(q2 + q3)


def wrong_entries(printed, right):
    """Places (row, column), counted from 1, where two matrices of one shape are not the same function."""
    rows, columns = right.shape
    places = [(i, j) for i in range(rows) for j in range(columns)]
    return [(i + 1, j + 1) for i, j in places if not same_function(printed[i, j], right[i, j])]


def of_link(n, M):
    """The share of link n (1, 2, 3) in a mass matrix: masses, inertias of the others and all rotors set to 0."""
    others = [p for p in M.free_symbols if p.name[0] == "j" or (p.name[0] in "mI" and p.name[-1] != str(n))]
    return M.subs(dict.fromkeys(others, 0))


# ---- 1.5.1.1 inertial torque ----


def inertial_torque_1_81(M, qdd):
    """(1.81), M qdd + Mdot qd - 1/2 [...]. Wrong: dM/dqd_i (zero) for dM/dq_i, and no qd behind it."""
    Mdot = rate(M)
    last = Matrix([(Matrix([qd]) * M.diff(v) * Matrix(qd))[0] for v in qd])  # with the qd that is missing
    return M * Matrix(qdd) + Mdot * Matrix(qd) - Rational(1, 2) * last


def rate(M):
    """(1.94), dM/dt by the chain rule. Right."""
    return sum((M.diff(qk) * qdk for qk, qdk in zip(q, qd, strict=True)), zeros(*M.shape))


def J_omega_1_88(axes):
    """(1.88), the same [z_1 ... z_n] for every link. Wrong: link i is not turned by the joints after it."""
    return Matrix.hstack(*axes)


def kinetic_1_89(Jv, Jw, masses, tensors):
    """(1.89), with omega_i in place of J_omega_i inside. Wrong: the velocity then stands four times in the product.

    The printed sum adds a number to a matrix; the number is taken times the unit matrix here.
    """
    v = Matrix(qd)
    inside = zeros(3, 3)
    for m, jv, jw, tensor in zip(masses, Jv, Jw, tensors, strict=True):
        omega = jw * v
        inside += m * jv.T * jv + (omega.T * tensor * omega)[0] * eye(3)
    return (v.T * inside * v)[0] / 2


def christoffel_1_96(M, i, j, k):
    """(1.96), b_ijk = (M_ijk + M_ikj - M_jki) / 2 with M_ijk = dM_ij/dq_k. Right, though it looks unusual."""

    def d(i, j, k):
        return M[i - 1, j - 1].diff(q[k - 1])

    return (d(i, j, k) + d(i, k, j) - d(j, k, i)) / 2


def h_1_98_and_1_99(b_ijk):
    """(1.98) plus (1.99). Wrong: the Coriolis columns are 2 b_i11, 2 b_i22, ... and meet squared velocities.

    b_ijk: function of the three indices. Right: columns 2 b_i12, 2 b_i13, 2 b_i23 times (ab, ac, bc). The last
    column is taken as b_i23, as its index n(n-1)n can be read.
    """
    rows = []
    for i in (1, 2, 3):
        squares = b_ijk(i, 1, 1) * a**2 + b_ijk(i, 2, 2) * b**2 + b_ijk(i, 3, 3) * c**2
        mixed = b_ijk(i, 1, 1) * (a * b) ** 2 + b_ijk(i, 2, 2) * (a * c) ** 2 + b_ijk(i, 2, 3) * (b * c) ** 2
        rows.append(squares + 2 * mixed)
    return Matrix(rows)


def h_1_95(M):
    """(1.95) as far as it can be read. Wrong: M_ijk carries a dot, and its first bracket meets no velocities at all."""
    rows = []
    for i in range(3):
        first = sum(rate(Matrix([[M[i, j].diff(q[k])]]))[0] for j in range(3) for k in range(3)) / 2
        second = sum(M[i, j].diff(q[0]) * v for j, v in enumerate((a * b, a * c, b * c)))
        rows.append(first + second)
    return Matrix(rows)


# ---- inertia tensor ----

_p = Matrix([x, y, z])
P_HAT = Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
INTEGRAND_1_102 = -_p.dot(_p) * eye(3) - _p * _p.T  # wrong: the first minus
# fmt: off
INTEGRAND_1_103 = Matrix([[y**2 + z**2, -x * y,       x * z      ],   # wrong: three entries
                          [-x * y,      z**2 + x**2, -y * z      ],
                          [x**2,        -y**2,       x**2 + y**2 ]])
TENSOR_1_104 = Matrix([[Ixx,  -Ixy, Ixz ],                            # wrong: not symmetric
                       [-Ixy, Iyy,  -Iyz],
                       [-Ixx, -Iyz, Izz ]])
TENSOR = Matrix([[Ixx,  -Ixy, -Ixz],                                  # (1.104) put right
                 [-Ixy, Iyy,  -Iyz],
                 [-Ixz, -Iyz, Izz ]])
# fmt: on
MOMENTS_1_105_TO_1_107 = (y**2 + z**2, x + z**2, y**2 + x**2)  # wrong: x for x^2 in Iyy, (1.106)


# ---- actuator ----


def input_1_120(tau, qdd, j, G, Tf=0):
    """(1.118)-(1.120). Wrong: volts equal newton metres, inertia j G for N^2 Jm, no back-EMF."""
    return j * G * qdd + tau + Tf


# ---- 1.5.3 the arm: centres of mass, Jacobians, tensors ----

reach3 = lc3 * c23 + l2 * c2
P_C1 = Matrix([lc1 * c1, lc1 * s1, 0])  # wrong: the column is vertical, (0, 0, lc1)
# fmt: off
JV_3 = Matrix([[-s1 * reach3, -c1 * (lc3 * s23 + l2 * s2), -c1 * lc3 * s23],
               [c1 * reach3,  -s1 * (lc3 * s23 + l2 * s2), -s1 * lc3 * c23],   # wrong: c23 for s23 (the scan?)
               [0,            reach3,                      lc3 * c23      ]])
JV_3_IN_PRODUCT = Matrix([[-s1 * reach3, -c1 * (lc3 * s23 + l2 * s2), -c1 * lc3 * s23],
                          [c1 * reach3,  -s1 * (lc3 * s23 + l2 * s2), -s1 * lc3 * s23],
                          [0,            lc3 * s23 + l2 * s2,         lc3 * c23      ]])  # wrong: sines in row 3
JV_2_IN_G = Matrix([[-s1 * lc2 * c2, -c1 * lc2 * c2, 0],   # wrong: c2 for s2, harmless for g (only row 3 counts)
                    [c1 * lc2 * c2,  -s1 * lc2 * c2, 0],
                    [0,              lc2 * c2,       0]])
J_OMEGA_2 = Matrix([[0, 0, 0], [0, -1, 0], [1, 0, 0]])     # wrong: these are not base-frame axes ...
J_OMEGA_3 = Matrix([[0, 0, 0], [0, -1, -1], [1, 0, 0]])    # ... but those of the frame that turns with joint 1
TENSOR_3 = Matrix([[Ixx3, -Ixy3, -Ixz3], [-Ixy3, Iyy3, -Iyz3], [-Ixz3, -Iyz3, Izz3]])  # as I_n1 and I_n2 are printed
I_N3 = Matrix([[Izz3,  -Ixy3, -Ixz3],                      # wrong: the diagonal is Ixx3, Iyy3, Izz3
               [-Ixy3, Iyy3,  -Iyz3],
               [-Ixz3, -Iyz3, Iyy3 ]])

# ---- a. mass matrix: the three summands and the list ----

SUMMAND_1_FIRST = diag(m1 * lc1 + Izz1, 0, 0)              # wrong: lc1 not squared; right in the thesis's next line
SUMMAND_2 = Matrix([[m2 * lc2**2 * c2 + Izz2, Iyz2,               0],   # wrong: c2 not squared, Iyz2 lost in (2,1)
                    [0,                       m2 * lc2**2 + Iyy2, 0],
                    [0,                       0,                  0]])
SUMMAND_3 = Matrix([                                                    # wrong: seven entries
    [Izz3 + m3 * reach3**2, -Iyz3,                                       -Iyz3              ],
    [-Ixy3,                 Iyy3 + m3 * (lc3**2 + l2**2 + 2 * lc3 * l2),  -Iyz3              ],
    [-Ixz3,                 m3 * (lc3**2 + lc3 * l2 * c3) - Iyy3,         Iyy3 + m3 * lc3**2 ]])
# fmt: on
M11 = m1 * lc1**2 + Izz1 + m2 * lc2**2 * c2 + Izz2 + Izz3 + m3 * reach3**2  # wrong: c2 not squared
M12 = Iyz2 + Iyz3
M13 = Iyz3
M22 = m2 * lc2**2 + Iyy2 + Iyy3 + m3 * (lc3**2 + l2**2 + 2 * lc3 * l2 * c3)
M23 = m3 * (lc3**2 + lc3 * l2 * c3) + Iyy3
M33 = Iyy3 + m3 * lc3**2
M_LIST = Matrix([[M11, M12, M13], [M12, M22, M23], [M13, M23, M33]])

# ---- b. derivatives of M and Christoffel symbols, by their indices ----

_bracket = lc2**2 * c2 * s2 + lc3**2 * c23 * s23 + l2**2 * c2 * s2 + lc3 * s23 * l2 * c2 + lc3 * l2 * c23 * s2
DM = {
    "112": -2 * m2 * _bracket,  # wrong: m2 for m3 in all terms with lc3 or l2
    "113": -2 * m2 * (lc3**2 * c23 * s23 + lc3 * l2 * s23 * c2),  # wrong: m2 for m3
    "223": 2 * m2 * lc3 * l2 * s3,  # wrong: sign, and m2 for m3
    "233": -m3 * lc3 * l2 * s3,
    **dict.fromkeys("111 122 212 332 311 131 333 222 322 213 231 132".split(), 0),
}
B = {
    "211": m2 * _bracket,  # wrong: m2 for m3
    "233": 0,  # wrong: -m3 lc3 l2 s3. Energy is not conserved without it
    "311": m2 * (lc3**2 * c23 * s23 + lc3 * l2 * s23 * c2),  # wrong: m2 for m3
    "322": m2 * lc3 * l2 * s3,  # wrong: m2 for m3; the final matrix has m3
    **dict.fromkeys("111 122 133 222 333".split(), 0),
}
# fmt: off
C1 = Matrix([[0, 0, 0],                                    # wrong: (2,1) squares and last sign; (2,3) should be b233
             [m2 * lc2**2 * c2 * s2 + m3 * (lc3**2 * c23**2 * s23**2 + l2**2 * c2 * s2 + lc3 * s23 * l2 * c2)
              - m3 * lc3 * l2 * c23 * s2, 0, 0],
             [m3 * (lc3**2 * c23 * s23 + lc3 * l2 * s23 * c2), m3 * lc3 * l2 * s3, 0]])
# fmt: on

# ---- c. gravity ----

# Wrong: the two terms of row 2 are multiplied, and lc2 stands for l2 in the one of m3. g0 was a vector in (1.112).
G = Matrix([0, lc2 * c2 * m2 * (lc2 * c2 + lc3 * c23) * m3 * g, lc3 * c23 * m3 * g])
