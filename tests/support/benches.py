"""The benches of the contract, each on a rig of its own: a way to make it, and a look at the arm behind it."""

import numpy as np
from fake_board import FakeBoard

from ir50p_lab.bench import ReplayBench, SerialBench, SimulatedBench, nominal_calibration
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold

GAINS = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30)}  # Tables 4.1-4.3


class Rig:
    """One bench for one test. q0: where the arm stands; folder: for recordings.

    moves: whether drive moves the arm; exact: whether sample times are whole periods to the last bit.
    """

    moves = True
    exact = False

    def __init__(self, folder, q0):
        self.folder, self.q0 = folder, np.array(q0, dtype=float)
        self.made = None
        self.set_up()

    def set_up(self):
        pass

    def bench(self, **options):
        """A bench, not open yet; the arm stands at q0."""
        self.made = self.make(arm=IR50P, record_to=self.folder, **options)
        return self.made

    def wait(self, seconds):
        """Let time pass with nobody at the bench."""

    def pause(self, seconds):
        """Let the program sleep in its loop; only a bench that follows the clock takes notice."""

    def device(self):
        """What `connect()` is told to find this bench; None: it finds the board by itself."""
        return None


class Simulated(Rig):
    exact = True

    def make(self, **options):
        return SimulatedBench(q0=self.q0, **options)

    def drive_on_the_arm(self):
        waiting = np.vstack([self.made._queue, self.made.command])  # commands that act yet, the largest of each joint
        return waiting[np.abs(waiting).argmax(axis=0), range(3)]

    def q(self):
        return self.made.plant.q_true

    def wait(self, seconds):
        self.made.plant.advance(np.zeros(3), seconds)

    def device(self):
        return "simulated"


class Paced(Simulated):
    """The simulated arm in real time, on a virtual clock."""

    def set_up(self):
        self.t = 0.0

    def make(self, **options):
        bench = SimulatedBench(q0=self.q0, realtime=True, **options)
        bench._clock = self
        return bench

    def now(self):
        return self.t

    def sleep(self, seconds):
        self.t += seconds

    pause = sleep

    def device(self):
        raise NotImplementedError("connect() gives it the computer's clock")


class Replay(Rig):
    moves = False

    def set_up(self):
        self.path = None

    def make(self, calibration=None, **options):
        return ReplayBench(self.recorded(calibration=calibration), **options)

    def recorded(self, seconds=3.0, **options):
        with SimulatedBench(IR50P, q0=self.q0, record_to=self.folder / "recorded", **options) as bench:
            return bench.follow(PID(**GAINS, limit_pwm=255), hold(self.q0), seconds).path

    def drive_on_the_arm(self):
        return np.zeros(3)

    def device(self):
        return f"replay:{self.recorded(31.0)}"


class Serial(Rig):
    """Of the two with a board on virtual time: `board` is port and clock."""

    def make(self, **options):
        return SerialBench(self.board, clock=self.board, **options)

    def wait(self, seconds):
        self.board.sleep(seconds)

    def now(self):
        return self.board.now()

    pause = wait


class Double(Serial):
    def set_up(self):
        self.board = FakeBoard(nominal_calibration(IR50P), self.q0)

    def drive_on_the_arm(self):
        return self.board.pwm

    def q(self):
        return self.board.q

    def gripper(self):
        return self.board.gripper


class Firmware(Serial):
    def set_up(self):
        from tests.emulator.virtual import VirtualBoard

        self.arm = SimulatedArm(IR50P, q0=self.q0)
        self.board = VirtualBoard(self.arm)

    def drive_on_the_arm(self):
        """From the timer registers and the direction pins."""
        return np.array(self.board.pins().pwm)

    def q(self):
        return self.arm.q_true

    def gripper(self):
        return self.board.pins().gripper


CLOCKED = {"simulated in real time": Paced, "board in Python": Double, "firmware in the emulator": Firmware}
RIGS = {"simulated": Simulated, "replay": Replay, "board in Python": Double, "firmware in the emulator": Firmware}
