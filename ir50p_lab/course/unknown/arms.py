"""Arms that nobody has seen: relatives of the IR50P, drawn from a seed, with three balls and a camera."""

import itertools
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ir50p_lab.bench.arm_instance import ArmInstance
from ir50p_lab.bench.simulated_arm import SimulatedArm
from ir50p_lab.errors import UnreachableError
from ir50p_lab.modelling import IR50P, Arm, inverse_kinematics
from ir50p_lab.modelling.actuators import Actuators
from ir50p_lab.modelling.friction import Friction
from ir50p_lab.vision.pinhole import Pinhole

START = np.array([0.0, 0.9, -0.9])  # rad, where each run begins
PERIOD = 0.01  # s
RADIUS = 0.03  # m, of a ball
ABOVE = 0.035  # m over a ball's centre: there the tip touches it
TOUCH = ArmInstance(pot_bow=(0, 0, 0), slope_spread=0, shift_spread=0, bow_spread=0)  # calibrated potentiometers

# factors of the IR50P's own values, from and to; spread evenly on a logarithmic scale but for lengths and centres
_LENGTH, _CENTRE = (0.92, 1.08), (0.85, 1.15)
_MASS, _ROTOR, _DRY = (0.5, 2.0), (0.5, 2.0), (0.4, 2.0)
_STALL, _NO_LOAD = (0.5, 2.5), (0.8, 1.6)  # of the motors
_BREAKAWAY = (1.2, 2.0)  # times Coulomb friction
_OFFSET = 6.0  # counts at most, either way
_DELAY = (5, 7)  # periods from a sample to its action
_SHARE = 0.55  # of the stall torque that weight and breakaway take at most
_AWAY, _ASIDE, _APART = (0.30, 0.46), 0.7, 0.11  # m from the base, rad to either side, m from ball to ball
_EYE, _AIM = 0.06, 0.03  # m by which the camera's place, and the place that it looks at, differ


@dataclass(frozen=True, eq=False)
class Drawn:
    """An arm drawn from a seed. delay: periods from a sample to its action; balls: (3, 3), their centres, m; camera.

    camera is a Pinhole and its pose.
    """

    arm: Arm
    delay: int
    balls: np.ndarray
    pinhole: Pinhole
    T_cam_world: np.ndarray
    seed: int

    def machine(self):
        """Return the simulated arm at the start pose."""
        return SimulatedArm(self.arm, replace(TOUCH, delay=self.delay), self.seed, q0=START)

    @property
    def nominal(self):
        """theta (3, 20), counts: masses, motors and friction of the IR50P at the lengths of this arm."""
        scale = np.array(self.arm.l) / np.array(IR50P.l)
        inertia = {name: np.array(getattr(IR50P, name)) * scale**2 for name in ("Ixx", "Iyy", "Izz")}
        return replace(IR50P, l=self.arm.l, lc=np.array(IR50P.lc) * scale, **inertia).theta_pwm


@lru_cache(maxsize=64)
def drawn(seed):
    """Return the Drawn of a whole number of any size, the same for the same number. Its motors bear its weight."""
    rng = np.random.default_rng([seed, 19])
    arm = _arm(rng, seed)
    while not _bears_its_weight(arm):
        arm = _arm(rng, seed)
    delay = int(rng.integers(_DELAY[0], _DELAY[1] + 1))
    balls = _balls(rng)
    while not _within_reach(arm, balls):
        balls = _balls(rng)
    from ir50p_lab.vision.rendering import CAMERA_BENCH, LOOKS_AT_BENCH, bench_camera, look_at  # OpenCV: not at import

    eye = CAMERA_BENCH + rng.uniform(-_EYE, _EYE, 3)
    aim = LOOKS_AT_BENCH + np.array([*rng.uniform(-_AIM, _AIM, 2), 0])
    pinhole = replace(bench_camera()[0], distortion=())  # its pictures are straight
    return Drawn(arm, delay, balls, pinhole, look_at(eye, aim), seed)


def _factors(rng, limits):
    return np.exp(rng.uniform(*np.log(limits), 3))


def _arm(rng, seed):
    l = np.array(IR50P.l) * rng.uniform(*_LENGTH, 3)
    scale = l / np.array(IR50P.l)
    mass = _factors(rng, _MASS)
    lc = np.array(IR50P.lc) * scale * rng.uniform(*_CENTRE, 3)
    inertia = {name: np.array(getattr(IR50P, name)) * mass * scale**2 for name in ("Ixx", "Iyy", "Izz")}
    motors = IR50P.actuators
    stall = motors.stall_torque * _factors(rng, _STALL)
    fast, rotor = motors.no_load_speed * _factors(rng, _NO_LOAD), motors.reflected_inertia * _factors(rng, _ROTOR)
    fc = np.array(IR50P.friction.fc) * _factors(rng, _DRY)
    offset = rng.uniform(-_OFFSET, _OFFSET, 3) * stall / motors.limit_pwm
    return Arm(
        name=f"unknown {seed}",
        l=l,
        m=np.array(IR50P.m) * mass,
        lc=np.minimum(lc, l),
        **inertia,
        friction=Friction(fc=fc, fs=fc * rng.uniform(*_BREAKAWAY, 3), Tf=offset),
        actuators=Actuators.from_joint_data(
            stall_torque=stall, no_load_speed=fast, reflected_inertia=rotor, N=motors.N, V=motors.V
        ),
        q_min=IR50P.q_min,
        q_max=IR50P.q_max,
    )


def _bears_its_weight(arm):
    weight = arm.g * np.array([0, arm.theta[1, 2] + arm.theta[1, 3], arm.theta[2, 3]])
    return bool(np.all(weight + arm.friction.fs < _SHARE * arm.actuators.stall_torque))


def _balls(rng):
    r, angle = rng.uniform(*_AWAY, 3), rng.uniform(-_ASIDE, _ASIDE, 3)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(3, RADIUS)])


def _within_reach(arm, balls):
    gaps = [np.linalg.norm(a - b) for a, b in itertools.combinations(balls, 2)]
    return min(gaps) > _APART and all(_pose_above(arm, ball) for ball in balls)


def _pose_above(arm, ball):
    """Tell whether the tip stands over a ball with the elbow up, well inside the limits."""
    low, high = np.array(arm.q_min) + 0.02, np.array(arm.q_max) - 0.02
    try:
        poses = inverse_kinematics(arm, ball + np.array([0, 0, ABOVE])).q
    except UnreachableError:
        return False
    return any(q[2] < 0 and np.all(q > low) and np.all(q < high) for q in poses)
