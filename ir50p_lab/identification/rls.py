"""Recursive least squares with forgetting, P = U D U^T in its factors    (2.36)-(2.46) corrected.

With P(t)^-1 = forgetting P(t-1)^-1 + phi phi^T (2.36), the matrix inversion lemma gives, for a block of three rows
phi^T = Phi (3, 20):

    S = forgetting I + phi^T P(t-1) phi             (2.43) corrected: P, not its inverse, between phi^T and phi
    K = P(t-1) phi S^-1                             (2.44) corrected
    theta(t) = theta(t-1) + K (y - phi^T theta)     (2.40) corrected: both signs +
    P(t) = (I - K phi^T) P(t-1) / forgetting        (2.45)

The subtraction in (2.45) loses digits: with P0 = 1e8 P is no longer symmetric, with 1e12 it has
negative eigenvalues, and where P phi and (phi^T P)^T are taken for the same the estimate runs away (all tested). Here
P = U D U^T is updated in its factors, row by row (Bierman 1976): D stays positive whatever the rounding.
"""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.fit_input import checked_data
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS
from ir50p_lab.inputs import choice, number, numbers
from ir50p_lab.jit import jit

_fast = jit(fastmath={"reassoc", "contract", "nsz", "arcp"})  # sums in any order: several products at once


@_fast
def ud_row(theta, V, D, h, y, K):
    """One equation y = h theta into theta (p,), V = U^T (p, p) and D (p,); K (p,) is work space.

    Bierman's update of P = U D U^T to P - P h^T h P / (1 + h P h^T), without any difference of large numbers.
    """
    p = theta.shape[0]
    error = y
    for i in range(p):
        error -= h[i] * theta[i]
    alpha, inverse = 1.0, 1.0
    for j in range(p):
        row = V[j]
        f = h[j]
        for i in range(j):
            f += row[i] * h[i]
        if f == 0.0 or D[j] == 0.0:  # a column that says nothing here, or is not chosen
            K[j] = 0.0
            continue
        v = D[j] * f
        new_alpha = alpha + f * v
        new_inverse = 1.0 / new_alpha
        D[j] *= alpha * new_inverse
        scale = -f * inverse
        for i in range(j):
            old = row[i]
            row[i] = old + K[i] * scale
            K[i] += old * v
        K[j] = v
        alpha, inverse = new_alpha, new_inverse
    error *= inverse
    for i in range(p):
        theta[i] += K[i] * error


@jit()
def _run(theta, V, D, forgetting, largest, Phi, y, history):
    """Samples Phi (n, 3, 20) and y (n, 3) into the state of one shared filter or of three, one per joint.

    theta (k, 20), V (k, 20, 20), D (k, 20): k = 1 or 3 filters; a column with D = 0 is not part of it. Forgetting
    divides D, but never beyond `largest`. Writes theta into history (n, k, 20), if it has any rows.
    """
    filters, p = theta.shape
    K = np.empty(p)
    for k in range(len(y)):
        for i in range(3):
            part = min(i, filters - 1)
            if forgetting < 1.0 and part == i:
                D[part] = np.minimum(D[part] / forgetting, largest)
            ud_row(theta[part], V[part], D[part], Phi[k, i], y[k, i], K)
        if len(history):
            history[k] = theta


class RLS:
    """Parameters that follow the data, sample by sample    (2.46) corrected.

    After n samples theta minimises sum over k of forgetting^(n - k) |y_k - Phi_k theta|^2, plus
    forgetting^n |theta|^2/P0: with forgetting 1 and a large P0 it is the least-squares estimate. A step
    costs the same at any n.

    Args:
        rows: "joint": a filter and parameters for each joint; "shared": one theta for all, Phi a 3 x 20 block.
        columns: which parameters, as for `fit`.
        P0: P starts as P0 I: large says 'I know nothing'. In 1/unit^2 of the regressor; > 0.
        forgetting: 0.9 to 1, say. Memory is 1/(1 - forgetting) samples: 0.999 at 100 Hz is 10 s. P never grows beyond
            P0, so that directions without excitation do not blow up.

    Attributes: theta (3, 20), 0 for columns left out; P (3, 20, 20), or (20, 20) if shared: with forgetting 1 and
    white residuals of variance s^2 the covariance of theta is s^2 P.

    Raises InputError on bad arguments.
    """

    def __init__(self, *, rows="joint", columns="rigid", P0=1e8, forgetting=1.0):
        shared = choice("rows", rows, ("joint", "shared")) == "shared"
        choice("columns", columns, tuple(COLUMNS))
        P0 = number("P0", P0, "> 0", hint="1e8 says that nothing is known")
        if number("forgetting", forgetting, "> 0") > 1:
            raise InputError(f"forgetting = {forgetting}: give at most 1; 0.999 recalls 1000 samples")
        self.P0, self.forgetting = P0, float(forgetting)
        acting = [range(20)] if shared else ACTS_ON
        chosen = np.array([[j in on and j in COLUMNS[columns] for j in range(20)] for on in acting])
        k = len(acting)
        self._theta, self._V, self._D = np.zeros((k, 20)), np.tile(np.eye(20), (k, 1, 1)), P0 * chosen

    def step(self, Phi, y):
        """Take one sample, Phi (3, 20) and y (3,); returns theta (3, 20). Raises InputError, state unchanged."""
        return self.run(numbers("Phi", Phi)[None], numbers("y", y)[None], history=False)

    def run(self, Phi, y, *, history=True):
        """Take n samples, Phi (n, 3, 20) and y (n, 3); returns theta after each, (n, 3, 20).

        history=False returns only the last theta, (3, 20): for very long data. Raises InputError, state unchanged.
        """
        Phi, y = map(np.ascontiguousarray, checked_data(Phi, y))
        states = np.empty((len(y) if history else 0, *self._theta.shape))
        _run(self._theta, self._V, self._D, self.forgetting, self.P0, Phi, y, states)
        return np.tile(states, (1, 3 // len(self._theta), 1)) if history else self.theta

    @property
    def theta(self):
        """The parameters now, (3, 20)."""
        return np.tile(self._theta, (3 // len(self._theta), 1))

    @property
    def P(self):
        """U D U^T now: (3, 20, 20), or (20, 20) if shared; 0 for columns left out."""
        P = np.swapaxes(self._V, 1, 2) * self._D[:, None] @ self._V
        return P[0] if len(P) == 1 else P
