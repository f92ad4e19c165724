def frames(q, l):
    A1 = dh_matrix(q[0], l[0], 0, np.pi / 2)
    A2 = dh_matrix(q[1], 0, l[1], 0)
    A3 = dh_matrix(q[2], 0, l[2], -np.pi / 2)
    return np.array([np.eye(4), A1, A1 @ A2, A1 @ A2 @ A3])
