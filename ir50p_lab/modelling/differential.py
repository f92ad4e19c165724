"""Differential kinematics: the geometric Jacobian, manipulability, singular poses (1.32)-(1.55)."""

from dataclasses import dataclass

import numpy as np

from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import JOINTS, frames


def jacobian(arm, q):
    """Geometric Jacobian of the tip in base coordinates: [v; omega] = J qd    (1.43), (1.46)-(1.54 corrected)

    Column i is [z_{i-1} x (p - o_{i-1}); z_{i-1}]: joint i turns about z of the frame before it, so that (1.34)
    and (1.37) need the index shifted by one.

    Args: arm: Arm; q: (3,) or (n, 3) rad.
    Returns: (6, 3) or (n, 6, 3); rows 0-2 in m/rad (Jv), rows 3-5 without unit (Jw).
    """
    T = frames(arm, q)
    z = T[..., :JOINTS, :3, 2]
    arms = T[..., JOINTS, None, :3, 3] - T[..., :JOINTS, :3, 3]
    J = np.empty((*T.shape[:-3], 6, JOINTS))
    for row, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):  # z x arms; np.cross takes as long as all the rest
        J[..., row, :] = z[..., i] * arms[..., j] - z[..., j] * arms[..., i]
        J[..., 3 + row, :] = z[..., row]
    return J


def manipulability(arm, q):
    """Yoshikawa's measure |det Jv| = l2 l3 |s3 (l2 c2 + l3 c23)|, (…,) in m^3: 0 in a singular pose.

    It is the volume of the ellipsoid of tip velocities for unit joint rates, up to the factor 4 pi / 3.
    """
    return np.abs(_det_jv(arm, q))


def _det_jv(arm, q):
    _, q2, q3 = np.moveaxis(vectors3("q", q), -1, 0)
    _, l2, l3 = arm.l
    return -l2 * l3 * np.sin(q3) * (l2 * np.cos(q2) + l3 * np.cos(q2 + q3))


@dataclass(frozen=True)
class Singularity:
    """How near a pose is to losing a direction of motion.

    det: determinant of Jv, m^3. elbow: sin q3 (0: stretched or folded). shoulder: tip distance from the
    vertical axis, m, with sign (0: joint 1 no longer moves the tip). smallest: smallest singular value of Jv,
    m/rad: slowest tip speed per unit joint rate. direction: (…, 3) unit vector in which that happens.
    """

    det: np.ndarray
    elbow: np.ndarray
    shoulder: np.ndarray
    smallest: np.ndarray
    direction: np.ndarray


def singularity(arm, q):
    """Nearness to the singular poses: elbow stretched or folded (q3 = 0, pi), or tip on the vertical axis.

    Args: arm: Arm; q: (3,) or (n, 3) rad. Returns: Singularity.
    """
    q = vectors3("q", q)
    U, S, _ = np.linalg.svd(jacobian(arm, q)[..., :3, :])
    _, l2, l3 = arm.l
    return Singularity(
        det=_det_jv(arm, q),
        elbow=np.sin(q[..., 2]),
        shoulder=l2 * np.cos(q[..., 1]) + l3 * np.cos(q[..., 1] + q[..., 2]),
        smallest=S[..., -1],
        direction=U[..., :, -1],
    )
