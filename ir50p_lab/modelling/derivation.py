"""The steps of the symbolic derivation, from the frames to M, C and g; and how its formulas are ordered for reading."""

import sympy
from sympy import cos, sin


def turn(angle):
    """Return the rotation about z by `angle`, a sympy matrix (3, 3)."""
    return sympy.Matrix([[cos(angle), -sin(angle), 0], [sin(angle), cos(angle), 0], [0, 0, 1]])


def chain(q, l1, l2, l3):
    """Return the frames T^0_0 ... T^0_3 of the DH chain (1.29), and the rotations of the three link frames.

    The link frame of link i is its DH frame before the twist alpha_i: link 1 turns about z0; links 2 and 3 have
    x along the link and z along the joint axis. Axes 2 and 3 are parallel, so that their angles add.
    """
    twist = sympy.Matrix([[1, 0, 0], [0, 0, -1], [0, 1, 0]])  # +90 deg about x
    upright = turn(q[0]) * twist
    rotations = [turn(q[0]), upright * turn(q[1]), upright * turn(q[1] + q[2])]
    shoulder = sympy.Matrix([0, 0, l1])
    elbow = shoulder + rotations[1][:, 0] * l2
    tip = elbow + rotations[2][:, 0] * l3
    turned = [sympy.eye(3), upright, rotations[1], rotations[2] * twist.T]
    origins = [sympy.zeros(3, 1), shoulder, elbow, tip]
    last = sympy.Matrix([[0, 0, 0, 1]])
    return [R.row_join(p).col_join(last) for R, p in zip(turned, origins, strict=True)], rotations


def bodies(symbols, links, frames, rotations):
    """Return the centres of mass p_ci in the base frame, and each inertia tensor with the rotation of its frame.

    Returns: 3 columns (3, 1); 3 pairs (rotation, tensor).
    """
    s = symbols
    if links == "general":
        in_link = [[s[axis + i] for axis in "xyz"] for i in "123"]
    elif links == "in-line":
        in_link = [[0, 0, s["lc1"]], [s["lc2"], 0, 0], [s["lc3"], 0, 0]]
    else:  # the thesis has the centre of mass of the column beside its axis
        in_link = [[s[f"lc{i}"], 0, 0] for i in "123"]
    joints = [frame[:3, 3] for frame in frames[:3]]
    centres = [p + R * sympy.Matrix(r) for p, R, r in zip(joints, rotations, in_link, strict=True)]
    tensors = []
    for i in "123":
        xx, yy, zz, xy, xz, yz = (s.get(f"I{pair}{i}", 0) for pair in ("xx", "yy", "zz", "xy", "xz", "yz"))
        tensors.append(sympy.Matrix([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]))
    # The thesis's inertias stay constant in the frame that turns with joint 1 only.
    given_in = [rotations[0]] * 3 if links == "thesis" else rotations
    return centres, list(zip(given_in, tensors, strict=True))


def angular_jacobians(frames):
    """Return Jw of each link in the base frame: [z0 0 0], [z0 z1 0], [z0 z1 z2] (1.88 corrected: joint i has z_i-1)."""
    z0, z1, z2 = (frame[:3, 2] for frame in frames[:3])
    none = sympy.zeros(3, 1)
    return [sympy.Matrix.hstack(*axes) for axes in ((z0, none, none), (z0, z1, none), (z0, z1, z2))]


def mass_matrix(q, symbols, Jv, Jw, tensors):
    """Return M = sum of m Jv^T Jv + Jw^T R I R^T Jw, plus the rotors on the diagonal (1.90 corrected).

    M does not change when the whole arm turns about joint 1, and the part of joints 2 and 3 does not change when both
    links turn about joint 2. So each is worked out where that is shortest: M at q1 = 0, that part with a level forearm.
    """
    M = sympy.diag(*(symbols[f"j{i}"] for i in "123"))
    for i, jv, jw, (R, inertia) in zip("123", Jv, Jw, tensors, strict=True):
        v, w = jv.subs(q[0], 0), (R.T * jw).subs(q[0], 0)
        M += symbols[f"m{i}"] * v.T * v + w.T * inertia * w
    level = M[1:, 1:].subs(q[1], -q[2]).expand()
    M[1:, 1:] = level.subs(sin(q[2]) ** 2, 1 - cos(q[2]) ** 2)
    return M


def christoffel(q, M):
    """Return the Christoffel symbols b[i][j][k] = 1/2 (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) (1.96)."""

    def b(i, j, k):
        return (M[i, j].diff(q[k]) + M[i, k].diff(q[j]) - M[j, k].diff(q[i])) / 2

    return [[[b(i, j, k) for k in range(3)] for j in range(3)] for i in range(3)]


def ordered(expression, by):
    """Return the same function, ordered for reading: common factors, then a sum over the parameters `by` (masses, say).

    Each parameter is followed by its factored coefficient; parameters that share one are collected.
    """
    if expression == 0:
        return sympy.S.Zero
    collected = {}
    for powers, coefficient in sympy.Poly(expression, *by).terms():
        if coefficient.is_Add:
            coefficient = sympy.factor(coefficient)
        number, shared = coefficient.as_coeff_Mul()
        parameters = [symbol**power for symbol, power in zip(by, powers, strict=True)]
        collected[shared] = collected.get(shared, 0) + sympy.Mul(number, *parameters)
    return sympy.factor_terms(sympy.Add(*[total * shared for shared, total in collected.items()]))
