"""The equations of motion as scalar functions of theta, compiled: M, C, g, friction, forward dynamics.

Everything here is written once, in terms of theta (3, 20): row i holds the coefficients of joint i (thesis 2.48-2.51
corrected). An arm given by its masses has three equal rows. An identified arm has a row of its own for each joint, and
then M is not symmetric. The loops of simulation and identification call these functions; for arrays use `dynamics`.

Index in a row (thesis number minus 1): 0-9 and 19 inertia, 10-15 viscous and Coulomb friction, 16-18 offsets.
"""

import math

import numpy as np

from ir50p_lab.jit import jit, numba


@jit()
def sincos(x):
    """Return sin x and cos x, right to the last bit or two for |x| up to a million rad.

    Compiled in line, several run at once: Cody-Waite reduction to [-pi/4, pi/4], then minimax polynomials (Moshier's
    Cephes coefficients).
    """
    k = np.rint(x * 0.6366197723675814)  # 2/pi
    y = ((x - k * 1.5707963267341256) - k * 6.077100506303966e-11) - k * 2.0222662487959506e-21
    z = y * y
    # fmt: off
    s = y + y * z * (-1.66666666666666307295e-1 + z * (8.33333333332211858878e-3 + z * (-1.98412698295895385996e-4
        + z * (2.75573136213857245213e-6 + z * (-2.50507477628578072866e-8 + z * 1.58962301576546568060e-10)))))
    c = 1.0 - 0.5 * z + z * z * (4.16666666666665929218e-2 + z * (-1.38888888888730564116e-3
        + z * (2.48015872888517045348e-5 + z * (-2.75573141792967388112e-7
        + z * (2.08757008419747316778e-9 + z * -1.13585365213876817300e-11)))))
    # fmt: on
    quadrant = np.int32(k)
    odd = (quadrant & 1) != 0
    s, c = (c if odd else s), (s if odd else c)
    return (-s if quadrant & 2 else s), (-c if (quadrant + 1) & 2 else c)


if numba is None:

    def sincos(x):
        """The same in plain Python, where the library's are quicker."""
        return (math.sin(x), math.cos(x)) if math.isfinite(x) else (math.nan, math.nan)


@jit()
def not_denormal(x):
    """Return x, or 0 if x is too small to matter: numbers below 1e-308 take the processor a hundred times as long."""
    return x if abs(x) > 1e-100 else 0.0


@jit()
def mass_terms(theta, c2, c3, c23):
    """Return M(q) as nine scalars by rows, M11 .. M33, kg m^2 (or PWM s^2/rad)    (list of 1.5.3a corrected)."""
    M11 = theta[0, 0] + theta[0, 1] * (c2 * c2) + theta[0, 4] * (c23 * c23) + 2 * theta[0, 5] * (c2 * c23)
    M12 = theta[0, 6] + theta[0, 7]
    M13 = theta[0, 7]
    M21 = theta[1, 6] + theta[1, 7]
    M22 = theta[1, 1] + theta[1, 4] + theta[1, 8] + theta[1, 9] + 2 * theta[1, 5] * c3
    M23 = theta[1, 4] + theta[1, 9] + theta[1, 5] * c3
    M31 = theta[2, 7]
    M32 = theta[2, 4] + theta[2, 9] + theta[2, 5] * c3
    M33 = theta[2, 4] + theta[2, 9] + theta[2, 19]
    return M11, M12, M13, M21, M22, M23, M31, M32, M33


@jit()
def coriolis_factors(theta, row, c2, s2, s3, c23, s23):
    """Return alpha = -dM11/dq2 / 2, beta = -dM11/dq3 / 2 and k = -dM23/dq3 from one row of theta    (1.93), (1.96)."""
    t2, t5, t6 = theta[row, 1], theta[row, 4], theta[row, 5]
    alpha = t2 * (s2 * c2) + t5 * (s23 * c23) + t6 * (s23 * c2 + c23 * s2)
    beta = t5 * (s23 * c23) + t6 * (s23 * c2)
    return alpha, beta, t6 * s3


@jit()
def coriolis_torques(theta, c2, s2, s3, c23, s23, a, b, c):
    """Return C(q, qd) qd as three scalars, with qd = (a, b, c)    (1.97) corrected: b233 = -k stands in row 2."""
    alpha1, beta1, _ = coriolis_factors(theta, 0, c2, s2, s3, c23, s23)
    alpha2, _, k2 = coriolis_factors(theta, 1, c2, s2, s3, c23, s23)
    _, beta3, k3 = coriolis_factors(theta, 2, c2, s2, s3, c23, s23)
    h1 = -2 * a * (alpha1 * b + beta1 * c)
    h2 = alpha2 * a * a - k2 * c * (2 * b + c)
    h3 = beta3 * a * a + k3 * b * b
    return h1, h2, h3


@jit()
def gravity_torques(theta, gravity, c2, c23):
    """Return g(q) of joints 2 and 3; joint 1 carries no weight    (1.114), grouping of 1.5.3c corrected."""
    g2 = gravity * (theta[1, 2] * c2 + theta[1, 3] * c23)
    return g2, gravity * theta[2, 3] * c23


@jit()
def sign(x):
    """Return the sign of x: -1, 0 or 1."""
    return 1.0 if x > 0 else (-1.0 if x < 0 else 0.0)


@jit()
def friction_torques(theta, a, b, c):
    """Return viscous and Coulomb friction and offset as three scalars, linear in theta    (1.115), (1.118)."""
    f1 = theta[0, 10] * a + theta[0, 11] * sign(a) + theta[0, 16]
    f2 = theta[1, 12] * b + theta[1, 13] * sign(b) + theta[1, 17]
    f3 = theta[2, 14] * c + theta[2, 15] * sign(c) + theta[2, 18]
    return f1, f2, f3


@jit()
def bias_torques(theta, gravity, q2, q3, a, b, c):
    """Return C qd + g + friction, and the cosines that M needs: (n1, n2, n3, c2, c3, c23)."""
    s2, c2 = sincos(q2)
    s3, c3 = sincos(q3)
    c23, s23 = c2 * c3 - s2 * s3, s2 * c3 + c2 * s3
    h1, h2, h3 = coriolis_torques(theta, c2, s2, s3, c23, s23, a, b, c)
    g2, g3 = gravity_torques(theta, gravity, c2, c23)
    f1, f2, f3 = friction_torques(theta, a, b, c)
    return h1 + f1, h2 + g2 + f2, h3 + g3 + f3, c2, c3, c23


@jit()
def inverse(theta, gravity, q2, q3, a, b, c, A, B, C):
    """Return the torques for the accelerations (A, B, C): M qdd + C qd + g + friction    (1.74)."""
    n1, n2, n3, c2, c3, c23 = bias_torques(theta, gravity, q2, q3, a, b, c)
    M11, M12, M13, M21, M22, M23, M31, M32, M33 = mass_terms(theta, c2, c3, c23)
    tau1 = M11 * A + M12 * B + M13 * C + n1
    tau2 = M21 * A + M22 * B + M23 * C + n2
    tau3 = M31 * A + M32 * B + M33 * C + n3
    return tau1, tau2, tau3


@jit()
def solve_mass(M, r1, r2, r3):
    """Solve M x = r, with M as nine scalars: return x1, x2, x3, and det M (0 or NaN if M is singular).

    By Cramer's rule, which loses no digits that matter for 3 x 3 inertia matrices (tested against LAPACK).
    """
    M11, M12, M13, M21, M22, M23, M31, M32, M33 = M
    if M12 == 0.0 and M13 == 0.0 and M21 == 0.0 and M31 == 0.0:
        minor = M22 * M33 - M23 * M32
        scale = 1 / minor  # a division takes as long as ten products
        return r1 / M11, (r2 * M33 - M23 * r3) * scale, (M22 * r3 - r2 * M32) * scale, M11 * minor
    minor = M22 * M33 - M23 * M32
    det = M11 * minor - M12 * (M21 * M33 - M23 * M31) + M13 * (M21 * M32 - M22 * M31)
    x1 = (r1 * minor - M12 * (r2 * M33 - M23 * r3) + M13 * (r2 * M32 - M22 * r3)) / det
    x2 = (M11 * (r2 * M33 - M23 * r3) - r1 * (M21 * M33 - M23 * M31) + M13 * (M21 * r3 - r2 * M31)) / det
    x3 = (M11 * (M22 * r3 - r2 * M32) - M12 * (M21 * r3 - r2 * M31) + r1 * (M21 * M32 - M22 * M31)) / det
    return x1, x2, x3, det


@jit()
def forward(theta, gravity, q2, q3, a, b, c, u1, u2, u3):
    """Return the accelerations for the torques u, M^-1 (u - C qd - g - friction), and det M."""
    n1, n2, n3, c2, c3, c23 = bias_torques(theta, gravity, q2, q3, a, b, c)
    return solve_mass(mass_terms(theta, c2, c3, c23), u1 - n1, u2 - n2, u3 - n3)
