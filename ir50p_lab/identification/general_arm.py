"""The regressor of an arm of the same joints whose links may have any shape: 42 parameters, of which 25 are base.

Each link by its mass, first moments (mass times centre of mass, from the joint, in the link frame) and inertia about
the joint's origin: in these, and only in these, the torques are linear. The columns come from the symbolic derivation
(`derive(general=True)`), so that this is another route to the equations of motion than the closed form.
"""

import functools

import numpy as np
import sympy

from ir50p_lab.errors import InputError
from ir50p_lab.identification.parameters import metres
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.dynamics import STANDARD_GRAVITY
from ir50p_lab.modelling.symbolic import derive

_FRICTION = tuple(name for j in "123" for name in (f"fv{j}", f"fc{j}", f"Tf{j}"))
# Those that stay come first: base_parameters() keeps the earlier column and adds the later one to its group. The
# order follows Khalil and Dombre's rule: of each link YY, m and mz go over to the links before it.
_KEPT = (
    "ZZ1 XX2 XY2 XZ2 YZ2 ZZ2 mx2 my2 XX3 XY3 XZ3 YZ3 ZZ3 mx3 my3 j3 YY2 YY3 m3 mz3 j1 j2 "
    "m2 mz2 m1 mx1 my1 mz1 XX1 YY1 XY1 XZ1 YZ1"
).split()
GENERAL_NAMES = (*_KEPT, *_FRICTION)


def general_regressor(q, qd, qdd, *, l2):
    """Phi of the general arm: tau = Phi pi, pi = (33 inertial, 9 friction parameters) as GENERAL_NAMES.

    Args: q, qd, qdd: (n, 3), rad, rad/s, rad/s^2; l2: upper arm, m.
    Returns: (n, 3, 42). Raises InputError on shapes, numbers that are not finite, l2 <= 0.
    """
    q, qd, qdd = (vectors3(name, x, unit="SI") for name, x in (("q", q), ("qd", qd), ("qdd", qdd)))
    if q.ndim != 2 or q.shape != qd.shape or q.shape != qdd.shape:
        raise InputError(f"q {q.shape}, qd {qd.shape}, qdd {qdd.shape}: give all (n, 3)")
    model, torque = _torque()
    known = {"l2": metres("l2", l2), "g": STANDARD_GRAVITY}
    out = np.zeros((len(q), 3, len(GENERAL_NAMES)))
    for k, name in enumerate(_KEPT):
        for sign, numbers in unit_parameters(name):
            values = [(known | numbers).get(parameter, 0.0) for parameter in model.symbols]
            for joint, tau in enumerate(torque(q.T, qd.T, qdd.T, values)):
                out[:, joint, k] += sign * tau
    for joint, speed in enumerate(qd.T):
        first = len(_KEPT) + 3 * joint
        out[:, joint, first : first + 3] = np.column_stack([speed, np.sign(speed), np.ones(len(q))])
    return out


def unit_parameters(name):
    """Masses, centres of mass and inertias whose torque is the column of parameter `name`: [(sign, {symbol: number})].

    The derivation is in centres of mass. A point mass 1 at distance 1 on an axis has first moment 1; its inertia
    about the joint is made 0 by inertias of -1 about the two other axes, and its mass by taking the bare mass off.
    """
    i = name[-1]
    if name[0] == "j" or name[:-1] == "m":
        return [(1.0, {name: 1.0})]
    if name[0] in "XYZ":
        return [(1.0, {f"I{name[:2].lower()}{i}": 1.0})]
    axis = name[1]
    outside = {f"I{other}{other}{i}": -1.0 for other in "xyz" if other != axis}
    return [(1.0, {f"m{i}": 1.0, f"{axis}{i}": 1.0, **outside}), (-1.0, {f"m{i}": 1.0})]


@functools.cache
def _torque():
    """The SymbolicModel of the general arm, and its torque as a function of q, qd, qdd and the parameters."""
    model = derive(general=True)
    arguments = [list(model.q), list(model.qd), list(model.qdd), list(model.symbols.values())]
    return model, sympy.lambdify(arguments, list(model.tau), "numpy", cse=True)
