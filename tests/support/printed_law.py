"""Computed torque with the equations as the thesis prints them: how much worse is it than with right ones?

M and C as 1.5.3 prints them, G as (2.48) does, with the parameters of 2.1.2. The matrix c2(q) is lost in the scan; its
entries are those printed one by one (2 b_ijk).
"""

from functools import cache

import numpy as np
from sympy import Matrix, Symbol, lambdify, symbols

from ir50p_lab.course.printed import dynamics as printed
from ir50p_lab.course.printed.control import PARAMETERS_2_1_2

#: The values printed at the end of each line, in terms of the M_ijk; the halves before them do not fit.
TWICE_B = {
    "112": "112",
    "113": "113",
    "223": "223",
    **dict.fromkeys("212 213 312 123 323 313".split(), 0),
}
_arm2, _arm3 = printed.lc2 * printed.c2, printed.lc3 * printed.c23
G_2_48 = printed.g * Matrix([0, printed.m2 * _arm2 + printed.m3 * (_arm2 + _arm3), printed.m3 * _arm3])


@cache
def _compiled():
    """The torque as a function of nine numbers: q, qd, qdd."""
    doubled = {name: printed.DM[of] if of else 0 for name, of in TWICE_B.items()}
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


class PrintedLaw:
    """(2.19) on them, sampled; a controller as any other. kp, kd: (3,); period: s."""

    unit = "N m"

    def __init__(self, kp, kd, *, period):
        self.kp, self.kd, self.period = np.array(kp, dtype=float), np.array(kd, dtype=float), period
        self.reset()

    def reset(self):
        self.last = None

    def step(self, t, measured, reference):
        """The first sample knows no velocity and takes that of the reference."""
        q_ref, qd_ref, qdd_ref = reference
        error, velocity, rate = measured - q_ref, qd_ref, np.zeros(3)
        if self.last is not None:
            velocity, rate = (measured - self.last[0]) / self.period, (error - self.last[1]) / self.period
        self.last = measured, error
        return np.array(_compiled()(*measured, *velocity, *(qdd_ref - self.kd * rate - self.kp * error)))
