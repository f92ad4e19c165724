"""What an arm may be asked for: every reference, set point and push is checked here before the arm is driven there."""

import math

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import vector3, whole
from ir50p_lab.modelling.chain import frames

FARTHEST = 2.0  # rad: a reference farther from the measured pose is refused
MOST_PUSH = 10.0  # N: a hand that tests an arm pushes no harder
NOBODY = 3, np.zeros(3), np.zeros(3)  # the push of a hand that lets go
_UNKNOWN = (math.nan,) * 3  # an unmeasured pose: every comparison with it is false
NOISE = 0.05  # rad: an arm at an end of its travel may be measured so far beyond it


def checked_reference(arm, t, value, q=None):
    """Return the value of a reference at t as rows q, qd, qdd (3, 3). Raise InputError if the arm must not go there.

    Its angles must be finite, within the joint limits (or up to where the arm stands, if that is beyond them) and not
    farther than 2 rad from the measured q (3,) rad; q None: not measured yet.
    """
    try:
        rows = np.asarray(value, dtype=float)
    except Exception:
        rows = np.empty(0)
    if rows.shape != (3, 3) or not np.isfinite(rows).all():
        given = f"the reference gives {value!r:.100} at t = {t:.3f} s"
        raise InputError(f"{given}: give (q, qd, qdd), each (3,) and finite")
    for i, (wanted, here) in enumerate(zip(rows[0].tolist(), _UNKNOWN if q is None else q.tolist(), strict=True)):
        within = min(arm.q_min[i], here - NOISE) - 1e-9 <= wanted <= max(arm.q_max[i], here + NOISE) + 1e-9
        if within and not abs(wanted - here) > FARTHEST:
            continue
        said = f"the reference of joint {i + 1} is {wanted:.4g} rad at t = {t:.3f} s"
        if not within:
            said += f"; the arm's travel is {arm.q_min[i]:.2f} to {arm.q_max[i]:.2f} rad"
            raise InputError(f"{said}. Are these degrees? np.radians makes them rad")
        said += f", {abs(wanted - here):.2f} rad from where the arm is ({here:.2f} rad); {FARTHEST:g} rad is the most"
        raise InputError(f"{said}. Degrees? Begin where the arm is, as bench.start does; if it strayed, run bench-test")
    return rows


def checked_pose(name, arm, q, table=0.0):
    """Return a pose q (3,) rad as an array. Raise InputError if it is beyond the travel of the arm or below the table.

    table: its height, m.
    """
    q = vector3(name, q)
    outside = (q < arm.q_min) | (q > arm.q_max)
    if outside.any():
        i = np.argmax(outside)
        low, high = np.degrees([arm.q_min[i], arm.q_max[i]])
        raise InputError(f"{name} of joint {i + 1} is {q[i]:.3f} rad; the arm's travel is {low:.0f} to {high:.0f} deg")
    height = float(frames(arm, q)[2:, 2, 3].min()) - table
    if height < -1e-9:
        place = f"{name} {np.degrees(q).round().tolist()} deg"
        raise InputError(f"{place} lies {-100 * height:.0f} cm below the table: raise joint 2 or joint 3")
    return q


def checked_push(link, point, force):
    """Return link (1 to 3), point (3,) m and force (3,) N, the force reduced to MOST_PUSH.

    Raises InputError for anything else.
    """
    point, force = vector3("point", point, unit="m"), vector3("force", force, unit="N")
    return whole("link", link, 1, 3), point, force * min(1.0, MOST_PUSH / max(np.linalg.norm(force), MOST_PUSH))
