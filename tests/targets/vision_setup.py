"""What the rendered targets share: camera and potentiometers calibrated by us, and the plane that the camera sees."""

from functools import cache

import numpy as np

from ir50p_lab.bench import SimulatedBench, fit_calibration
from ir50p_lab.home import PROJECT
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import TablePlane, calibrate, load_image
from ir50p_lab.vision.rendering import pose

PICTURES = PROJECT / "data" / "calibration"  # rendered, of the default bench camera
T_BASE_BOARD = pose((0.32, 0.08, 0.0)) @ np.diag([1.0, -1.0, -1.0, 1.0])


@cache
def own_calibration():
    """Calibration of the bench camera from the fourteen good pictures of notebook 17."""
    return calibrate(sorted((PICTURES / "flat").glob("board_*.jpg")), progress=False)


@cache
def own_plane():
    """TablePlane of our own calibration and one picture of the lying board."""
    picture = load_image(PICTURES / "table" / "board.jpg")  # rendered, with the board at its known place
    return TablePlane.from_picture(own_calibration(), picture, T_table_board=T_BASE_BOARD)


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
