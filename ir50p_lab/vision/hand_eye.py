"""Where the camera stands in the base frame of the arm: from a board in the hand, seen in many poses (eye-to-hand)."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.inputs import check_arm, vectors3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.vision.board_pose import BoardPose, checked_transform, inverse_transform

_FEWEST = 4  # poses; three would do for exact angles
_LEAST_SPREAD = 0.1  # rad rms that the hand must turn about a second axis; potentiometers err by some 0.005
_LEVER = 0.3  # m; a turn of 1 rad counts like a shift of 0.3 m
_WORST = 0.03  # m rms; of poses that belong together 5 mm are left, of others 60 and more
_ODD, _ODD_TIMES = 0.02, 4.0  # m, and times the median pose: a pose that is farther off does not belong to the others


@dataclass(frozen=True, eq=False)
class HandEye:
    """Where the camera is, from arm poses.

    ================= =============================================================== ==============
    T_base_cam        takes camera coordinates to base coordinates                    (4, 4)
    T_tool_board      the board in the hand: board to tool coordinates (frame 3)      (4, 4)
    rotation_error    of each pose, what the two ways round the loop differ by        (n,) rad
    translation_error the same, of the board's origin                                 (n,) m
    method            of OpenCV, the one with the smallest error
    methods           rms translation error of every method tried                     name -> m
    ================= =============================================================== ==============
    """

    T_base_cam: np.ndarray
    T_tool_board: np.ndarray
    rotation_error: np.ndarray = field(repr=False)
    translation_error: np.ndarray = field(repr=False)
    method: str
    methods: dict = field(repr=False)

    @property
    def rms(self):
        """(rotation rad, translation m), rms over the poses."""
        return tuple(float(np.sqrt(np.mean(e**2))) for e in (self.rotation_error, self.translation_error))

    def table(self):
        """Each pose with what it leaves over, as text."""
        lines = [f"{'pose':>4} {'rotation':>10} {'translation':>12}"]
        for i, (turn, shift) in enumerate(zip(self.rotation_error, self.translation_error, strict=True)):
            lines.append(f"{i:>4} {1e3 * turn:>5.1f} mrad {1e3 * shift:>9.1f} mm")
        return "\n".join([*lines, f"T_base_cam by the method of {self.method}"])


def camera_from_board(pose, T_base_board):
    """T_base_cam (4, 4) from one view of a board whose place in the base frame is known.

        T_base_cam = T_base_board T_cam_board^-1

    Args: pose: BoardPose or T_cam_board (4, 4); T_base_board: (4, 4), z of a lying board points down (see
    `board_points`). Raises InputError for matrices that are no rigid transforms.
    """
    T_cam_board = pose.T_cam_board if isinstance(pose, BoardPose) else pose
    T_cam_board = checked_transform("T_cam_board", T_cam_board)
    return checked_transform("T_base_board", T_base_board) @ inverse_transform(T_cam_board)


def tool_poses(arm, q):
    """T_base_tool (n, 4, 4) of joint angles (n, 3) rad: frame 3 of the chain, its x along the forearm."""
    return frames(arm, vectors3("q", q).reshape(-1, 3))[:, 3]


def hand_eye(arm, q, T_cam_board):
    """Camera and board from arm poses: A X = Z B by six methods of OpenCV, the best by what is left over.

        T_base_tool(q_i) T_tool_board = T_base_cam T_cam_board_i      for every pose i

    The potentiometers quantise, and are off; every method takes q as exact, so what is left over is theirs, and
    `refine_hand_eye` does better. The hand of this arm turns about two axes only, the column (q1) and the joint axis
    of q2 + q3: that is enough, if both are used.

    Args: arm: Arm; q: (n, 3) rad, n >= 4; T_cam_board: n poses, each BoardPose or (4, 4).
    Returns: HandEye. Raises CalibrationError for too few poses, turns about one axis only, poses given the wrong way
    round, or that do not belong to these q, naming single ones; InputError for wrong shapes.
    """
    T_tool = tool_poses(check_arm(arm), q)
    if not isinstance(T_cam_board, list | tuple | np.ndarray):
        raise InputError(f"T_cam_board = {T_cam_board!r:.60}: give a list of poses, each BoardPose or (4, 4)")
    poses = [one.T_cam_board if isinstance(one, BoardPose) else one for one in T_cam_board]
    T_cam = np.array([checked_transform(f"T_cam_board[{i}]", T) for i, T in enumerate(poses)]).reshape(-1, 4, 4)
    if len(T_cam) != len(T_tool):
        raise InputError(f"{len(T_tool)} joint poses for {len(T_cam)} views: give one of each per pose")
    _refuse_poor_poses(T_tool)
    results = _all_methods(T_tool, T_cam)
    if not results:
        raise CalibrationError("no method found a finite answer: are the views sharp, and of one and the same board?")
    best = min(results, key=lambda name: results[name][0])
    rms, T_base_cam, T_tool_board, turn, shift = results[best]
    back = _all_methods(T_tool, np.array([inverse_transform(T) for T in T_cam]))
    if back and min(value[0] for value in back.values()) < rms / 3:
        raise CalibrationError(
            "the views look inverted: T_cam_board takes board to camera coordinates; give inverse_transform(...)"
        )
    odd, others = _odd_poses(T_tool, T_cam)
    if odd and others < rms / 2:
        raise CalibrationError(
            f"poses that do not belong to the others (counted from 0): {', '.join(map(str, odd))}; with them "
            f"{1e3 * rms:.0f} mm rms are left, without {1e3 * others:.0f} mm. Leave them out of q and of the views, or "
            "take them again"
        )
    if rms > _WORST:
        raise CalibrationError(
            f"arm and camera disagree by {1e3 * rms:.0f} mm rms: do the views belong to these q, in this order, did "
            "the board slip in the gripper, or did the camera move?"
        )
    return HandEye(
        T_base_cam=T_base_cam,
        T_tool_board=T_tool_board,
        rotation_error=turn,
        translation_error=shift,
        method=best,
        methods={name: value[0] for name, value in results.items()},
    )


def loop_errors(T_base_cam, T_tool_board, T_base_tool, T_cam_board):
    """What the two ways round the loop differ by: angles (n,) rad, distances of the board's origin (n,) m."""
    ours, seen = T_base_tool @ T_tool_board, T_base_cam @ T_cam_board
    turn = np.einsum("nji,njk->nik", ours[:, :3, :3], seen[:, :3, :3])
    # sin and cos of the angle: acos of the trace alone would lose half the digits
    axis = 0.5 * np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]])
    cosine = 0.5 * (np.trace(turn, axis1=1, axis2=2) - 1)
    angle = np.arctan2(np.linalg.norm(axis, axis=0), cosine)
    return angle, np.linalg.norm(ours[:, :3, 3] - seen[:, :3, 3], axis=1)


def _odd_poses(T_base_tool, T_cam_board):
    """(numbers of up to a quarter of the poses that do not belong to the others, rms m of the others).

    A wrong pose pulls the camera towards itself, and the others off: so the worst goes out, and the rest is fitted anew
    until no pose sticks out and little is left. No numbers if that takes more than a quarter.
    """
    kept, rms = list(range(len(T_base_tool))), np.inf
    for _ in range(max(1, len(kept) // 4) + 1):
        found = _all_methods(T_base_tool[kept], T_cam_board[kept])
        if not found:
            break
        rms, _, _, turn, shift = min(found.values(), key=lambda one: one[0])
        off = np.hypot(shift, _LEVER * turn)
        worst = int(np.argmax(off))
        if rms < _WORST and off[worst] < max(_ODD, _ODD_TIMES * np.median(off)):
            return sorted(set(range(len(T_base_tool))) - set(kept)), rms
        if len(kept) <= _FEWEST:
            break
        del kept[worst]
    return [], rms


def _all_methods(T_base_tool, T_cam_board):
    """name -> (rms m, T_base_cam, T_tool_board, rotation errors, translation errors)."""
    import cv2

    R_tool, t_tool = T_base_tool[:, :3, :3], T_base_tool[:, :3, 3]
    R_view, t_view = T_cam_board[:, :3, :3], T_cam_board[:, :3, 3]
    back = np.array([inverse_transform(T) for T in T_base_tool])
    found = {}
    for name in ("TSAI", "PARK", "HORAUD", "DANIILIDIS"):  # eye-in-hand turned round: base and tool change places
        method = getattr(cv2, f"CALIB_HAND_EYE_{name}")
        try:
            R, t = cv2.calibrateHandEye(back[:, :3, :3], back[:, :3, 3], R_view, t_view, method=method)
        except cv2.error:
            continue
        T_base_cam = _rigid(R, t)
        boards = np.array([inverse_transform(T) for T in T_base_tool]) @ T_base_cam @ T_cam_board
        _keep(found, name, T_base_cam, _mean_pose(boards), T_base_tool, T_cam_board)
    for name in ("SHAH", "LI"):  # both unknowns at once
        method = getattr(cv2, f"CALIB_ROBOT_WORLD_HAND_EYE_{name}")
        try:
            R_bt, t_bt, R_cb, t_cb = cv2.calibrateRobotWorldHandEye(R_view, t_view, R_tool, t_tool, method=method)
        except cv2.error:
            continue
        T_tool_board, T_base_cam = inverse_transform(_rigid(R_bt, t_bt)), inverse_transform(_rigid(R_cb, t_cb))
        _keep(found, name, T_base_cam, T_tool_board, T_base_tool, T_cam_board)
    return found


def _keep(found, name, T_base_cam, T_tool_board, T_base_tool, T_cam_board):
    if not (np.isfinite(T_base_cam).all() and np.isfinite(T_tool_board).all()):
        return
    turn, shift = loop_errors(T_base_cam, T_tool_board, T_base_tool, T_cam_board)
    rms = float(np.sqrt(np.mean(shift**2 + (_LEVER * turn) ** 2)))
    found[name] = (rms, T_base_cam, T_tool_board, turn, shift)


def _rigid(R, t):
    """Transform with the rotation nearest to R; some methods return one that is not quite orthonormal."""
    T = np.full((4, 4), np.nan)
    R, t = np.asarray(R, dtype=float), np.ravel(t)
    if np.isfinite(R).all() and np.isfinite(t).all():
        U, _, Vt = np.linalg.svd(R)
        T = np.eye(4)
        T[:3, :3] = U @ np.diag([1, 1, np.linalg.det(U @ Vt)]) @ Vt
        T[:3, 3] = t
    return T


def _mean_pose(T):
    """Mean of poses that are near to each other."""
    return _rigid(T[:, :3, :3].mean(axis=0), T[:, :3, 3].mean(axis=0))


def _refuse_poor_poses(T_tool):
    from scipy.spatial.transform import Rotation

    if len(T_tool) < _FEWEST:
        raise CalibrationError(
            f"{len(T_tool)} poses of the hand: give at least {_FEWEST}, better 15, with joints 1 and 2 or 3 turned"
        )
    R = T_tool[:, :3, :3]
    pairs = [(i, j) for i in range(len(R)) for j in range(i)]
    turns = Rotation.from_matrix(np.array([R[i] @ R[j].T for i, j in pairs])).as_rotvec()
    spread = np.linalg.svd(turns, compute_uv=False) / np.sqrt(len(turns))
    if spread[1] < _LEAST_SPREAD:
        raise CalibrationError(
            f"the hand turned about one axis only ({np.degrees(spread[0]):.0f} deg rms about it, "
            f"{np.degrees(spread[1]):.1f} deg about a second one): where the camera stands along that axis stays open. "
            "Turn joint 1 as well as joint 2 or 3, each by 20 deg or more"
        )
