"""The equations of motion for poses and whole trajectories: M, C, g, inverse and forward dynamics, energy.

Every function takes an Arm or a theta (3, 20) first (a single row (20,) counts for all joints). With a theta in PWM
counts the results are in PWM counts too. An Arm carries its gravity; a theta does not and takes 9.81 m/s^2 or the
option `g`. The kernels are in `closed_form`; here arrays are checked and looped over.
"""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, numbers, vectors3
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.modelling.arm import Arm

_FLOAT = np.dtype(float)
STANDARD_GRAVITY = 9.81  # m/s^2, the thesis' value; an Arm carries its own


def as_theta(arm, g=None):
    """(theta (3, 20), gravity) of an Arm, or of a theta given as array and its gravity `g` (m/s^2, default 9.81).

    Raises InputError if `arm` is neither, has another shape, or holds a number that is not finite; if `g` is given for
    an Arm, which carries its own, or is negative or not finite.
    """
    if isinstance(arm, Arm):
        if g is not None:
            raise InputError(
                f"g = {g}: an Arm carries its own gravity ({arm.g} m/s^2); use dataclasses.replace(arm, g=...)"
            )
        return arm.kernel_theta, arm.g
    g = STANDARD_GRAVITY if g is None else number("g", g, ">= 0", unit="m/s^2", hint="the base z axis points up")
    single = arm is None or np.isscalar(arm) or not hasattr(arm, "__len__")
    theta = None if single else np.array(numbers("theta", arm, unit="SI or PWM"), order="C")
    if theta is None or theta.shape not in ((3, 20), (20,)):
        found = type(arm).__name__ if theta is None else f"an array of shape {theta.shape}"
        raise InputError(f"expected an Arm, or theta with shape (3, 20) or (20,), got {found}")
    if not np.isfinite(theta).all():
        raise InputError("theta holds a number that is not finite; identify again or drop that parameter (set it to 0)")
    return np.tile(theta, (3, 1)) if theta.ndim == 1 else theta, g


def _rows(**vectors):
    """Check arrays of one shape, (3,) or (n, 3); return them as (n, 3) and whether they were single."""
    arrays = {name: vectors3(name, value, unit="SI") for name, value in vectors.items()}
    shape = np.broadcast_shapes(*(a.shape for a in arrays.values())) if _compatible(arrays) else None
    if shape is None or len(shape) > 2:
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items())
        raise InputError(f"shapes do not fit: {shapes}; give all (3,), or all (n, 3) with the same n")
    rows = [np.ascontiguousarray(np.broadcast_to(a, shape)).reshape(-1, 3) for a in arrays.values()]
    return rows, len(shape) == 1


def _compatible(arrays):
    lengths = {a.shape[0] for a in arrays.values() if a.ndim == 2}
    return len(lengths) <= 1


@jit()
def _mass_loop(theta, q, out):
    for k in range(q.shape[0]):
        q2, q3 = q[k, 1], q[k, 2]
        M = cf.mass_terms(theta, np.cos(q2), np.cos(q3), np.cos(q2 + q3))
        for i in range(3):
            out[k, i, 0], out[k, i, 1], out[k, i, 2] = M[3 * i], M[3 * i + 1], M[3 * i + 2]


def mass_matrix(arm, q):
    """Mass matrix M(q) with rotor inertia on its diagonal    (1.90 corrected).

    Args: arm: Arm or theta; q: (3,) or (n, 3) rad.
    Returns: (3, 3) or (n, 3, 3), kg m^2. Symmetric and positive definite for an Arm; row-wise for a theta
    with unequal rows. Raises InputError.
    """
    theta, _ = as_theta(arm)
    (q,), single = _rows(q=q)
    out = np.empty((len(q), 3, 3))
    _mass_loop(theta, q, out)
    return out[0] if single else out


@jit()
def _coriolis_loop(theta, q, qd, out):
    for k in range(q.shape[0]):
        a, b, c = qd[k]
        q2, q3 = q[k, 1], q[k, 2]
        c2, s2, s3, c23, s23 = np.cos(q2), np.sin(q2), np.sin(q3), np.cos(q2 + q3), np.sin(q2 + q3)
        alpha, beta, _ = cf.coriolis_factors(theta, 0, c2, s2, s3, c23, s23)
        out[k, 0, 0], out[k, 0, 1], out[k, 0, 2] = -alpha * b - beta * c, -alpha * a, -beta * a
        alpha, _, h = cf.coriolis_factors(theta, 1, c2, s2, s3, c23, s23)
        out[k, 1, 0], out[k, 1, 1], out[k, 1, 2] = alpha * a, -h * c, -h * (b + c)
        _, beta, h = cf.coriolis_factors(theta, 2, c2, s2, s3, c23, s23)
        out[k, 2, 0], out[k, 2, 1], out[k, 2, 2] = beta * a, h * b, 0.0


def coriolis_matrix(arm, q, qd):
    """C(q, qd) by Christoffel symbols (1.96): the one for which dM/dt - 2 C is skew.

    Args: arm: Arm or theta; q, qd: (3,) or (n, 3), rad and rad/s.
    Returns: (3, 3) or (n, 3, 3), N m s/rad. C qd are the centrifugal and Coriolis torques (1.97 corrected).
    """
    theta, _ = as_theta(arm)
    (q, qd), single = _rows(q=q, qd=qd)
    out = np.empty((len(q), 3, 3))
    _coriolis_loop(theta, q, qd, out)
    return out[0] if single else out


@jit()
def _gravity_loop(theta, gravity, q, out):
    for k in range(q.shape[0]):
        out[k, 0] = 0.0
        out[k, 1], out[k, 2] = cf.gravity_torques(theta, gravity, np.cos(q[k, 1]), np.cos(q[k, 1] + q[k, 2]))


def gravity(arm, q, *, g=None):
    """Gravity torques g(q) = dU/dq: what holds the arm still    (1.114), 1.5.3c corrected.

    Args: arm: Arm or theta; q: (3,) or (n, 3) rad; g: of a theta, m/s^2, default 9.81. Returns: shape of q, N m.
    """
    theta, g = as_theta(arm, g)
    (q,), single = _rows(q=q)
    out = np.empty_like(q)
    _gravity_loop(theta, g, q, out)
    return out[0] if single else out


def bias(arm, q, qd, *, g=None):
    """All torques but those of acceleration: C(q, qd) qd + g(q) + friction of theta.

    Args: arm: Arm or theta; q, qd: (3,) or (n, 3); g: of a theta, m/s^2, default 9.81. Returns: shape of q, N m.
    """
    return inverse_dynamics(arm, q, qd, np.zeros(3), g=g)


@jit()
def _inverse_loop(theta, gravity, q, qd, qdd, out):
    for k in range(q.shape[0]):
        out[k, 0], out[k, 1], out[k, 2] = cf.inverse(
            theta, gravity, q[k, 1], q[k, 2], qd[k, 0], qd[k, 1], qd[k, 2], qdd[k, 0], qdd[k, 1], qdd[k, 2]
        )


def inverse_dynamics(arm, q, qd, qdd, *, g=None):
    """Torques that make the motion: tau = M qdd + C qd + g + F    (1.74), all linear in theta.

    F is the friction in theta: fv qd + fc sgn(qd) + Tf. The Stribeck part of an Arm's friction is not linear and
    is left to `friction_torque` and the simulation; use `arm.without_friction()` for the rigid body alone.

    Args: arm: Arm or theta; q, qd, qdd: (3,) or (n, 3), rad, rad/s, rad/s^2; g: of a theta, m/s^2, default 9.81.
    Returns: shape of q, N m (PWM counts for a theta in PWM). Raises InputError.
    """
    theta, g = as_theta(arm, g)
    (q, qd, qdd), single = _rows(q=q, qd=qd, qdd=qdd)
    out = np.empty_like(q)
    _inverse_loop(theta, g, q, qd, qdd, out)
    return out[0] if single else out


@jit()
def _forward_one(theta, gravity, q, qd, tau, out):
    """One state into out; returns det M, NaN if any number that went in is not finite."""
    out[0], out[1], out[2], det = cf.forward(theta, gravity, q[1], q[2], qd[0], qd[1], qd[2], tau[0], tau[1], tau[2])
    return det + 0.0 * (q[0] + out[0] + out[1] + out[2])


@jit()
def _forward_loop(theta, gravity, q, qd, tau, out):
    """Fills out; returns the first row with a singular M, or -1."""
    for k in range(q.shape[0]):
        out[k, 0], out[k, 1], out[k, 2], det = cf.forward(
            theta, gravity, q[k, 1], q[k, 2], qd[k, 0], qd[k, 1], qd[k, 2], tau[k, 0], tau[k, 1], tau[k, 2]
        )
        if not (det > 0.0 or det < 0.0):
            return k
    return -1


def forward_dynamics(arm, q, qd, tau, *, g=None):
    """Accelerations that torques make: solve M qdd = tau - C qd - g - F    (1.74).

    F as in `inverse_dynamics`, with sgn(0) = 0: a joint at rest is not held by dry friction here.

    Args: arm: Arm or theta; q, qd, tau: (3,) or (n, 3), rad, rad/s, N m (PWM counts for a theta in PWM); g: of a
        theta, m/s^2, default 9.81.
    Returns: shape of q, rad/s^2.
    Raises: InputError on bad input, or if M is singular at a pose (a link without any inertia).
    """
    # One state, as in a Python simulation loop. It is checked by its result (a bad number makes det NaN), so that
    # checking costs next to nothing; whatever is not plain goes the long way below.
    if (
        type(arm) is Arm
        and g is None
        and type(q) is type(qd) is type(tau) is np.ndarray
        and q.shape == (3,) == qd.shape == tau.shape
        and q.dtype is qd.dtype is tau.dtype is _FLOAT
    ):
        qdd = np.empty(3)
        if _forward_one(arm.kernel_theta, arm.g, q, qd, tau, qdd) > 0.0:
            return qdd
    theta, g = as_theta(arm, g)
    (q, qd, tau), single = _rows(q=q, qd=qd, tau=tau)
    out = np.empty_like(q)
    row = _forward_loop(theta, g, q, qd, tau, out)
    if row >= 0:
        raise InputError(
            f"the mass matrix is singular at q = {q[row].tolist()} rad: a joint moves no inertia there. "
            "Give the links inertia, or the motors rotor inertia"
        )
    return out[0] if single else out


@dataclass(frozen=True)
class Energy:
    """Kinetic and potential energy, J; arrays of shape () or (n,)."""

    kinetic: np.ndarray
    potential: np.ndarray

    @property
    def total(self):
        """Kinetic plus potential, J."""
        return self.kinetic + self.potential


def energy(arm, q, qd, *, g=None):
    """Energy of the moving arm: K = qd' M qd / 2 (rotors included), U with zero at shoulder height    (1.78), (1.111).

    U = g (theta_3 sin q2 + theta_4 sin(q2 + q3)); the column's own constant is left out.

    Args: arm: Arm or theta with equal inertial rows; q, qd: (3,) or (n, 3); g: of a theta, m/s^2, default 9.81.
    Returns: Energy. Raises InputError for a theta with unequal rows: motors of unequal gain scale each row by
    another factor, so that no common energy exists.
    """
    theta, g = as_theta(arm, g)
    inertial = theta[:, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 19]]
    if not (inertial == inertial[0]).all():
        raise InputError("energy needs a theta with three equal rows (N m); this one has its own row per joint")
    (q, qd), single = _rows(q=q, qd=qd)
    M = np.empty((len(q), 3, 3))
    _mass_loop(theta, q, M)
    kinetic = 0.5 * np.einsum("ni,nij,nj->n", qd, M, qd)
    potential = g * (theta[0, 2] * np.sin(q[:, 1]) + theta[0, 3] * np.sin(q[:, 1] + q[:, 2]))
    return Energy(kinetic[0], potential[0]) if single else Energy(kinetic, potential)
