"""Recursive least squares with forgetting    (2.36)-(2.46) corrected, by P^-1 in place of P: it cannot diverge.

P^-1 = forgetting P^-1 + phi phi^T (2.36) and b = forgetting b + phi y give theta = P b, the same as (2.40)-(2.46). The
subtraction in (2.45) loses digits: P is then no longer symmetric, and the estimate can diverge.
"""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.identification.fit_input import checked_data
from ir50p_lab.identification.parameters import ACTS_ON, COLUMNS
from ir50p_lab.inputs import choice, number, numbers


class RLS:
    """Parameters that follow the data, sample by sample    (2.46) corrected.

    After n samples theta minimises sum over k of forgetting^(n - k) |y_k - Phi_k theta|^2, plus |theta|^2/P0: with
    forgetting 1 and a large P0 it is the least-squares estimate. A step costs the same at any n.

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
        self.forgetting = float(forgetting)
        acting = [range(20)] if shared else ACTS_ON
        self._use = np.array([[j in on and j in COLUMNS[columns] for j in range(20)] for on in acting], dtype=float)
        # columns left out get a 1 on the diagonal: their parameters stay 0
        self._least = np.array([np.diag(np.where(use > 0, 1 / P0, 1.0)) for use in self._use])
        self._information, self._b = np.zeros((len(acting), 20, 20)), np.zeros((len(acting), 20))

    def step(self, Phi, y):
        """Take one sample, Phi (3, 20) and y (3,); returns theta (3, 20). Raises InputError, state unchanged."""
        return self.run(numbers("Phi", Phi)[None], numbers("y", y)[None], history=False)

    def run(self, Phi, y, *, history=True):
        """Take n samples, Phi (n, 3, 20) and y (n, 3); returns theta after each, (n, 3, 20).

        history=False returns only the last theta, (3, 20): for very long data. Raises InputError, state unchanged.
        """
        Phi, y = checked_data(Phi, y)
        n, filters = len(y), len(self._b)
        A = np.swapaxes(Phi.reshape(n, filters, -1, 20), 0, 1) * self._use[:, None, None]  # (filters, n, rows, 20)
        y = np.swapaxes(y.reshape(n, filters, -1), 0, 1)
        if not history:
            return self._take(A, y)
        return np.array([self._take(A[:, k : k + 1], y[:, k : k + 1]) for k in range(n)])

    def _take(self, A, y):
        """Add n samples to P^-1 and b, A (filters, n, rows, 20) and y (filters, n, rows); returns theta."""
        filters, n = A.shape[:2]
        weighted = A * (self.forgetting ** np.arange(n)[::-1])[:, None, None]
        weighted, faded = np.swapaxes(weighted.reshape(filters, -1, 20), 1, 2), self.forgetting**n
        self._information = faded * self._information + weighted @ A.reshape(filters, -1, 20)
        self._b = faded * self._b + (weighted @ y.reshape(filters, -1, 1))[..., 0]
        return self.theta

    @property
    def theta(self):
        """The parameters now, (3, 20)."""
        found = np.linalg.solve(self._information + self._least, self._b[..., None])[..., 0]
        return np.tile(found, (3 // len(found), 1))

    @property
    def P(self):
        """(3, 20, 20), or (20, 20) if shared; 0 for columns left out."""
        P = np.linalg.inv(self._information + self._least) * self._use[:, None] * self._use[:, :, None]
        return P[0] if len(P) == 1 else P
