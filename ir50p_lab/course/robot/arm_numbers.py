"""An arm handed over as plain numbers and arrays, in the form in which the student's own functions take it."""

from collections import namedtuple

import numpy as np

from ir50p_lab.modelling.arm import Arm


class Parts(namedtuple("Parts", "l m lc inertia rotor fv fc fs qs offset gain damping g limits")):
    """The numbers of an arm. Its arrays are copies: changing them changes no arm.

    ======== ======================================================================= ==================
    field    meaning                                                                 shape, unit
    ======== ======================================================================= ==================
    l        column height, upper arm, forearm                                       (3,) m
    m        masses of the links                                                     (3,) kg
    lc       centre of mass, from the link's joint along the link                    (3,) m
    inertia  about the centre of mass, in the axes of DH frame i at the link's end   (3, 3, 3) kg m^2
    rotor    inertia of the motors behind their gears, N^2 Jm                        (3,) kg m^2
    fv       viscous friction                                                        (3,) N m s/rad
    fc, fs   Coulomb and breakaway torque                                            (3,) N m
    qs       Stribeck velocity                                                       (3,) rad/s
    offset   constant friction offset                                                (3,) N m
    gain     torque per PWM count                                                    (3,) N m
    damping  back-EMF, by which a driven motor brakes itself                         (3,) N m s/rad
    g        gravitational acceleration                                              m/s^2
    limits   lowest and highest joint angles                                         (2, 3) rad
    ======== ======================================================================= ==================
    """


def parts(arm: Arm) -> Parts:
    """Return the numbers of an arm as the student's functions take them.

    `Arm` measures link 1 with z along the column and link 3 with z along its joint. The DH frames at the ends of these
    links have y there (alpha = +90 and -90 deg), so that Iyy and Izz of links 1 and 3 are exchanged.

    An arm without motors has rotors and back-EMF 0, and gain nan. Returns: Parts.
    """
    motors = arm.actuators
    rotor, gain, damping = np.zeros(3), np.full(3, np.nan), np.zeros(3)
    if motors is not None:
        rotor, gain, damping = map(np.array, (motors.reflected_inertia, motors.gain, motors.back_emf_damping))
    diagonals = np.column_stack([arm.Ixx, arm.Iyy, arm.Izz])
    diagonals[[0, 2]] = diagonals[[0, 2]][:, [0, 2, 1]]
    friction = arm.friction
    return Parts(
        l=np.array(arm.l),
        m=np.array(arm.m),
        lc=np.array(arm.lc),
        inertia=np.array([np.diag(row) for row in diagonals]),
        rotor=rotor,
        fv=np.array(friction.fv),
        fc=np.array(friction.fc),
        fs=np.array(friction.fs),
        qs=np.array(friction.qs),
        offset=np.array(friction.Tf),
        gain=gain,
        damping=damping,
        g=arm.g,
        limits=np.array([arm.q_min, arm.q_max]),
    )
