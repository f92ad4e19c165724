"""Where the millimetres go: the error of a reach, cause by cause, after one look and after two."""

import numpy as np

from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.modelling.differential import jacobian
from ir50p_lab.vision.reaching.moving import ACCEPTED

_READINGS = 100  # readings averaged at rest: a second at 100 Hz


def error_budget(arm, locator, q, *, sigma_q, slope, sigma_ball_px=0.15, sigma_marker_px=0.15, noise=1.0):
    """Predict the rms error of a reach that ends in the pose q, to first order.

    With J = dp/dq of the tip, H = dpixel/dq of the marker, and the gain G of the camera's correction
    (`BallLocator.joint_errors`), potentiometers that are off by e leave J e after the first look and J (I - G H) e
    after the second. Errors in the camera's calibration or place are left out: they shift ball and hand alike, so that
    little of them remains after the second look.

    Args: arm: Arm; locator: BallLocator; q: (3,) rad, pose above the ball; sigma_q: (3,) rad, standard deviation of the
    potentiometers' smooth errors; slope: (3,) counts/rad; sigma_ball_px, sigma_marker_px: px, of found centres; noise:
    counts rms of a reading before rounding.
    Returns: pandas.DataFrame of rms distances at the tip, m, one row for each cause, columns "one look" and "two
    looks". The causes are independent, so their squares add; the last row is "all together".
    """
    import pandas as pd

    J, P = jacobian(arm, q)[:3], np.diag(np.square(sigma_q))
    tip = forward_kinematics(arm, q)
    H = locator.marker_jacobian(arm, q)
    G = np.linalg.solve(H @ P @ H.T + locator.sigma_px**2 * np.eye(2), H @ P).T
    left = np.eye(3) - G @ H

    xy, height = locator.to_image([*tip[:2], locator.radius]), locator.radius
    steps = [locator.plane.to_table(xy + d, height) - locator.plane.to_table(xy - d, height) for d in 0.5 * np.eye(2)]
    pixel = sigma_ball_px * _rms(np.array(steps))
    reading = np.diag(np.sqrt(noise**2 + 1 / 12) / np.sqrt(_READINGS) / np.abs(slope))
    rest = ACCEPTED * np.sqrt(0.6)  # rms distance of points spread evenly over a ball of that radius
    noisy = _rms(J @ reading)
    causes = {
        "ball in the picture": (pixel, pixel / np.sqrt(2)),
        "marker in the picture": (0.0, _rms(sigma_marker_px * J @ G)),
        "potentiometers: bent, off, mis-scaled": (_rms(J * sigma_q), _rms(J @ left * sigma_q)),
        "potentiometers: noise, rounding": (noisy, np.hypot(noisy, _rms(J @ G @ H @ reading))),
        "standing still: friction, play of gears": (rest, rest),
    }
    budget = pd.DataFrame.from_dict(causes, orient="index", columns=["one look", "two looks"])
    budget.loc["all together"] = np.sqrt((budget**2).sum())
    return budget


def _rms(matrix):
    """rms length of matrix @ n for independent unit n."""
    return float(np.sqrt(np.sum(np.square(matrix))))
