"""What the thesis prints in 2.1.2 and 4.4, as code: mistakes included.

Only for the 'Thesis check' cells of notebook 14 and their tests. For control use `ir50p_lab.controllers`.
"""

from functools import cache

import numpy as np
from sympy import Matrix, Symbol, lambdify, symbols

from ir50p_lab.course.printed import dynamics as printed
from ir50p_lab.modelling import coriolis_matrix

# 2.1.2: kg, m, kg m^2. Wrong: centres of mass 2.5 link lengths out; Iyy2 = Izz2 = Iyz2 is the tensor of a thin rod at
# 45 degrees; "L" is L2.
PARAMETERS_2_1_2 = {
    "m": (3, 1, 1),
    "l": (0.2, 0.2, 0.2),
    "lc": (0.5, 0.5, 0.5),
    "Izz": (0.05, 0.05, 0.05),
    "Iyy": (0.0, 0.05, 0.05),
    "Iyz": (0.0, 0.05, 0.0),
}

# (2.48), gravity. Wrong: lc2 for l2 in the share of link 3 (and 1.5.3c multiplies the two terms)
_arm2, _arm3 = printed.lc2 * printed.c2, printed.lc3 * printed.c23
G_2_48 = printed.g * Matrix([0, printed.m2 * _arm2 + printed.m3 * (_arm2 + _arm3), printed.m3 * _arm3])


def error_2_7(q_ref, q):
    """(2.7), e = q_ref + q. Wrong: a sum is no error; (2.16) to (2.20) need e = q - q_ref."""
    return q_ref + q


def error_2_4(q_ref, q):
    """(2.4), e = q_ref - q. Right for the PID of (2.3), wrong in (2.19): the loop is unstable with it."""
    return q_ref - q


def error_2_19(q_ref, q):
    """Below (2.19), e = x - x_d. Right."""
    return q - q_ref


def coriolis_as_in_2_6(arm, q, qd):
    """C(q, qd) q as (2.6) prints it, and C(q, qd) qd as it must be: two (3,) N m."""
    C = coriolis_matrix(arm, q, qd)
    return C @ q, C @ qd


class LawWithError:
    """(2.19) with any of the errors above and true inverse dynamics, sampled in Python; a controller as any other.

    Args: inverse_dynamics: function (q, qd, v) -> N m; kp, kd (3,); error: function (q_ref, q); period: s.
    """

    unit = "N m"

    def __init__(self, inverse_dynamics, kp, kd, error, *, period):
        self.inverse, self.error, self.period = inverse_dynamics, error, period
        self.kp, self.kd = np.array(kp, dtype=float), np.array(kd, dtype=float)
        self.reset()

    def reset(self):
        """Forget the past."""
        self.last = None

    def step(self, t, measured, reference):
        """The command for one sample, (3,) N m; the first sample knows no velocity and takes that of the reference."""
        q_ref, qd_ref, qdd_ref = reference
        e, velocity, rate = self.error(q_ref, measured), qd_ref, np.zeros(3)
        if self.last is not None:
            velocity = (measured - self.last[1]) / self.period
            rate = (e - self.last[0]) / self.period
        self.last = e, measured
        return self.inverse(measured, velocity, qdd_ref - self.kd * rate - self.kp * e)


@cache
def _compiled():
    """The torque as printed, with the parameters of 2.1.2, as a function of nine numbers: q, qd, qdd."""
    doubled = {name: printed.DM[of] if of else 0 for name, of in printed.TWICE_B.items()}
    a, b, c = printed.qd
    qdd = symbols("qddot1:4", real=True)
    c2 = Matrix(3, 3, [doubled[f"{i}{jk}"] for i in (1, 2, 3) for jk in (12, 13, 23)])
    h = printed.C1 * Matrix([a**2, b**2, c**2]) + c2 * Matrix([a * b, a * c, b * c])
    numbers = {printed.g: 9.81}
    for name, values in PARAMETERS_2_1_2.items():
        for link, value in enumerate(values, start=1):
            numbers[Symbol(f"{name}{link}", real=True)] = value
    torque = (printed.M_LIST * Matrix(qdd) + h + G_2_48).subs(numbers)
    return lambdify([*printed.q, *printed.qd, *qdd], list(torque), "numpy", cse=True)


def inverse_dynamics_as_printed(q, qd, qdd):
    """M qdd + C qd + G of the arm of 2.1.2, M and C as 1.5.3 and G as (2.48) print them, N m (3,). Wrong as they are.

    The matrix c2(q) is lost in the scan; its entries are those printed one by one (2 b_ijk).
    """
    return np.array(_compiled()(*q, *qd, *qdd))
