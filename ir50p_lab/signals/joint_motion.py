"""From the motion of the tip to the motion of the joints on one branch of the inverse kinematics, compiled."""

import math

from ir50p_lab.jit import jit


@jit()
def joint_motion(l1, l2, l3, side, elbow, p, v, a, near, rows):
    """Fill rows (n, 3, 3) with q, qd, qdd for tip positions p, velocities v, accelerations a, (n, 3) each, SI.

    side: 1 front, -1 back; elbow: -1 up, 1 down; near (n, 3): rad, decides the turn in which each angle is given.
    In the vertical plane of the arm, rho = l2 c2 + l3 c23 along it and z up, Jv falls into rho (joint 1) and a 2x2
    block with determinant l2 l3 s3; what is left of the acceleration at qdd = 0 is Jvd qd.
    """
    for k in range(p.shape[0]):
        x, y, z = p[k, 0], p[k, 1], p[k, 2] - l1
        delta = side * math.hypot(x, y)
        r = math.hypot(delta, z)
        inner = math.sqrt(max(0.0, (r - abs(l2 - l3)) * (r + abs(l2 - l3))))
        outer = math.sqrt(max(0.0, (l2 + l3 - r) * (l2 + l3 + r)))
        q3 = elbow * 2 * math.atan2(outer, inner)
        q1 = math.atan2(side * y, side * x)
        q2 = math.atan2(z, delta) - math.atan2(l3 * math.sin(q3), l2 + l3 * math.cos(q3))
        c1, s1, c2, s2 = math.cos(q1), math.sin(q1), math.cos(q2), math.sin(q2)
        c23, s23 = math.cos(q2 + q3), math.sin(q2 + q3)
        rho, det = l2 * c2 + l3 * c23, l2 * l3 * math.sin(q3)

        along, across, up = c1 * v[k, 0] + s1 * v[k, 1], c1 * v[k, 1] - s1 * v[k, 0], v[k, 2]
        w1 = across / rho
        w2 = l3 * (c23 * along + s23 * up) / det  # of the upper arm against the horizontal
        w23 = -l2 * (c2 * along + s2 * up) / det  # of the forearm
        rho_d = -l2 * s2 * w2 - l3 * s23 * w23

        bend_along = -l2 * c2 * w2 * w2 - l3 * c23 * w23 * w23 - rho * w1 * w1
        bend_up = -l2 * s2 * w2 * w2 - l3 * s23 * w23 * w23
        along = c1 * a[k, 0] + s1 * a[k, 1] - bend_along
        across = c1 * a[k, 1] - s1 * a[k, 0] - 2 * rho_d * w1
        up = a[k, 2] - bend_up
        a1 = across / rho
        a2 = l3 * (c23 * along + s23 * up) / det
        a23 = -l2 * (c2 * along + s2 * up) / det

        turn = 2 * math.pi
        rows[k, 0, 0] = q1 + turn * round((near[k, 0] - q1) / turn)
        rows[k, 0, 1] = q2 + turn * round((near[k, 1] - q2) / turn)
        rows[k, 0, 2] = q3 + turn * round((near[k, 2] - q3) / turn)
        rows[k, 1, 0], rows[k, 1, 1], rows[k, 1, 2] = w1, w2, w23 - w2
        rows[k, 2, 0], rows[k, 2, 1], rows[k, 2, 2] = a1, a2, a23 - a2
