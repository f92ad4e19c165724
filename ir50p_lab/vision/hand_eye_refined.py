"""Camera, board and potentiometers fitted together: least squares of the reprojection error over arm poses."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.inputs import number, numbers, vectors3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.vision.board_pose import camera_numbers, checked_transform, inverse_transform, rvec_tvec, transform
from ir50p_lab.vision.pinhole import distort_xy

JOINT_TERMS = tuple(f"{kind}{joint}" for kind in ("offset", "slope", "bow") for joint in (1, 2, 3))
_WEAK = 1e-6  # ratio of singular values below which a direction cannot be told
_WHY = {
    "offset1": "a turn of the camera about the column explains the same: give known_T_base_cam, from a board whose "
    "place on the table is known",
    "offset3": "a turn of the board in the hand explains the same: give known_T_tool_board, measured in the gripper",
}


@dataclass(frozen=True, eq=False)
class JointCorrection:
    """Angle of the arm for an angle of the potentiometers: q + offset + slope v + bow (1 - v^2), rad, per joint.

    v = (q - middle)/half runs from -1 to 1 over the travel. `terms`: name ('offset1' .. 'bow3') -> rad.
    """

    middle: np.ndarray
    half: np.ndarray
    terms: dict

    @classmethod
    def of(cls, arm, terms=()):
        """For an arm's travel (a joint without limits: -pi to pi); terms: name -> rad, the others are zero."""
        low, high = (np.clip(limit, -np.pi, np.pi) for limit in (arm.q_min, arm.q_max))
        unknown = set(terms) - set(JOINT_TERMS)
        if unknown:
            raise InputError(f"terms {sorted(unknown)}: choose among {', '.join(JOINT_TERMS)}")
        return cls(0.5 * (low + high), 0.5 * (high - low), dict(terms))

    def __call__(self, q):
        """True angles of measured ones, (3,) or (n, 3) rad."""
        return q + self._shift(q)

    def back(self, q):
        """Angles that the potentiometers show at true angles, (3,) or (n, 3) rad."""
        q = np.asarray(q, dtype=float)
        shown = q - self._shift(q)
        for _ in range(3):  # the shift is small and smooth: each round gains two digits
            shown = q - self._shift(shown)
        return shown

    def _shift(self, q):
        if not self.terms:
            return np.zeros(np.shape(q))
        v = (np.asarray(q, dtype=float) - self.middle) / self.half
        shapes = np.stack([np.ones_like(v), v, 1 - v * v])
        return np.einsum("kj,k...j->...j", self._table, shapes)

    @cached_property
    def _table(self):
        return np.array([self.terms.get(name, 0.0) for name in JOINT_TERMS]).reshape(3, 3)


@dataclass(frozen=True, eq=False)
class RefinedHandEye:
    """Result of `refine_hand_eye`.

    ============= ========================================================================= ================
    T_base_cam    takes camera coordinates to base coordinates                              (4, 4)
    T_tool_board  board to tool coordinates                                                 (4, 4)
    correction    JointCorrection: what the potentiometers are off by
    stderr        of each fitted term                                                       name -> rad
    covariance    of a small turn and shift of the camera, in camera coordinates, with      (6, 6) rad, m
                  the turn about the column that a constant error of joint 1 would hide
    joint_errors  what is left of each reading: scatter of the potentiometers               (n, 3) rad
    pose_rms      of the corners of each pose, seen minus model                             (n,) px
    ============= ========================================================================= ================
    """

    T_base_cam: np.ndarray
    T_tool_board: np.ndarray
    correction: JointCorrection
    stderr: dict
    covariance: np.ndarray = field(repr=False)
    joint_errors: np.ndarray = field(repr=False)
    pose_rms: np.ndarray = field(repr=False)

    @property
    def camera_stderr(self):
        """Standard error of the camera's place, m: root of the summed variances; its turns leave the place alone."""
        return float(np.sqrt(np.trace(self.covariance[3:, 3:])))


def refine_hand_eye(
    arm,
    camera,
    q,
    corners,
    points,
    start,
    *,
    terms=("offset2",),
    sigma_px=0.2,
    sigma_q=(2e-3, 2e-3, 2e-3),
    known_T_base_cam=None,
    known_T_tool_board=None,
):
    """Fit T_base_cam, T_tool_board, joint terms and the error of every single reading to all corners at once.

        minimise  sum |corner - project(T_cam_base T_base_tool(correction(q_i) + e_i) T_tool_board X)|^2 / sigma_px^2
                + sum |e_i|^2 / sigma_q^2

    What can be told: offset2, all slopes and bows that the poses span. Not offset1, which a turn of the camera about
    the column explains as well, unless known_T_base_cam is given; and not offset3, which a turn of the board in the
    hand explains, unless known_T_tool_board is given. For reaching with the same camera, offset1 then does no harm.

    Args:
        arm: Arm; camera: Pinhole or Calibration; q: (n, 3) rad, as measured; corners: n arrays (m, 2) px; points:
        (m, 3) m, board coordinates; start: HandEye (or anything with T_base_cam and T_tool_board).
        terms: names of what to fit of the potentiometers, from JOINT_TERMS, or () for none.
        sigma_px: px per coordinate; sigma_q: rad (3,), scatter of one reading (half a count, the play of the gear).
        known_T_base_cam, known_T_tool_board: (T, sigma_turn rad, sigma_shift m): known beforehand, and how well.

    Returns: RefinedHandEye. Raises CalibrationError for a term that these poses cannot tell, naming it, or if the fit
    does not converge; InputError for wrong shapes or names.
    """
    from scipy.optimize import least_squares

    q = vectors3("q", q).reshape(-1, 3)
    corners = numbers("corners", corners, unit="px")
    points = numbers("points", points, unit="m")
    if corners.shape != (len(q), len(points), 2) or points.shape[-1:] != (3,):
        raise InputError(f"corners {corners.shape}, q {q.shape}, points {points.shape}: give (n, m, 2), (n, 3), (m, 3)")
    if not np.isfinite(corners).all() or not np.isfinite(points).all():
        raise InputError("corners and points must be finite numbers")
    JointCorrection.of(arm, dict.fromkeys(terms, 0.0))
    K, distortion = camera_numbers(camera)
    sigma_px, sigma_q = number("sigma_px", sigma_px, "> 0", unit="px"), vectors3("sigma_q", sigma_q)
    if sigma_q.shape != (3,) or not (sigma_q > 0).all():
        raise InputError(f"sigma_q = {sigma_q.tolist()} rad: give three numbers > 0")
    if not (hasattr(start, "T_base_cam") and hasattr(start, "T_tool_board")):
        raise InputError(f"start = {start!r:.60}: give what hand_eye(...) found, with T_base_cam and T_tool_board")
    T0 = (
        inverse_transform(checked_transform("T_base_cam", start.T_base_cam)),
        checked_transform("T_tool_board", start.T_tool_board),
    )
    known = (_known(known_T_base_cam, turn=True), _known(known_T_tool_board))
    fixed = 12 + len(terms)

    def unpack(x):
        T_cam_base = transform(x[:3], x[3:6]) @ T0[0]
        T_tool_board = T0[1] @ transform(x[6:9], x[9:12])
        correction = JointCorrection.of(arm, dict(zip(terms, x[12:fixed], strict=True)))
        return T_cam_base, T_tool_board, correction, x[fixed:].reshape(-1, 3)

    def project(x):
        T_cam_base, T_tool_board, correction, e = unpack(x)
        T = T_cam_base @ frames(arm, correction(q) + e)[:, 3] @ T_tool_board
        X = np.einsum("nij,mj->nmi", T[:, :3, :3], points) + T[:, None, :3, 3]
        x_d, y_d = distort_xy(distortion, X[..., 0] / X[..., 2], X[..., 1] / X[..., 2])
        return np.stack([K[0, 0] * x_d + K[0, 1] * y_d + K[0, 2], K[1, 1] * y_d + K[1, 2]], axis=-1)

    def priors(x):
        T_cam_base, T_tool_board, _, e = unpack(x)
        rows = [(e / sigma_q).ravel()]
        for T, prior in ((T_cam_base, known[0]), (T_tool_board, known[1])):
            if prior is not None:
                turn, shift = rvec_tvec(T @ prior[0])
                rows += [turn / prior[1], shift / prior[2]]
        return np.concatenate(rows)

    def misses(x):
        return np.concatenate([((project(x) - corners) / sigma_px).ravel(), priors(x)])

    def slopes(x):
        """Differences: one column for each shared number, and three for the errors of all poses together."""
        n, per, step = len(q), 2 * len(points), 1e-6
        J = np.zeros((n * per + len(priors(x)), len(x)))
        for k in range(fixed):
            d = np.zeros(len(x))
            d[k] = step
            J[:, k] = (misses(x + d) - misses(x - d)) / (2 * step)
        for joint in range(3):
            d = np.zeros(len(x))
            d[fixed + joint :: 3] = step
            block = ((project(x + d) - project(x - d)) / (2 * step * sigma_px)).reshape(n, per)
            for i in range(n):
                J[i * per : (i + 1) * per, fixed + 3 * i + joint] = block[i]
                J[n * per + 3 * i + joint, fixed + 3 * i + joint] = 1 / sigma_q[joint]
        return J

    result = least_squares(misses, np.zeros(fixed + q.size), jac=slopes, x_scale="jac", max_nfev=60)
    scale = np.linalg.norm(result.jac, axis=0)
    _, singular, Vt = np.linalg.svd(result.jac / scale, full_matrices=False)
    if singular[-1] < _WEAK * singular[0]:
        _refuse_weak(terms, Vt[singular < _WEAK * singular[0]])
    if not result.success:
        raise CalibrationError(f"the fit did not settle in {result.nfev} steps: are the start and the q right?")
    root = Vt.T / singular / scale[:, None]
    covariance = root @ root.T
    T_cam_base, T_tool_board, correction, e = unpack(result.x)
    camera = covariance[:6, :6]
    if known[0] is None:
        column = _about_column(T_cam_base)
        camera = camera + sigma_q[0] ** 2 * np.outer(column, column)
    return RefinedHandEye(
        T_base_cam=inverse_transform(T_cam_base),
        T_tool_board=T_tool_board,
        correction=correction,
        stderr={name: float(np.sqrt(covariance[12 + k, 12 + k])) for k, name in enumerate(terms)},
        covariance=camera,
        joint_errors=e,
        pose_rms=np.sqrt(((project(result.x) - corners) ** 2).sum(axis=2).mean(axis=1)),
    )


def _about_column(T_cam_base):
    """How the camera turns and shifts (6,), in camera coordinates, for 1 rad about the z axis of the base."""
    axis = T_cam_base[:3, 2]
    return np.concatenate([axis, np.cross(T_cam_base[:3, 3], axis)])


def _known(given, *, turn=False):
    """(inverse of what the fitted transform should be, sigma rad, sigma m) or None."""
    if given is None:
        return None
    T, sigma_turn, sigma_shift = given
    T = checked_transform("a known transform", T)
    if not (sigma_turn > 0 and sigma_shift > 0):
        raise InputError(f"sigmas {sigma_turn} rad, {sigma_shift} m of a known transform: give numbers > 0")
    return (T if turn else inverse_transform(T)), float(sigma_turn), float(sigma_shift)


def _refuse_weak(terms, directions):
    share = np.abs(directions[:, 12 : 12 + len(terms)]).max(axis=0) if len(terms) else np.zeros(0)
    for name, size in zip(terms, share, strict=True):
        if size > 0.05:
            why = _WHY.get(name, "the poses span too little of that joint: use more of its travel")
            raise CalibrationError(f"{name} cannot be told from these views: {why}")
    raise CalibrationError("camera and board cannot be told apart from these poses: turn joint 1 and joint 2 or 3 more")
