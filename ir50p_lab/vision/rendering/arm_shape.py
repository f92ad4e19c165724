"""The arm as a camera sees it: thick links along the frames of the kinematic chain, joints, a gripper."""

import numpy as np

from ir50p_lab.vision.rendering.scene import Stick

# Assumed, m: what is left of an ER V-like arm when it is looked at with half-closed eyes.
BASE, SHOULDER, UPPER, FORE, FINGER = 0.06, 0.045, 0.030, 0.022, 0.007
PAINT, JOINT = (212, 208, 200), (70, 72, 76)
GRIP = 0.06  # length of the fingers; the tip of the kinematic chain is between their ends


def arm_sticks(q, arm, *, opening=0.07):
    """The arm at q (3,) rad as Sticks: column, links, wrist and two fingers `opening` m apart, in base coordinates.

    arm: Arm. Raises InputError for a wrong q.
    """
    from ir50p_lab.modelling import frames

    T = frames(arm, q)
    base, shoulder, elbow, tip = (T[i, :3, 3] for i in range(4))
    along, sideways = T[3, :3, 0], T[2, :3, 2]
    wrist = tip - along * min(GRIP + FORE, 0.5 * np.linalg.norm(tip - elbow))
    aside = sideways * opening / 2
    return (
        _stick(base, shoulder, BASE, PAINT),
        _stick(shoulder - sideways * SHOULDER, shoulder + sideways * SHOULDER, SHOULDER, JOINT),
        _stick(shoulder, elbow, UPPER, PAINT),
        _stick(elbow - sideways * UPPER, elbow + sideways * UPPER, 1.15 * UPPER, JOINT),
        _stick(elbow, wrist, FORE, PAINT),
        _stick(wrist - aside, wrist + aside, 1.3 * FINGER, JOINT),
        _stick(wrist - aside, tip - aside, FINGER, JOINT),
        _stick(wrist + aside, tip + aside, FINGER, JOINT),
    )


def _stick(start, end, radius, colour):
    return Stick(start=tuple(start), end=tuple(end), radius=radius, colour=colour, gloss=0.15)
