"""The camera matrix in two notations: points as columns (OpenCV, textbooks) and as rows (MATLAB, the thesis)."""

import numpy as np


def column_camera_matrix(K, T_cam_world):
    """P (3, 4) = K [R | t]: w (x, y, 1)^T = P (X, Y, Z, 1)^T.

    K (3, 3) = [[fx, s, cx], [0, fy, cy], [0, 0, 1]] px; T_cam_world (4, 4) takes world to camera coordinates, m.
    """
    return np.asarray(K) @ np.asarray(T_cam_world)[:3]


def row_camera_matrix(K_row, R_row, t_row):
    """P (4, 3) = [R; t] K: w (x, y, 1) = (X, Y, Z, 1) P    (3.5), (3.6)

    K_row (3, 3) = [[fx, 0, 0], [s, fy, 0], [cx, cy, 1]] (3.8) px; R_row (3, 3) and t_row (3,) m with X_cam = X R + t,
    all as MATLAB has them: R_row is the transpose of the rotation in column form.
    """
    return np.vstack([np.asarray(R_row), np.reshape(t_row, (1, 3))]) @ np.asarray(K_row)


def to_rows(K, T_cam_world):
    """(K_row, R_row, t_row) for `row_camera_matrix` from column form: transposes    (3.7) corrected

    The thesis' E = [[R, t], [0, 1]] is the column form, which does not go with its K: rows need [R; t], R = R_col^T.
    """
    T = np.asarray(T_cam_world)
    return np.asarray(K).T.copy(), T[:3, :3].T.copy(), T[:3, 3].copy()
