"""Speed of single calls beside MuJoCo in the same run.

    python -m pytest tests/benchmarks/test_dynamics_speed.py --benchmark-enable -s

One state at a time, as in a student's loop or a live view: the peer sets its state and calls what gives the same
numbers. Ratios count: the machine is the same for both, and the two take turns.
"""

import time

import mujoco
import numpy as np
from arms import mujoco_model, random_states

from ir50p_lab.modelling import (
    IR50P,
    forward_dynamics,
    forward_kinematics,
    inverse_dynamics,
    inverse_kinematics,
    jacobian,
    mass_matrix,
)

ARM = IR50P.without_friction()
q, qd, x = (states[0] for states in random_states(np.random.default_rng(0), 1))
p = forward_kinematics(ARM, q)


class Peer:
    """MuJoCo's model of the arm: each method sets the state and calls the least that gives the numbers."""

    def __init__(self):
        self.model = mujoco_model(ARM)
        self.data = mujoco.MjData(self.model)
        self.M, self.J = np.zeros((3, 3)), np.zeros((6, 3))
        self.Jv, self.Jw = self.J[:3], self.J[3:]

    def place(self):
        self.data.qpos[:] = q
        mujoco.mj_kinematics(self.model, self.data)

    def forward_kinematics(self):
        self.place()
        return self.data.site_xpos[0]

    def jacobian(self):
        self.place()
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_jacSite(self.model, self.data, self.Jv, self.Jw, 0)
        return self.J

    def mass_matrix(self):
        self.place()
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_makeM(self.model, self.data)
        mujoco.mj_fullM(self.model, self.data, self.M)
        return self.M

    def inverse_dynamics(self):
        self.data.qpos[:], self.data.qvel[:], self.data.qacc[:] = q, qd, x
        mujoco.mj_inverse(self.model, self.data)
        return self.data.qfrc_inverse

    def forward_dynamics(self):
        self.data.qpos[:], self.data.qvel[:], self.data.qfrc_applied[:] = q, qd, x
        mujoco.mj_forward(self.model, self.data)
        return self.data.qacc


STATES = {
    forward_kinematics: (q,),
    jacobian: (q,),
    mass_matrix: (q,),
    inverse_dynamics: (q, qd, x),
    forward_dynamics: (q, qd, x),
}


def take_turns(calls, number, rounds):
    """Shortest time per call of every function in `calls`, s, over rounds in which each runs `number` times."""
    times = dict.fromkeys(calls, np.inf)
    for _ in range(rounds):
        for name, call in calls.items():
            start = time.perf_counter()
            for _ in range(number):
                call()
            times[name] = min(times[name], (time.perf_counter() - start) / number)
    return times


def test_both_compute_the_same():
    for function, state in STATES.items():
        np.testing.assert_allclose(function(ARM, *state), getattr(Peer(), function.__name__)(), rtol=1e-9, atol=1e-12)


def test_single_calls_beside_mujoco(request):
    number, rounds = (100, 1000) if request.config.getoption("benchmark_enable") else (1, 1)
    print(f"\n{'us of one call':<20}{'MuJoCo':>8}{'ours':>8}{'ratio':>8}  target 2")
    for function, state in STATES.items():
        calls = {"MuJoCo": getattr(Peer(), function.__name__), "ours": lambda f=function, s=state: f(ARM, *s)}
        theirs, ours = take_turns(calls, number, rounds).values()
        print(f"{function.__name__:<20}{1e6 * theirs:8.2f}{1e6 * ours:8.2f}{ours / theirs:8.2f}")
    ik = take_turns({"ik": lambda: inverse_kinematics(ARM, p)}, number, rounds)["ik"]
    print(f"inverse_kinematics, all branches: {1e6 * ik:.2f} us (target 10)")
