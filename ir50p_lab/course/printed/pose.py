"""What the thesis prints in 1.1 and 1.2, equation by equation, as SymPy matrices: mistakes included.

Only for A1 and its tests. For calculations use `ir50p_lab.modelling`.
The remark after 'wrong:' says what is wrong; an equation without one is right as printed.
"""

from math import prod

from sympy import Matrix, cos, eye, pi, sin, symbols

q1, q2, q3, l1, l2, l3 = symbols("q1 q2 q3 l1 l2 l3", real=True)
q = (q1, q2, q3)


def R_y(theta):
    """(1.5). Wrong: this is the rotation by -theta, the signs of the two sines are swapped."""
    # fmt: off
    return Matrix([[cos(theta), 0, -sin(theta)],
                   [0,          1, 0          ],
                   [sin(theta), 0, cos(theta) ]])
    # fmt: on


def T_1_11(A, i, j):
    """(1.11), T^i_j for i < j from the list A = [A_1, ..., A_n]. Wrong: stops at A_{j-1}, one matrix early."""
    return prod(A[i : j - 1], start=eye(4))


def dh(theta, d, a, alpha):
    """(1.29), one Denavit-Hartenberg step written out."""
    ct, st, ca, sa = cos(theta), sin(theta), cos(alpha), sin(alpha)
    # fmt: off
    return Matrix([[ct, -st * ca, st * sa,  a * ct],
                   [st, ct * ca,  -ct * sa, a * st],
                   [0,  sa,       ca,       d     ],
                   [0,  0,        0,        1     ]])
    # fmt: on


def Z(theta, d):
    """(1.21) = (1.23), the joint's part of a step."""
    return dh(theta, d, 0, 0)


def Z_text(theta, d):
    """The sentence below (1.21) and the list of symbols. Wrong: turn theta about x instead of z."""
    return dh(0, d, 0, theta)


def X(a, alpha):
    """(1.22) = (1.24), the link's part of a step."""
    return dh(0, 0, a, alpha)


def X_restated(a, alpha):
    """[X_i] as it is repeated in 1.2.3. Wrong: turns by the length a instead of the angle alpha."""
    return dh(0, 0, a, a)


# Table 1.1. The rows are right. Wrong: the header theta_{i-1}, d_{i-1}, phi_i, alpha_i for theta_i, d_i, a_i, alpha_i.
TABLE_1_1 = ((q1, l1, 0, pi / 2), (q2, 0, l2, 0), (q3, 0, l3, -pi / 2))


def table_read_literally():
    """The four parameters per joint if the header of Table 1.1 is taken at its word.

    Row i then gives theta and d of joint i-1: those of joint 1 stand in row 2, those of joint 3 are nowhere and must
    be invented (0 here), and row 1 describes a joint 0 that does not exist.
    """
    below = (*TABLE_1_1[1:], (0, 0))
    return tuple((*theta_and_d[:2], *row[2:]) for theta_and_d, row in zip(below, TABLE_1_1, strict=True))


def T_1_20(table=TABLE_1_1):
    """(1.20). Wrong: ends with [Z_n], so that the last link, a_n and alpha_n, is missing."""
    first, second, (theta, d, _, _) = table
    return dh(*first) * dh(*second) * Z(theta, d)


def T_swapped():
    """The product below Table 1.1. Wrong: its last pair is [X_3][Z_3] instead of [Z_3][X_3]."""
    first, second, (theta, d, a, alpha) = TABLE_1_1
    return dh(*first) * dh(*second) * X(a, alpha) * Z(theta, d)


def T_1_30(alpha_2=pi / 2):
    """(1.30). Wrong: the last turn is by -pi/2 (as in Table 1.1), and its 'alpha_2' is alpha_1 = pi/2.

    alpha_2: rad, pi/2 as meant, or 0 as Table 1.1 has it.
    """
    return dh(q1, l1, 0, alpha_2) * dh(q2, 0, l2, 0) * dh(q3, 0, l3, pi / 2)


def T_1_31():
    """(1.31), whose blocks R^0_3, t^0_3 and (1.45) repeat. Wrong: c1 for s1 twice in row 2."""
    c1, s1, c2, s2, c23, s23 = cos(q1), sin(q1), cos(q2), sin(q2), cos(q2 + q3), sin(q2 + q3)
    # fmt: off
    return Matrix([[c23 * c1, -s1, -s23 * c1, c1 * (l3 * c23 + l2 * c2)  ],
                   [c23 * s1, c1,  -s23 * c1, c1 * (l3 * c23 + l2 * c2)  ],
                   [s23,      0,   c23,       l1 + l3 * s23 + l2 * s2    ],
                   [0,        0,   0,         1                          ]])
    # fmt: on
