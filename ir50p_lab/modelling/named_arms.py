"""The arms of the course: the real one, with its assumptions, and the thesis's models."""

import dataclasses

import numpy as np

from ir50p_lab.home import path_setting
from ir50p_lab.modelling.actuators import Actuators
from ir50p_lab.modelling.arm import Arm, read_only
from ir50p_lab.modelling.friction import Friction

_DEG = np.pi / 180


def _drive(stall_torque, no_load_speed):
    """Motors and dry friction as fields of an Arm, from torque (N m) and speed (rad/s) at the joints, on 12 V.

    12 V is the supply of thesis 4.1.2 (the motors are 24 V ones); a 24 V drive doubles both.
    """
    K = np.array(stall_torque) / 255  # N m per PWM count
    friction = Friction(
        # Assumed: all speed-dependent loss is the motors' back-EMF, so none is left here.
        fv=(0.0, 0.0, 0.0),
        # Assumed, given in PWM counts at 12 V: Coulomb 18, 16, 16; breakaway 36, 22, 22; offset 4, -3, 2.
        fc=np.array([18.0, 16.0, 16.0]) * K,
        fs=np.array([36.0, 22.0, 22.0]) * K,
        qs=(0.05, 0.05, 0.05),
        Tf=np.array([4.0, -3.0, 2.0]) * K,
    )
    motors = Actuators.from_joint_data(
        stall_torque=stall_torque,
        no_load_speed=no_load_speed,
        reflected_inertia=(0.15, 0.20, 0.12),
        # Assumed: only N^2 Jm and N kt matter at the joint; 100 is usual for such an arm.
        N=(100.0, 100.0, 100.0),
        V=12.0,
    )
    return {"friction": friction, "actuators": motors}


# The thesis gives neither masses nor motors of the IR50P. What is not sourced is an assumption, chosen so that
# identification lands near the thesis's Table 4.4; nothing here was measured on an IR50P.
IR50P = Arm(
    name="IR50P",
    # Source: published code of a sister arm (IR52c): shoulder height 285, links 200 and 200 mm, hand 172 mm.
    l=(0.285, 0.200, 0.372),
    # Assumed: a 13 kg machine (ROB3i manual) carries most of it in the base; thin-walled aluminium links.
    m=(3.0, 1.0, 0.8),
    # Assumed: a little before the middle of each link, the motors sit near the joints.
    lc=(0.10, 0.09, 0.17),
    # Assumed: slender links (about m l^2/12 across, much less along); link 1 as a small column.
    Ixx=(0.03, 0.0006, 0.0006),
    Iyy=(0.03, 0.0035, 0.0085),
    Izz=(0.02, 0.0035, 0.0085),
    # Assumed: stall torque and no-load speed.
    **_drive(stall_torque=(4.0, 7.0, 6.0), no_load_speed=(2.5, 1.1, 1.3)),
    # Assumed: the ROB3i manual gives 200 deg of travel, not where. Chosen so that the thesis's set points fit.
    q_min=(-100 * _DEG, -50 * _DEG, -140 * _DEG),
    q_max=(100 * _DEG, 110 * _DEG, 30 * _DEG),
)

# The same arm with a weaker, faster motor in joint 1: the unit whose shoulder oscillates about its set point as in
# Figure 4.8. Assumed and chosen for that; friction is the same in PWM counts, so in N m it follows its own motors.
IR50P_WEAK_SHOULDER = dataclasses.replace(
    IR50P,
    name="IR50P weak shoulder",
    **_drive(stall_torque=(2.5, 9.0, 9.0), no_load_speed=(3.0, 1.1, 1.3)),
)

# Thesis 2.1.1: l = 1 m, m = (3, 1, 1) kg, lc = 0.5 m, no inertias. The thesis puts the centre of mass of the
# column beside its axis (p_c1), which adds m1 lc1^2 = 0.75 kg m^2 to M11; kept here as inertia of the column.
THESIS_A = Arm(
    name="thesis 2.1.1, point masses (model A)",
    l=(1.0, 1.0, 1.0),
    m=(3.0, 1.0, 1.0),
    lc=(0.5, 0.5, 0.5),
    Ixx=(0.75, 0.0, 0.0),
    Iyy=(0.75, 0.0, 0.0),
    Izz=(0.75, 0.0, 0.0),
)

# The same lengths and masses as slender uniform rods: I = m l^2 / 12 across, 0 along the rod.
THESIS_RODS = dataclasses.replace(
    THESIS_A,
    name="thesis 2.1.1, slender rods (model B)",
    Ixx=(3 / 12, 0.0, 0.0),
    Iyy=(3 / 12, 1 / 12, 1 / 12),
    Izz=(0.0, 1 / 12, 1 / 12),
)


# Thesis 2.1.2: l = 0.2 m with lc = 0.5 m (2.5 link lengths out: a misprint it seems), Izz = Iyy = Iyz2 = 0.05.
# The thesis takes inertias that stay constant in a frame that turns with joint 1 only. With the product Iyz that is no
# rigid body, so it exists as theta only, to reproduce its figures: m1 lc1^2 + sum Izz, m2 lc2^2 + m3 l2^2, ...
_INERTIAL = (0.90, 0.29, 0.70, 0.50, 0.25, 0.10, 0.05, 0.0, 0.05, 0.05)
THESIS_C = read_only(np.tile([*_INERTIAL, *[0.0] * 10], (3, 1)))


def load_arm(path=None):
    """Return the arm of the course: from the file `path`, else from the file that $IR50P_ARM names, else the IR50P.

    Raises ArmError if the file cannot be read as an arm.
    """
    path = path or path_setting("IR50P_ARM")
    return Arm.load(path) if path else IR50P
