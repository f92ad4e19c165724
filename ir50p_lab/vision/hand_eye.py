"""Where the camera stands in the base frame of the arm: from a board in the hand, seen in many poses (eye-to-hand)."""

from dataclasses import dataclass, field

import numpy as np

from ir50p_lab.errors import CalibrationError, InputError
from ir50p_lab.inputs import vectors3
from ir50p_lab.modelling.chain import frames
from ir50p_lab.vision.board_pose import BoardPose, inverse_transform, transform
from ir50p_lab.vision.checks import rigid

_FEWEST = 4  # poses; three would do for exact angles
_LEAST_SPREAD = 0.1  # rad rms that the hand must turn about a second axis; potentiometers err by some 0.005
_LEVER = 0.3  # m; a turn of 1 rad counts like a shift of 0.3 m
_WORST = 0.03  # m rms; of poses that belong together 5 mm are left, of others 60 and more
_ODD, _ODD_TIMES = 0.02, 4.0  # m, and times the median pose: a pose that is farther off does not belong to the others

_CAUSES = (
    "are the views inverted (T_cam_board takes board to camera coordinates) or in another order, did the board slip in "
    "the gripper, or did the camera move?"
)


@dataclass(frozen=True, eq=False)
class HandEye:
    """Where the camera is, from arm poses.

    ================= =============================================================== ==============
    T_base_cam        takes camera coordinates to base coordinates                    (4, 4)
    T_tool_board      the board in the hand: board to tool coordinates (frame 3)      (4, 4)
    rotation_error    of each pose, what the two ways round the loop differ by        (n,) rad
    translation_error the same, of the board's origin                                 (n,) m
    ================= =============================================================== ==============
    """

    T_base_cam: np.ndarray
    T_tool_board: np.ndarray
    rotation_error: np.ndarray = field(repr=False)
    translation_error: np.ndarray = field(repr=False)

    @property
    def rms(self):
        """(rotation rad, translation m), rms over the poses."""
        return tuple(float(np.sqrt(np.mean(e**2))) for e in (self.rotation_error, self.translation_error))


def tool_poses(arm, q):
    """T_base_tool (n, 4, 4) of joint angles (n, 3) rad: frame 3 of the chain, its x along the forearm."""
    return frames(arm, vectors3("q", q).reshape(-1, 3))[:, 3]


def hand_eye(arm, q, T_cam_board):
    """Camera and board from arm poses: A X = Z B by OpenCV (method of Shah).

        T_base_tool(q_i) T_tool_board = T_base_cam T_cam_board_i      for every pose i

    The method takes q as exact, so what is left over is the potentiometers', which round and are off. The hand of this
    arm turns about two axes only, the column (q1) and the joint axis of q2 + q3: that is enough, if both are used.

    Args: arm: Arm; q: (n, 3) rad, n >= 4; T_cam_board: n poses, each BoardPose or (4, 4).
    Returns: HandEye. Raises CalibrationError for too few poses, turns about one axis only, poses given the wrong way
    round, or that do not belong to these q, naming the worst; InputError for wrong shapes.
    """
    import cv2
    from scipy.spatial.transform import Rotation

    T_tool = tool_poses(arm, q)
    if not isinstance(T_cam_board, list | tuple | np.ndarray) or len(T_cam_board) != len(T_tool):
        raise InputError(f"T_cam_board must be a list of poses, each BoardPose or (4, 4), one of each of {len(T_tool)}")
    poses = [one.T_cam_board if isinstance(one, BoardPose) else one for one in T_cam_board]
    T_cam = np.array([rigid(f"T_cam_board[{i}]", T) for i, T in enumerate(poses)])
    _refuse_poor_poses(T_tool)
    poses = [part for T in (T_cam, T_tool) for part in (T[:, :3, :3], T[:, :3, 3])]
    try:
        found = cv2.calibrateRobotWorldHandEye(*poses, method=cv2.CALIB_ROBOT_WORLD_HAND_EYE_SHAH)
        back = [transform(Rotation.from_matrix(R).as_rotvec(), t) for R, t in (found[:2], found[2:])]
    except (cv2.error, ValueError):
        raise CalibrationError(f"no camera explains these poses: {_CAUSES}") from None
    T_tool_board, T_base_cam = map(inverse_transform, back)
    ours, seen = T_tool @ T_tool_board, T_base_cam @ T_cam
    turn = Rotation.from_matrix(ours[:, :3, :3].transpose(0, 2, 1) @ seen[:, :3, :3]).magnitude()
    shift = np.linalg.norm(ours[:, :3, 3] - seen[:, :3, 3], axis=1)
    errors = np.hypot(shift, _LEVER * turn)
    rms, worst = np.sqrt(np.mean(errors**2)), int(np.argmax(errors))
    if rms > _WORST or errors[worst] > max(_ODD, _ODD_TIMES * np.median(errors)):
        raise CalibrationError(
            f"arm and camera disagree by {1e3 * rms:.0f} mm rms, most in pose {worst} (counted from 0): leave it out "
            f"of q and of the views, or take it again; or {_CAUSES}"
        )
    return HandEye(T_base_cam, T_tool_board, turn, shift)


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
