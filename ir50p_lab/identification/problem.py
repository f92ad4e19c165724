"""One least-squares problem, prepared: columns scaled to length 1, dependent ones set aside, QR factors ready."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.qr import independent_columns, product, r_factor

DEPENDENT = 1e-8  # a column of which less than this sticks out of the others carries nothing but rounding
_CLOSE = 30.0  # condition index from which columns are hardly told apart (Belsley, Kuh and Welsch 1980)
_SHARE = 0.5  # share of a parameter's variance that must come from that direction


@dataclass(frozen=True, eq=False)
class Problem:
    """Minimise |y - A beta|, for one joint or for all three.

    who: for sentences, "joint 2: " or ""; names: of the columns of A; A (N, p): scaled by `scale` (p,), so that
    beta / scale are the parameters; y (N,); n: number of samples (N = n or 3 n, sample by sample); lost: names of
    columns that cannot be had; notes: why.
    """

    who: str
    names: tuple
    A: np.ndarray
    y: np.ndarray
    scale: np.ndarray
    n: int
    R: np.ndarray
    Qty: np.ndarray
    lost: tuple
    notes: tuple

    @cached_property
    def Q(self):
        """Orthonormal columns that span those of A: A R^-1."""
        return product(self.A, self.R_inverse)

    @cached_property
    def R_inverse(self):
        """R^-1: triangular, so that elimination is back substitution, without loss of digits."""
        return np.linalg.solve(self.R, np.eye(len(self.R)))

    @cached_property
    def condition(self):
        """Condition number of A, its columns of length 1."""
        return float(np.linalg.cond(self.R))

    def residuals(self, beta):
        """y - A beta, (N,)."""
        return self.y - product(self.A, beta)

    def hardly_told_apart(self):
        """Sentences about columns that are nearly dependent: variance decomposition proportions (Belsley 1980)."""
        _, s, Vt = np.linalg.svd(self.R)
        variances = (Vt / s[:, None]) ** 2  # row: direction, column: parameter
        share = variances / variances.sum(axis=0)
        found = []
        for direction in range(len(s)):
            members = [k for k in range(len(s)) if share[direction, k] > _SHARE]
            index = s[0] / s[direction]
            if index > _CLOSE and len(members) > 1:
                found.append(
                    f"{self.who}{', '.join(self.names[k] for k in members)} are hardly told apart (condition index "
                    f"{index:.0f}): a combination of them is known, not each. Excite the joints more"
                )
        return found


def prepare(who, names, A, y, n, tolerance=DEPENDENT):
    """A Problem from columns A (N, p) and y (N,).

    Raises IdentificationError if there are fewer than twice as many equations as parameters.
    """
    if len(A) < 2 * len(names):
        raise IdentificationError(
            f"{who}{len(A)} equations for {len(names)} parameters: record at least {2 * len(names)} "
            "samples, better some seconds of rich motion, or fit fewer columns"
        )
    length = np.sqrt(np.einsum("np,np->p", A, A))
    seen = length > 1e-12 * length.max(initial=0.0)
    lost = [name for name, here in zip(names, seen, strict=True) if not here]
    notes = [f"{who}{', '.join(lost)} cannot be found: nothing in the data excites it"] if lost else []
    names = [name for name, here in zip(names, seen, strict=True) if here]
    if not names:
        raise IdentificationError(
            f"{who}no column is excited: the data hold no motion. Move the joint and record again"
        )
    A, length = A[:, seen] / length[seen], length[seen]
    R, Qty = _factors(A, y)
    kept = independent_columns(R, tolerance)
    if len(kept) < len(names):
        notes += _groups_in_words(who, names, R / length, kept)
        lost += [names[k] for k in range(len(names)) if k not in kept]
        names, A, length = [names[k] for k in kept], A[:, kept], length[kept]
        R, Qty = _factors(A, y)
    return Problem(who, tuple(names), A, y, length, n, R, Qty, tuple(lost), tuple(notes))


def _factors(A, y):
    """R (p, p) and Q^T y (p,) of A = Q R."""
    R = r_factor(np.column_stack([A, y]))
    p = A.shape[1]
    return np.ascontiguousarray(R[:p, :p]), R[:p, -1]


def _groups_in_words(who, names, R, kept):
    """One sentence per dependent column: what the kept ones now stand for."""
    sentences = []
    for k in sorted(set(range(len(names))) - set(kept)):
        weights = np.linalg.lstsq(R[:, kept], R[:, k], rcond=None)[0]
        largest = np.abs(weights).max()
        parts = [(names[j], w) for j, w in zip(kept, weights, strict=True) if abs(w) > 1e-7 * largest]
        stands = "; ".join(f"{name} stands for {name} {w:+.4g} {names[k]}" for name, w in parts)
        others = ", ".join(name for name, _ in parts)
        sentences.append(f"{who}{names[k]} cannot be told apart from {others}: {stands}")
    return sentences
