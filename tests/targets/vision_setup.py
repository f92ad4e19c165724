"""What the rendered targets share: camera and potentiometers calibrated by us, and the plane that the camera sees."""

from functools import cache

import numpy as np

from ir50p_lab.bench import SimulatedBench, fit_calibration
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import TablePlane, calibrate
from ir50p_lab.vision.rendering import bench_camera
from tests.support.board_pictures import paint, painted_set

T_BASE_BOARD = np.array([[1, 0, 0, 0.28], [0, -1, 0, 0.065], [0, 0, -1, 0.0], [0, 0, 0, 1.0]])  # middle of the area


@cache
def own_calibration(count=15, seed=1):
    """Calibration of the bench camera from `count` painted pictures of the board."""
    return calibrate(painted_set(bench_camera()[0], count, seed), progress=False)


def picture_of_the_board(seed=0):
    """What the bench camera sees of the board at its known place, painted."""
    camera, T_cam_base = bench_camera()
    return paint(T_cam_base @ T_BASE_BOARD, seed=seed, intrinsic=camera.K, lens=camera.distortion)


@cache
def own_plane(seed=1):
    """TablePlane of our own calibration and one picture of the lying board."""
    return TablePlane.from_picture(own_calibration(seed=seed), picture_of_the_board(seed), T_table_board=T_BASE_BOARD)


@cache
def calibrated(seed):
    """The line through nine angles of each joint, as the experiment of notebook 10 finds it."""
    plant, points = SimulatedBench(IR50P, seed=seed, record_to=False).plant, []
    for joint in range(3):
        angles = np.linspace(IR50P.q_min[joint] + 0.05, IR50P.q_max[joint] - 0.05, 9)
        counts = []
        for angle in angles:
            plant._joint[:] = 0.0
            plant._joint[joint] = angle
            counts.append(np.mean([plant.counts()[joint] for _ in range(50)]))
        points.append((angles, counts))
    q, counts = zip(*points, strict=True)
    return fit_calibration(np.transpose(q), np.transpose(counts), arm=IR50P)
