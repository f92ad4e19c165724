"""Functions of 04 and 05 that stay in their notebook: the course's, what each is tried on, typical mistakes."""

import numpy as np

from ir50p_lab.course.checking.task import Mistake, notebook_tasks
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian
from ir50p_lab.course.robot.arm_numbers import parts
from ir50p_lab.modelling import coriolis_matrix, forward_dynamics, gravity, inverse_dynamics, load_arm, mass_matrix


def centres(T, lc):
    """Centres of mass of the three links, (3, 3) m, a row a link."""
    along = T[0][:3, 2], T[2][:3, 0], T[3][:3, 0]
    return np.array([T[k][:3, 3] + lc[k] * along[k] for k in range(3)])


def heaviness(J, M, direction):
    """How heavy the tip is along a unit vector, pushed that way and free to slip aside, kg; inf where nothing starts.

    1 / (d^T J M^-1 J^T d)
    """
    starts = direction @ J @ np.linalg.solve(M, J.T @ direction)
    return 1 / starts if starts > 1e-12 else np.inf


def shoulder_holds(q, load):
    """Torque (N m) of the shoulder that holds the arm in the pose q, with a load (kg) at its tip."""
    arm = load_arm()
    return gravity(arm, q)[1] + load * arm.g * _of_tip(arm, q)[2, 1]


def lump_torque(q, qd):
    """Torques (3,) N m that carry the forearm, as a lump at its centre, while all joints keep their speeds."""
    return _lump(q, qd, lambda T, numbers: _centre(T, numbers))


def torque(q, qd, qdd):
    """The torques (3,) N m of a motion, without friction    (1.74)."""
    return inverse_dynamics(load_arm().without_friction(), q, qd, qdd)


def acceleration(q, qd, tau):
    """The accelerations (3,) rad/s² that torques (3,) N m make, without friction."""
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


# ------------------------------------------------------------------------------------------------- typical mistakes
def _whole_acceleration(J, M, direction):
    return 1 / np.linalg.norm(J @ np.linalg.solve(M, J.T @ direction))


def _not_turned(J, M, direction):
    return 1 / (direction @ J @ np.linalg.solve(M, J @ direction))


def _not_solved(J, M, direction):
    return 1 / (direction @ J @ M @ J.T @ direction)


def _guided(J, M, direction):
    return direction @ np.linalg.solve(J @ np.linalg.solve(M, J.T), direction)


def _without_g(q, load):
    return gravity(load_arm(), q)[1] + load * _of_tip(load_arm(), q)[2, 1]


def _load_alone(q, load):
    return load * load_arm().g * _of_tip(load_arm(), q)[2, 1]


def _pushed_at_the_tip(q, qd):
    return _lump(q, qd, lambda T, numbers: T[3][:3, 3])


def _speeds_forgotten(q, qd, qdd):
    return torque(q, 0 * qd, qdd)


def _weight_lifts(q, qd, qdd):
    return torque(q, qd, qdd) - 2 * gravity(load_arm(), q)


def _nothing_taken_off(q, qd, tau):
    return np.linalg.solve(mass_matrix(load_arm(), q), tau)


def _free_of_speeds(q, qd, tau):
    return np.linalg.solve(mass_matrix(load_arm(), q), tau - gravity(load_arm(), q))


def _taken_off_late(q, qd, tau):
    arm = load_arm()
    return np.linalg.solve(mass_matrix(arm, q), tau) - coriolis_matrix(arm, q, qd) @ qd - gravity(arm, q)


def _by_the_diagonal(q, qd, tau):
    arm = load_arm()
    return (tau - coriolis_matrix(arm, q, qd) @ qd - gravity(arm, q)) / np.diag(mass_matrix(arm, q))


_TOO_MUCH = "it takes the whole acceleration of the tip: your finger feels only what goes its way"
_TURN = "the push becomes torques by J instead of its transpose (03)"
_SOLVE = "it multiplies by M: torques are given, accelerations wanted"
_SLOT = "that is the tip guided in a slot: yours is free to slip aside"
_G = "the load has no weight in it: kilograms are no newtons"
_LINKS = "the links have no weight in it: the shoulder holds them, too"
_PLACE = "the force is pushed at the tip: it acts where the lump is"
_H = "nothing in it asks for the speeds alone"
_SIGN = "the weight helps to lift in it: look at the sign"
_LEFT = "the motors' torques go into accelerations alone: speeds and weight want their part first"
_LATE = "speeds and weight are taken off after solving: they are torques, too"
_ROWS = "each joint is moved by its own torque alone in it: M has more than a diagonal"

TASKS = notebook_tasks(
    __file__,
    centres=(centres, _places, "the three centres, (3, 3), a row a link", {"unit": "m"}),
    heaviness=(heaviness, _tips, "kilograms; np.inf where nothing starts", {
        "mistakes": (Mistake(_whole_acceleration, _TOO_MUCH), Mistake(_not_turned, _TURN), Mistake(_not_solved, _SOLVE),
                  Mistake(_guided, _SLOT)), "tolerance": 1e-6, "unit": "kg"}),
    shoulder_holds=(shoulder_holds, _loads, "the torque of the shoulder, a number in N m", {
        "mistakes": (Mistake(_without_g, _G), Mistake(_load_alone, _LINKS)), "tolerance": 1e-6, "unit": "N m"}),
    lump_torque=(lump_torque, lambda: _states(2), "three torques, N m", {
        "mistakes": (Mistake(_pushed_at_the_tip, _PLACE),), "tolerance": 1e-4, "unit": "N m"}),
    torque=(torque, lambda: _states(3), "three torques, N m", {
        "mistakes": (Mistake(_speeds_forgotten, _H), Mistake(_weight_lifts, _SIGN)), "tolerance": 1e-3, "unit": "N m"}),
    acceleration=(acceleration, lambda: _states(3), "three accelerations, rad/s²", {
        "mistakes": (Mistake(_nothing_taken_off, _LEFT), Mistake(_free_of_speeds, _H), Mistake(_taken_off_late, _LATE),
                  Mistake(_by_the_diagonal, _ROWS)), "tolerance": 0.02, "unit": "rad/s²"}),
)  # fmt: skip
