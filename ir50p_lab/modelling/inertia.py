"""What one point of a solid adds to its inertia tensor: (1.100)-(1.110 corrected) integrate it."""

import sympy


def second_moment_tensor(p):
    """Return (p^T p) I3 - p p^T of one point, (3, 3), which (1.101) integrates over the solid (1.103 corrected).

    Args: p: (3,) coordinates, symbols or numbers. Returns: sympy matrix.
    """
    p = sympy.Matrix(p)
    return p.dot(p) * sympy.eye(3) - p * p.T
