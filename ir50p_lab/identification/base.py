"""Base parameters: which parameters a motion can tell apart, and which act on the torque only as a group."""

from collections import namedtuple

import numpy as np

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification.fit_input import finite
from ir50p_lab.identification.parameters import NAMES
from ir50p_lab.identification.regression import DEPENDENT, independent_columns


class BaseParameters(namedtuple("BaseParameters", "rank columns matrix names unseen groups singular_values")):
    """Phi theta = Phi[..., columns] (matrix theta): as many base parameters as the rank, each a group.

    =============== ============================================================================== =========
    field           meaning                                                                        shape
    =============== ============================================================================== =========
    rank            number of independent combinations of parameters that Phi determines           int
    columns         indices of the columns kept, which are independent                             (rank,)
    matrix          base = matrix theta: the groups                                                (rank, p)
    names           of all columns                                                                 p
    unseen          names of columns that are zero: parameters without effect                      tuple
    groups          the base parameters in symbols, one string each                                rank
    singular_values of Phi with columns scaled to length 1, largest first: the drop after `rank`   (p,)
                    shows how clear the rank is
    =============== ============================================================================== =========
    """

    def __str__(self):
        head = f"{self.rank} base parameters of {len(self.names)}"
        unseen = [f"without effect: {', '.join(self.unseen)}"] if self.unseen else []
        return "\n".join([head, *(f"  {k + 1:2}  {group}" for k, group in enumerate(self.groups)), *unseen])


def base_parameters(Phi, *, names=None):
    """Which combinations of parameters the regressor Phi can tell apart, by QR and by SVD.

    Columns are scaled to length 1 and taken in order. A column that is a combination of those kept before it, but for
    less than 1e-8 of its length, joins their groups. The singular values must give the same rank.

    Args:
        Phi: (n, 3, p), (n, k, p) or (m, p), from exact motion rich enough to excite everything (random states do);
            not from noisy data, where nothing is exactly dependent.
        names: of the p columns; default the 20 parameters, or p1, p2, ...

    Returns: BaseParameters. Raises InputError on bad arguments, IdentificationError if Phi is zero, or if QR and SVD
    disagree on the rank: some combination of parameters is excited, but hardly.
    """
    A, names = _checked(Phi, names)
    length = np.linalg.norm(A, axis=0)
    seen = np.flatnonzero(length > 1e-14 * length.max())
    R = np.linalg.qr(A[:, seen] / length[seen], mode="r")
    kept, weights = independent_columns(R)
    s = np.linalg.svd(R, compute_uv=False)
    if (above := np.sum(s > DEPENDENT * s[0])) != len(kept):
        said = f"{len(kept)} columns are independent to {DEPENDENT:g}, but {above} singular values are larger than that"
        raise IdentificationError(f"the rank is not clear: {said}: use richer or exact motion")
    columns = seen[kept]
    matrix = np.zeros((len(kept), len(names)))
    matrix[:, seen] = weights * length[seen] / length[columns][:, None]
    matrix[:, columns] = np.eye(len(kept))
    return BaseParameters(
        rank=len(kept),
        columns=columns,
        matrix=matrix,
        names=names,
        unseen=tuple(name for k, name in enumerate(names) if k not in seen),
        groups=tuple(_in_symbols(row, k, names) for k, row in zip(columns, matrix, strict=True)),
        singular_values=s,
    )


def _checked(Phi, names):
    A = finite("Phi", Phi)
    if A.ndim not in (2, 3) or not 0 < 2 * A.shape[-1] ** 2 <= A.size:
        raise InputError(f"Phi has shape {A.shape}; give (n, 3, p) or (m, p), from random states, of 2 p rows at least")
    A = A.reshape(-1, A.shape[-1])
    p = A.shape[1]
    if names is None:
        names = NAMES if p == len(NAMES) else [f"p{k + 1}" for k in range(p)]
    if len(names) != p:
        raise InputError(f"{len(names)} names for {p} columns: give one for each")
    if not A.any():
        raise IdentificationError("Phi is zero throughout: there is no motion in it")
    return A, tuple(names)


def _in_symbols(row, kept, names):
    """A sum like 'XX2 - YY2 - 0.04 m3' from the coefficients `row` (p,); the name of the kept column comes first."""
    text = names[kept]
    for k in np.flatnonzero(row):
        if k != kept:
            size = "" if abs(abs(row[k]) - 1) < 1e-6 else f"{abs(row[k]):.4g} "
            text += f" {'+' if row[k] > 0 else '-'} {size}{names[k]}"
    return text
