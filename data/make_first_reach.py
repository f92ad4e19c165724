"""The first thing that notebook 00 shows: a ball is seen, and the simulated arm goes there. Rendered and simulated.

`python -m data.make_first_reach` writes `data/first_reach.csv` and `data/first_reach.jpg` again.
"""

import numpy as np

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.home import PROJECT
from ir50p_lab.modelling.named_arms import IR50P
from ir50p_lab.signals import through
from ir50p_lab.vision import TablePlane, calibrate, camera_over, load_image
from ir50p_lab.vision.image import save_image
from ir50p_lab.vision.reaching.ball_locator import BallLocator
from ir50p_lab.vision.reaching.plan import reach_pose
from ir50p_lab.vision.rendering import pose

DATA = PROJECT / "data"
_GAINS = {"kp": (1000, 1200, 1000), "ki": (2000, 1500, 1500), "kd": (60, 80, 60)}  # found by trying: follows closely
_BALL = (0.42, -0.15, 0.03)  # m


def main(target=DATA):
    """Calibrate from the rendered pictures, look, reach, and write picture and recording into a folder."""
    boards = sorted((DATA / "calibration" / "flat").glob("board_*.jpg"))[:9]
    T_base_board = pose((0.32, 0.08, 0.0)) @ np.diag([1.0, -1, -1, 1])
    board = load_image(str(DATA / "calibration" / "table" / "board.jpg"))
    plane = TablePlane.from_picture(calibrate(boards, progress=False), board, T_table_board=T_base_board)
    start = rest_pose(IR50P)
    bench = SimulatedBench(IR50P, seed=7, q0=start, record_to=False).open()
    seen = BallLocator(camera_over(bench, np.array(_BALL)), plane).look()
    save_image(target / "first_reach.jpg", seen.image, rendered=True, quality=85)
    high, goal = (reach_pose(IR50P, seen.position + np.array([0, 0, z])) for z in (0.12, 0.06))
    controller = PID(**_GAINS, limit_pwm=255)
    bench.follow(controller, through([start, start, high, goal, goal], durations=(0.5, 2.5, 1.5, 1.5)), 6)
    recording = bench.recording
    del recording.header["date"]
    recording.header["made_by"] = "python -m data.make_first_reach"
    recording.save(target / "first_reach.csv")


if __name__ == "__main__":
    main()
