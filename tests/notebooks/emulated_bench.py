"""The emulated board in a notebook's kernel, on its own time, with an arm behind it that a stand-in for a webcam sees.

All that lies between a cell and these is the package itself: `connect()` finds the board, `open_camera()` the webcam.
"""

import os
import sys
import time
from pathlib import Path

from ir50p_lab.bench import SerialBench, nominal_calibration, serial_bench
from ir50p_lab.bench.ports import Port
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.course import save_result
from ir50p_lab.course.at_the_bench import drive_views
from ir50p_lab.course.torque.views import training_run
from ir50p_lab.identification import identify
from ir50p_lab.modelling import load_arm
from ir50p_lab.vision import camera as cameras
from ir50p_lab.vision import camera_over
from ir50p_lab.vision.board_pose import inverse_transform
from tests.emulator.virtual import VirtualBoard
from tests.targets.vision_setup import own_calibration, own_plane

PORT = Port("emulated", "Mega 2560")


class ArmOnATable:
    """The arm behind the board; of a SimulatedBench it has what a rendered camera looks at."""

    period = 1e-3  # s, of the board's calls

    def __init__(self):
        self.arm = load_arm()
        self.plant = SimulatedArm(self.arm, q0=rest_pose(self.arm))
        self.board = VirtualBoard(self)

    def advance(self, pwm, seconds):
        self.plant.advance(pwm, seconds)
        self._send(pwm, self.board.changes[-1][1].gripper)

    def counts(self):
        return self.plant.counts()

    def _send(self, pwm, gripper):
        """Where a rendered camera listens."""


class Webcam:
    """A rendered camera whose pictures pass for photographs.

    names: of the notebook, which says where the ball lies (or rolls, for the small pictures).
    """

    name, simulated = "stand-in for a webcam", False

    def __init__(self, seen, names, size=None):
        self._camera = camera_over(seen, names["rolling" if size else "ball"], small=bool(size))
        self.size = self._camera.size

    def read(self):
        return self._camera.read()._replace(simulated=False)

    def close(self):
        self._camera.close()


def plug_in(names):
    """Put the board on a serial port and the webcam on the computer, for a notebook with these names. Returns: board."""
    seen = ArmOnATable()
    board = seen.board

    def open_port(device, baud):
        board.is_open = True
        return board

    sys.modules["ir50p_lab.bench.connect"].list_ports = lambda: [] if board._unplugged else [PORT]
    serial_bench.open_port, serial_bench.Clock = open_port, board
    SerialBench._arguments = lambda self: None  # loops run in this process: another one has another board
    SerialBench.realtime = True
    cameras.open_camera = lambda source=None, **options: Webcam(seen, names, **options)
    return board


def hang(board, mass):
    """Put `mass` kg into the gripper of the arm at rest, as a notebook asks for."""
    seen = board.plant
    seen.plant = SimulatedArm(seen.arm.with_payload(mass), q0=rest_pose(seen.arm))


def measure():
    """Keep calibration, model and camera as of this board: what notebooks 10, 12 and 17 leave behind for a real arm."""
    arm = load_arm()
    with SerialBench("emulated", record_to=False) as bench:
        bench.give_id()
        save_result("calibration", nominal_calibration(arm), bench)
        save_result("model", identify(training_run(arm), l2=arm.l[1]), bench)
        save_result("camera", own_calibration(), inverse_transform(own_plane().T_cam_table), bench)


def allow_the_cable(board):
    """What 10 leaves behind for this board; a lab's own file that lets its cable be pulled; a hand that pulls it."""
    with SerialBench(PORT.device, record_to=False) as bench:
        bench.give_id()
        save_result("calibration", nominal_calibration(bench.arm), bench)
    file = Path(os.environ["IR50P_HOME"], "bench.toml")
    file.write_text(f"[{bench.bench_id}]\nspeed = 3\nfaults = ['cable']")
    os.environ["IR50P_BENCH_FILE"] = str(file)
    make = drive_views.cause_fault

    def make_and_pull(fault, bench):
        make(fault, bench)  # asks for it
        if fault == "cable":
            board.unplug()

    drive_views.cause_fault = make_and_pull


def plug_in_again(board):
    """A board whose cable was pulled has one again, and boots."""
    board._unplugged = False
    board.reset()


def wait(board, seconds):
    """For a cell beside a loop in the background: until so much of the board's time has passed, 60 s at most."""
    until, latest = board.now() + seconds, time.monotonic() + 60
    while board.now() < until and time.monotonic() < latest:
        time.sleep(0.01)
