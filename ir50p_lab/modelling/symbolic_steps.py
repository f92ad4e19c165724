"""The steps of the symbolic derivation, each on matrices of ring elements (lists of rows, see TrigRing)."""


def chain(ring):
    """Frames T^0_0 ... T^0_3 of the DH chain (1.29), and the rotations of the three link frames.

    The link frame of link i is its DH frame before the twist alpha_i: link 1 turns about z0; links 2 and 3 have
    x along the link and z along the joint axis.
    """
    g, zero, one = ring.gen, ring.zero, ring.one
    # Table 1.1 corrected: d, a and the twist as (cos alpha, sin alpha) = (0, +1), (1, 0), (0, -1)
    rows = [(g["l1"], zero, (0, 1)), (zero, g["l2"], (1, 0)), (zero, g["l3"], (0, -1))]
    frames = [[[one if i == j else zero for j in range(4)] for i in range(4)]]
    rotations = []
    for name, (d, a, (ca, sa)) in zip("123", rows, strict=True):
        c, s = g["c" + name], g["s" + name]
        turn = [[c, -s, zero, a * c], [s, c, zero, a * s], [zero, zero, one, d], [zero, zero, zero, one]]
        twist = [
            [one, zero, zero, zero],
            [zero, ca * one, -sa * one, zero],
            [zero, sa * one, ca * one, zero],
            [zero, zero, zero, one],
        ]
        turned = ring.multiply(frames[-1], turn)
        rotations.append([row[:3] for row in turned[:3]])
        frames.append(ring.multiply(turned, twist))
    return frames, rotations


def bodies(ring, links, frames, rotations):
    """Centres of mass p_ci in the base frame, and inertia tensors with the rotation of the frame they are given in.

    Returns: 3 rows of 3 coordinates; 3 pairs (rotation, tensor).
    """
    g, zero = ring.gen, ring.zero
    if links == "general":
        in_link = [[g[axis + i] for axis in "xyz"] for i in "123"]
    elif links == "in-line":
        in_link = [[zero, zero, g["lc1"]], [g["lc2"], zero, zero], [g["lc3"], zero, zero]]
    else:  # the thesis has the centre of mass of the column beside its axis
        in_link = [[g[f"lc{i}"], zero, zero] for i in "123"]
    centres = []
    for joint_frame, R, r in zip(frames, rotations, in_link, strict=False):
        turned = ring.multiply(R, [[x] for x in r])
        centres.append([ring.reduce(joint_frame[k][3] + turned[k][0]) for k in range(3)])

    def tensor(i):
        I = {pair: g.get(f"I{pair}{i}", zero) for pair in ("xx", "yy", "zz", "xy", "xz", "yz")}
        return [[I["xx"], -I["xy"], -I["xz"]], [-I["xy"], I["yy"], -I["yz"]], [-I["xz"], -I["yz"], I["zz"]]]

    # The thesis' inertias stay constant in the frame that turns with joint 1 only.
    given_in = [rotations[0]] * 3 if links == "thesis" else rotations
    return centres, [(R, tensor(i)) for R, i in zip(given_in, "123", strict=True)]


def jacobian(ring, p):
    """Jv = dp/dq, 3 x 3 (1.86)."""
    return [[ring.reduce(ring.diff(x, j)) for j in range(3)] for x in p]


def angular_jacobians(ring, frames):
    """Jw of the three links, base frame: [z0 0 0], [z0 z1 0], [z0 z1 z2] (1.88 corrected: joint i has z_i-1)."""
    axes = [[row[2] for row in frame[:3]] for frame in frames]
    return [[[axes[j][k] if j <= i else ring.zero for j in range(3)] for k in range(3)] for i in range(3)]


def mass_matrix(ring, Jv, Jw, tensors):
    """M = sum of m Jv^T Jv + Jw^T R I R^T Jw, plus the rotors on the diagonal (1.90 corrected)."""
    g = ring.gen
    M = [[g[f"j{i + 1}"] if i == j else ring.zero for j in range(3)] for i in range(3)]
    for n, (jv, jw, (R, I)) in enumerate(zip(Jv, Jw, tensors, strict=True)):
        w = ring.multiply(transpose(R), jw)  # the link's angular velocity in the frame of its tensor
        turning = ring.multiply(transpose(w), I, w)
        moving = ring.multiply(transpose(jv), jv)
        for i in range(3):
            for j in range(3):
                M[i][j] += g[f"m{n + 1}"] * moving[i][j] + turning[i][j]
    return [[ring.reduce(p) for p in row] for row in M]


def christoffel(ring, M):
    """b[i][j][k] = 1/2 (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) (1.96)."""
    D = [[[ring.diff(M[i][j], k) for k in range(3)] for j in range(3)] for i in range(3)]
    half = ring.rational(1, 2)
    return [
        [[ring.reduce(half * (D[i][j][k] + D[i][k][j] - D[j][k][i])) for k in range(3)] for j in range(3)]
        for i in range(3)
    ]


def potential(ring, centres):
    """U = g sum m_i z_ci (1.111)."""
    return ring.reduce(ring.gen["g"] * ring.dot([ring.gen[f"m{i}"] for i in "123"], [p[2] for p in centres]))


def transpose(matrix):
    """Rows to columns."""
    return [list(column) for column in zip(*matrix, strict=True)]
