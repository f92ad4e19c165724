"""What the thesis prints in 2.1, as code: mistakes included.

Only for A1 and its tests. For control use `ir50p_lab.controllers`.
"""

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


def error_2_7(q_ref, q):
    """(2.7), e = q_ref + q. Wrong: a sum is no error; (2.16) to (2.20) need e = q - q_ref."""
    return q_ref + q


def error_2_4(q_ref, q):
    """(2.4), e = q_ref - q. Right for the PID of (2.3), wrong in (2.19): the loop is unstable with it."""
    return q_ref - q
