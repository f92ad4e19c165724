"""The 20 parameters by name, and which of them act on which joint (thesis 2.50, 2.51 corrected).

For an in-line arm (`Arm.theta`), masses and inertias in kg, m; times 1/K_i in PWM counts:

    theta1   j1 + Izz1 + Ixx2 + Ixx3
    theta2   m2 lc2^2 + m3 l2^2 + Iyy2 - Ixx2
    theta3   m2 lc2 + m3 l2
    theta4   m3 lc3
    theta5   m3 lc3^2 + Iyy3 - Ixx3
    theta6   m3 lc3 l2 = l2 theta4
    theta7   Iyz2, 0 for every rigid body
    theta8   Iyz3, 0 for every rigid body
    theta9   Izz2 - Iyy2 + Ixx2 + j2
    theta10  Izz3 - Iyy3 + Ixx3
    fv1      viscous friction of joint 1
    fc1      Coulomb friction of joint 1
    fv2      viscous friction of joint 2
    fc2      Coulomb friction of joint 2
    fv3      viscous friction of joint 3
    fc3      Coulomb friction of joint 3
    Tf1      offset of joint 1
    Tf2      offset of joint 2
    Tf3      offset of joint 3
    j3       rotor inertia of joint 3 (theta20)
"""

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number

NAMES = (*(f"theta{k}" for k in range(1, 11)), *"fv1 fc1 fv2 fc2 fv3 fc3 Tf1 Tf2 Tf3 j3".split())
OFFSETS = ("Tf1", "Tf2", "Tf3")
ONLY_THESIS = ("theta7", "theta8")  # constant products of inertia: left out of a fit unless asked for
FREE_OF_SIGN = (*OFFSETS, *ONLY_THESIS)  # all others are >= 0 for a body and its friction

# columns that can differ from zero in each joint's row: 9, 12 and 9 of the 20
ACTS_ON = ((0, 1, 4, 5, 6, 7, 10, 11, 16), (1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 13, 17), (3, 4, 5, 7, 9, 14, 15, 18, 19))
RIGID_ON = tuple([k for k in acting if NAMES[k] not in ONLY_THESIS] for acting in ACTS_ON)  # without theta7, theta8
COLUMNS = {"rigid": [k for k in range(20) if NAMES[k] not in ONLY_THESIS], "thesis": list(range(20))}


def metres(name, value):
    """Return `value` as a float > 0. Raises InputError, also for a length beyond that of any arm."""
    if number(name, value, "> 0", unit="m") > 10:
        raise InputError(f"{name} = {value} m is longer than 10 m: is it in millimetres? Give metres")
    return float(value)
