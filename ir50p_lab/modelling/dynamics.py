"""The equations of motion for poses and whole trajectories: M, C, g, inverse and forward dynamics, energy.

Every function takes an Arm or a theta (3, 20) as its first argument; a single row (20,) counts for all joints. With a
theta in PWM counts the results are in PWM counts, too. An Arm carries its own gravity; a theta does not, so for it
9.81 m/s^2 is taken, or the option `g`. The equations are in `closed_form`.
"""

from collections import namedtuple

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, numbers
from ir50p_lab.jit import jit
from ir50p_lab.modelling import closed_form as cf
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.kernel import NOT_FINITE, evaluate, kernel, same_shape, warn_of_degrees

STANDARD_GRAVITY = 9.81  # m/s^2, the thesis's value; an Arm carries its own


def as_theta(arm, g=None):
    """Return (theta (3, 20), gravity) of an Arm, or of a theta given as an array with its `g` (m/s^2, default 9.81).

    Raises InputError if `arm` is neither, has another shape, or holds a number that is not finite; and if `g` is given
    for an Arm, which carries its own, or is negative or not finite.
    """
    if isinstance(arm, Arm):
        if g is not None:
            raise InputError(
                f"g = {g}: an Arm carries its own gravity ({arm.g} m/s^2); use dataclasses.replace(arm, g=...)"
            )
        return arm.theta.copy(), arm.g
    g = STANDARD_GRAVITY if g is None else number("g", g, ">= 0", unit="m/s^2", hint="the base z axis points up")
    try:
        shape = np.shape(arm)
    except ValueError:  # rows of different lengths
        shape = None
    if shape not in ((3, 20), (20,)):
        raise InputError(
            f"expected an Arm, or theta with shape (3, 20) or (20,), got {type(arm).__name__} of shape {shape}"
        )
    theta = np.array(numbers("theta", arm, unit="SI or PWM"), order="C")
    if not np.isfinite(theta).all():
        raise InputError("theta holds a number that is not finite; identify again or drop that parameter (set it to 0)")
    return np.tile(theta, (3, 1)) if theta.ndim == 1 else theta, g


def _evaluate(function, arm, g=None, **vectors):
    """`function` of theta, gravity and the vectors. An Arm is right, and a theta of the right shape is tried first."""
    if g is None and isinstance(arm, Arm):
        constants = arm.theta, arm.g
    elif g is None and isinstance(arm, np.ndarray) and arm.shape == (3, 20):
        constants = arm, STANDARD_GRAVITY
    else:
        constants = as_theta(arm, g)
    result = evaluate(function, constants, lambda: as_theta(arm, g), **vectors)
    warn_of_degrees(arm, vectors["q"])
    return result


@jit()
def _refuse_not_finite(q1, result):
    """Raise InputError if a number of a result, or q1 (on which nothing depends), is not finite."""
    total = q1
    for x in result.flat:
        total += x
    if not np.isfinite(total):
        raise InputError(NOT_FINITE)


@kernel("(n,k),(),(n)->(n,n)")
def _mass(theta, gravity, q, M):
    terms = cf.mass_terms(theta, np.cos(q[1]), np.cos(q[2]), np.cos(q[1] + q[2]))
    for i in range(3):
        M[i, 0], M[i, 1], M[i, 2] = terms[3 * i], terms[3 * i + 1], terms[3 * i + 2]
    _refuse_not_finite(q[0], M)


def mass_matrix(arm, q):
    """Return the mass matrix M(q), with the rotor inertia on its diagonal    (1.90 corrected).

    Args: arm: Arm or theta; q: (3,) or (n, 3) rad.
    Returns: (3, 3) or (n, 3, 3), kg m^2. It is symmetric and positive definite for an Arm; for a theta with unequal
    rows each row has its own parameters. Raises InputError for wrong shapes and numbers that are not finite.

    >>> from ir50p_lab.modelling import IR50P, mass_matrix
    >>> mass_matrix(IR50P, [0, 0, 0]).round(3)
    array([[0.3  , 0.   , 0.   ],
           [0.   , 0.33 , 0.059],
           [0.   , 0.059, 0.152]])
    """
    return _evaluate(_mass, arm, q=q)


@kernel("(n,k),(),(n),(n)->(n,n)")
def _coriolis(theta, gravity, q, qd, C):
    a, b, c = qd
    q2, q3 = q[1], q[2]
    c2, s2, s3, c23, s23 = np.cos(q2), np.sin(q2), np.sin(q3), np.cos(q2 + q3), np.sin(q2 + q3)
    alpha, beta, _ = cf.coriolis_factors(theta, 0, c2, s2, s3, c23, s23)
    C[0, 0], C[0, 1], C[0, 2] = -alpha * b - beta * c, -alpha * a, -beta * a
    alpha, _, h = cf.coriolis_factors(theta, 1, c2, s2, s3, c23, s23)
    C[1, 0], C[1, 1], C[1, 2] = alpha * a, -h * c, -h * (b + c)
    _, beta, h = cf.coriolis_factors(theta, 2, c2, s2, s3, c23, s23)
    C[2, 0], C[2, 1], C[2, 2] = beta * a, h * b, 0.0
    _refuse_not_finite(q[0], C)


def coriolis_matrix(arm, q, qd):
    """Return C(q, qd) by Christoffel symbols (1.96), the one choice of C for which dM/dt - 2 C is skew-symmetric.

    Args: arm: Arm or theta; q, qd: (3,) or (n, 3), rad and rad/s.
    Returns: (3, 3) or (n, 3, 3), N m s/rad. C qd are the centrifugal and Coriolis torques (1.97 corrected).

    >>> from ir50p_lab.modelling import IR50P, coriolis_matrix
    >>> coriolis_matrix(IR50P, [0, 0.8, -1.2], [0, 0, 0]) + 0.0
    array([[0., 0., 0.],
           [0., 0., 0.],
           [0., 0., 0.]])
    """
    return _evaluate(_coriolis, arm, q=q, qd=qd)


@kernel("(n,k),(),(n)->(n)")
def _gravity(theta, gravity, q, torques):
    torques[0] = 0.0
    torques[1], torques[2] = cf.gravity_torques(theta, gravity, np.cos(q[1]), np.cos(q[1] + q[2]))
    _refuse_not_finite(q[0], torques)


def gravity(arm, q, *, g=None):
    """Return the gravity torques g(q) = dU/dq, which hold the arm still    (1.114), 1.5.3c corrected.

    Args: arm: Arm or theta; q: (3,) or (n, 3) rad; g: for a theta only, m/s^2, default 9.81.
    Returns: the shape of q, N m.

    >>> from ir50p_lab.modelling import IR50P, gravity
    >>> gravity(IR50P, [0, 0, 0]).round(2)
    array([0.  , 3.79, 1.33])
    """
    return _evaluate(_gravity, arm, g, q=q)


@kernel("(n,k),(),(n),(n),(n)->(n)")
def _inverse(theta, gravity, q, qd, qdd, tau):
    a, b, c = qd
    A, B, C = qdd
    tau[0], tau[1], tau[2] = cf.inverse(theta, gravity, q[1], q[2], a, b, c, A, B, C)
    _refuse_not_finite(q[0], tau)


def inverse_dynamics(arm, q, qd, qdd, *, g=None):
    """Return the torques that make a motion: tau = M qdd + C qd + g + F    (1.74), all of it linear in theta.

    F is the friction that theta holds: fv qd + fc sgn(qd) + Tf. The Stribeck part of an Arm's friction is not linear:
    `friction_torque` and the simulation have it. For the rigid body alone use `arm.without_friction()`.

    Args: arm: Arm or theta; q, qd, qdd: (3,) or (n, 3), rad, rad/s, rad/s^2; g: for a theta only, m/s^2, default 9.81.
    Returns: the shape of q, N m (PWM counts for a theta in PWM counts).
    Raises InputError for wrong shapes and numbers that are not finite.

    >>> from ir50p_lab.modelling import IR50P, inverse_dynamics
    >>> inverse_dynamics(IR50P, [0, 0, 0], [0, 0, 0], [0, 0, 1]).round(2)
    array([0.06, 3.76, 1.53])
    """
    return _evaluate(_inverse, arm, g, q=q, qd=qd, qdd=qdd)


@kernel("(n,k),(),(n),(n),(n)->(n)")
def _forward(theta, gravity, q, qd, tau, qdd):
    a, b, c = qd
    qdd[0], qdd[1], qdd[2], det = cf.forward(theta, gravity, q[1], q[2], a, b, c, tau[0], tau[1], tau[2])
    if det == 0.0:
        raise InputError(
            "the mass matrix is singular: a joint moves no inertia. Give the links inertia, or the motors rotor inertia"
        )
    _refuse_not_finite(q[0], qdd)


def forward_dynamics(arm, q, qd, tau, *, g=None):
    """Return the accelerations that torques make: solve M qdd = tau - C qd - g - F    (1.74).

    F is that of `inverse_dynamics`, with sgn(0) = 0: dry friction does not hold a joint at rest here.

    Args: arm: Arm or theta; q, qd, tau: (3,) or (n, 3), rad, rad/s, N m (PWM counts for a theta in PWM counts); g: for
        a theta only, m/s^2, default 9.81.
    Returns: the shape of q, rad/s^2.
    Raises: InputError on bad input, or if M is singular at a pose (a link without any inertia).

    >>> from ir50p_lab.modelling import IR50P, forward_dynamics, inverse_dynamics
    >>> q, qd = [0, 0.8, -1.2], [0, 0, 0]
    >>> forward_dynamics(IR50P, q, qd, inverse_dynamics(IR50P, q, qd, [0, 0, 1])).round(3) + 0.0
    array([0., 0., 1.])
    """
    return _evaluate(_forward, arm, g, q=q, qd=qd, tau=tau)


class Energy(namedtuple("Energy", "kinetic potential")):
    """Kinetic and potential energy, J; each of shape () or (n,)."""

    @property
    def total(self):
        """The sum of kinetic and potential energy, J."""
        return self.kinetic + self.potential


def energy(arm, q, qd, *, g=None):
    """Return the energy of the moving arm: kinetic K = qd' M qd / 2 and potential U    (1.78), (1.111).

    K includes the rotors. U is zero at shoulder height: U = g (theta_3 sin q2 + theta_4 sin(q2 + q3)), without the
    column's own constant.

    Args: arm: Arm, or theta with equal inertial rows; q, qd: (3,) or (n, 3), rad and rad/s; g: for a theta only, m/s^2,
        default 9.81.
    Returns: Energy, J. Raises InputError for a theta with unequal rows: motors of unequal gain scale each row by
    another factor, so that no common energy exists.

    >>> from ir50p_lab.modelling import IR50P, energy
    >>> float(energy(IR50P, [0, 0, 0], [0, 0, 0]).total)
    0.0
    """
    theta, g = as_theta(arm, g)
    inertial = theta[:, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 19]]
    if not (inertial == inertial[0]).all():
        raise InputError("energy needs a theta with three equal rows (N m); this one has its own row per joint")
    q, qd = same_shape(q=q, qd=qd)
    kinetic = 0.5 * np.einsum("...i,...ij,...j", qd, mass_matrix(theta, q), qd)
    potential = g * (theta[0, 2] * np.sin(q[..., 1]) + theta[0, 3] * np.sin(q[..., 1] + q[..., 2]))
    return Energy(kinetic, potential)
