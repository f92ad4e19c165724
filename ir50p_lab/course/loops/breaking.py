"""Six loops that are broken, each in its own way, and a healthy one: shown without a name, named by the student, cured.

    run = broken("A")
    name_it("A", "windup")

Simulated, on the arm of the course; loop C on the thesis's own arm, because it is about that arm's gains.
"""

import tomllib
import warnings
from pathlib import Path
from textwrap import fill

import numpy as np

from ir50p_lab.controllers import PID
from ir50p_lab.errors import InputError, UnstableLoopWarning
from ir50p_lab.modelling import THESIS_A, load_arm
from ir50p_lab.signals import steps
from ir50p_lab.simulation import simulate

NAMES = ("delay", "friction", "healthy", "kick", "noise", "sampling", "weak motor", "windup")  # one too many
THESIS_TARGET = (np.pi / 2, np.pi / 2, -np.pi / 3)
THESIS_KP, THESIS_KD = (25, 200, 200), (10, 40, 40)
FIRM_KP, FIRM_KI = (1500, 1500, 1500), (300, 2000, 2000)
# name, clue, because
CASES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


class Late:
    """A controller that gets every angle some samples late."""

    def __init__(self, controller, samples):
        self.controller, self.samples, self.unit = controller, samples, "PWM"
        self.reset()

    def reset(self):
        """Forget the angles so far."""
        self.controller.reset()
        self.heard = []

    def step(self, t, q, reference):
        """Return the answer to the angle of `samples` samples ago."""
        self.heard = [*self.heard, np.array(q)][-1 - self.samples :]
        return self.controller.step(t, self.heard[0], reference)


def far_target(arm):
    """Return the thesis's set point as far as the arm's travel allows it, (3,) rad."""
    return np.clip(THESIS_TARGET, 0.9 * np.array(arm.q_min), 0.9 * np.array(arm.q_max))


def broken(letter, arm=None):
    """Return the run of a case, "A" to "G"."""
    _case(letter)
    arm = load_arm() if arm is None else arm
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnstableLoopWarning)  # to be named by the student, not by us
        kinds = {"A": windup, "B": kick, "C": sampling, "D": delay, "E": healthy, "F": friction, "G": noise}
        return kinds[letter](arm)


def windup(arm, *, cured=False):
    """Return a large step without friction; the integral rests at the limit only if `cured`."""
    pid = PID((289, 225, 270), ki=200, kd=(40, 30, 30), limit_pwm=255, anti_windup=cured)
    return simulate(arm.without_friction(), pid, far_target(arm), duration=6)


def kick(arm, *, cured=False):
    """Return a small jump, with D on the error, or on the measurement if `cured`."""
    pid = PID(100, ki=20, kd=40, limit_pwm=255, derivative_on="measurement" if cured else "error")
    return simulate(arm.without_friction(), pid, steps([0, 1], [[0, 0, 0], [0.2, 0, 0]]), duration=3)


def sampling(arm, *, period=0.01):
    """Return a run of the thesis's arm with its gains; the command (N m, at most 330) is held for `period` s."""
    pid = PID(THESIS_KP, kd=THESIS_KD, limit=330, period=period, filter_hz=np.inf)
    return simulate(THESIS_A, pid, THESIS_TARGET, duration=2, period=period, step=min(period, 0.0005))


def delay(arm, *, samples=15):
    """Return a run of a loop that gets angles late, without friction; the motor stays within its limit."""
    pid = PID((800, 1500, 1500), ki=(0, 2000, 2000), kd=10, limit_pwm=255)
    return simulate(arm.without_friction(), Late(pid, samples), 0.15 * far_target(arm), duration=6)


def healthy(arm):
    """Return a large step of a loop with nothing wrong: its motor is at its limit for a while, as any would be."""
    pid = PID((1000, 1500, 1500), ki=(0, 2000, 2000), kd=(80, 10, 10), limit_pwm=255)
    return simulate(arm.without_friction(), pid, far_target(arm), duration=6)


def hears_late(arm, controller, samples):
    """Return a step of middle size by a controller that gets angles `samples` samples late."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnstableLoopWarning)  # what is looked for
        return simulate(arm, Late(controller, samples), 0.4 * far_target(arm), duration=6)


def friction(arm, *, kp=150.0, ki=20.0, duration=10):
    """Return a small step of joint 1 that friction stops short of its target."""
    pid = PID((kp, 400, 400), ki=(ki, 1500, 1500), kd=(20, 10, 10), limit_pwm=255)
    target = 0.4 * far_target(arm)
    return simulate(arm, pid, target, q0=target - [0.3, 0, 0], duration=duration)


def noise(arm, *, filter_hz=np.inf):
    """Return a run with a noisy measured angle and a D that reacts to every count."""
    from ir50p_lab.course.loops.contest_rules import PRACTICE, drive

    pid = PID(FIRM_KP, ki=FIRM_KI, kd=60, limit_pwm=255, filter_hz=filter_hz)
    return drive(pid, PRACTICE[0], arm)[1]


def name_it(letter, name=...):
    """Say what is wrong with a case, one of NAMES; the answer is a sentence."""
    case = _case(letter)
    if name is ...:
        print(f"{letter}: put one of these in place of the dots: {', '.join(NAMES)}.")
    elif name == case["name"]:
        print(fill(f"{letter}, {name}: yes, {case['because']}", 100))
    elif name in NAMES:
        print(fill(f"{letter}, {name}: not this one. {case['clue']}", 100))
    else:
        print(f"{letter}: {name!r} is none of them: {', '.join(NAMES)}.")


def _case(letter):
    if letter not in CASES:
        raise InputError(f"{letter!r}: the cases are {', '.join(CASES)}")
    return CASES[letter]
