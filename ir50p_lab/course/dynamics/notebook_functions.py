"""Functions of 04 and 05 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.task import notebook_tasks
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian
from ir50p_lab.course.robot.arm_numbers import parts
from ir50p_lab.modelling import forward_dynamics, gravity, inverse_dynamics, load_arm


def centres(T, lc):
    """Return the centres of mass of the three links, (3, 3) m, one row per link."""
    along = T[0][:3, 2], T[2][:3, 0], T[3][:3, 0]
    return np.array([T[k][:3, 3] + lc[k] * along[k] for k in range(3)])


def heaviness(J, M, direction):
    """Return how heavy the tip is, kg, pushed along a unit vector and free to slip aside; inf if nothing starts.

    1 / (d^T J M^-1 J^T d)
    """
    starts = direction @ J @ np.linalg.solve(M, J.T @ direction)
    return 1 / starts if starts > 1e-12 else np.inf


def shoulder_holds(q, load):
    """Return the torque (N m) of the shoulder that holds the arm in the pose q, with a load (kg) at its tip."""
    arm = load_arm()
    return gravity(arm, q)[1] + load * arm.g * _of_tip(arm, q)[2, 1]


def lump_torque(q, qd):
    """Return torques (3,) N m that carry the forearm, as a lump at its centre, while all joints keep their speeds."""
    return _lump(q, qd, _centre)


def torque(q, qd, qdd):
    """Return the torques (3,) N m of a motion, without friction    (1.74)."""
    return inverse_dynamics(load_arm().without_friction(), q, qd, qdd)


def acceleration(q, qd, tau):
    """Return the accelerations (3,) rad/s² that torques (3,) N m make, without friction."""
    arm = load_arm().without_friction()
    return forward_dynamics(arm.theta, q, qd, tau, g=arm.g)


def _of_tip(arm, q):
    T = frames(q, np.array(arm.l))
    return jacobian(T, 3, T[3][:3, 3])


def _centre(T, numbers):
    return T[2][:3, 3] + numbers.lc[2] * T[3][:3, 0]


def _lump(q, qd, pushed_at, d=1e-3):
    numbers = parts(load_arm())
    before, now, after = (frames(q + step * qd, numbers.l) for step in (-d, 0, d))
    change = (_centre(after, numbers) - 2 * _centre(now, numbers) + _centre(before, numbers)) / d**2
    J = jacobian(now, 3, pushed_at(now, numbers))[:3]
    return J.T @ (numbers.m[2] * change)


# ------------------------------------------------------------------------------------------------------ tried on
def _places():
    rng = np.random.default_rng(41)
    cases = []
    for _ in range(5):
        l = rng.uniform(0.2, 0.4, 3)
        cases.append((frames(rng.uniform(-1.5, 1.5, 3), l), l * rng.uniform(0.2, 0.8, 3)))
    return cases


def _tips():
    rng = np.random.default_rng(42)
    cases = []
    for k in range(6):
        J, root, way = rng.normal(size=(3, 3)), rng.normal(size=(3, 3)), rng.normal(size=3)
        if k == 5:
            J[0], way = 1e-17, np.array([1.0, 0, 0])  # nothing starts
        cases.append((J, root @ root.T + np.eye(3), way / np.linalg.norm(way)))
    return cases


def _loads():
    poses = np.random.default_rng(43).uniform(-1.5, 1.5, (6, 3))
    return [(q, 0.5 * k) for k, q in enumerate(poses)]


def _states(arguments):
    rows = np.random.default_rng(44).uniform(-2, 2, (6, arguments, 3))
    return [tuple(row) for row in rows]


TASKS = notebook_tasks(
    __file__,
    centres=(centres, _places, "the three centres, (3, 3), a row for each link", {"unit": "m"}),
    heaviness=(heaviness, _tips, "kilograms; np.inf where nothing starts", {"tolerance": 1e-6, "unit": "kg"}),
    shoulder_holds=(shoulder_holds, _loads, "the torque of the shoulder, N m", {"tolerance": 1e-6, "unit": "N m"}),
    lump_torque=(lump_torque, lambda: _states(2), "three torques, N m", {"tolerance": 1e-4, "unit": "N m"}),
    torque=(torque, lambda: _states(3), "three torques, N m", {"tolerance": 1e-3, "unit": "N m"}),
    acceleration=(
        acceleration,
        lambda: _states(3),
        "three accelerations, rad/s²",
        {"tolerance": 0.02, "unit": "rad/s²"},
    ),
)
