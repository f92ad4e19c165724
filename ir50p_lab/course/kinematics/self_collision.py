"""What no end stop forbids: poses that go through the column of the arm."""

from ir50p_lab.modelling.chain import frames


def through_column(arm, q):
    """Return True if the forearm in a pose (3,) rad goes through the axis of the arm's own column."""
    elbow, tip = frames(arm, [0.0, q[1], q[2]])[2:, [0, 2], 3]
    if elbow[0] * tip[0] >= 0:
        return False  # both on the same side of it
    height = elbow[1] + (tip[1] - elbow[1]) * elbow[0] / (elbow[0] - tip[0])
    return bool(height < arm.l[0])
