"""mass_matrix: how hard the joints are to turn, each by itself and one through another."""

import numpy as np

from ir50p_lab.course.checking.task import sentences, task_of
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian


def mass_matrix(q, l, m, lc, inertia, rotor):
    """Return the inertia of the arm as its joints feel it, (3, 3) kg m^2    (1.90 corrected)."""
    T = frames(q, l)
    along = [T[0][:3, 2], T[2][:3, 0], T[3][:3, 0]]
    M = np.diag(rotor)
    for link in range(3):
        centre = T[link][:3, 3] + lc[link] * along[link]
        J = jacobian(T, link + 1, centre)
        moves = J[:3]
        turns = J[3:]
        axes = T[link + 1][:3, :3]
        seen_from_base = axes @ inertia[link] @ axes.T
        M = M + m[link] * moves.T @ moves + turns.T @ seen_from_base @ turns
    return M


def _whole_arms(rng):
    """Nine arms, links of about 1 kg and 1 m: inertias as large as what the masses give, in any axes."""
    for k in range(9):
        l, m = rng.uniform(0.4, 1.2, 3), rng.uniform(0.5, 2, 3)
        turns = np.linalg.qr(rng.normal(size=(3, 3, 3)))[0]
        inertia = turns @ (rng.uniform(0.3, 0.5, (3, 3, 1)) * turns.transpose(0, 2, 1))
        rotor = rng.uniform(0.1, 0.5, 3) * (k != 4)
        yield rng.uniform(-2, 2, 3), l, m, l * rng.uniform(0.2, 0.8, 3), inertia, rotor


def _cases():
    """Whole arms, then one taken apart: the mass of one link alone, the inertia of one, the rotors alone."""
    cases = list(_whole_arms(np.random.default_rng(51)))
    q, l, m, lc, inertia, rotor = cases[0]
    for link in range(3):
        only = np.eye(3)[link]
        cases.append((q, l, m * only, lc, np.zeros((3, 3, 3)), np.zeros(3)))
        cases.append((q, l, np.zeros(3), lc, inertia * only[:, None, None], np.zeros(3)))
    return [*cases, (q, l, np.zeros(3), lc, np.zeros((3, 3, 3)), rotor)]


_SAYS = sentences("mass_matrix", __file__)


def _symptom(case, returned, expected):
    """Of an arm taken apart: which part is wrong."""
    _, _, m, _, inertia, rotor = case
    given = {"mass": m, "inertia": inertia.any(axis=(1, 2)), "rotor": rotor}
    there = [name for name, values in given.items() if np.any(values)]
    return _SAYS[there[0]].format(1 + np.argmax(given[there[0]])) if len(there) == 1 else ""


TASK = task_of(
    mass_matrix,
    cases=_cases,
    leans_on=("jacobian", "frames", "dh_matrix", "rot_z"),
    tolerance=3e-5,  # a jacobian by differences is right within 1e-5
    unit="kg m^2",
    symptom=_symptom,
)
