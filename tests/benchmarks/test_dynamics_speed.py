"""Speed of single calls beside MuJoCo in the same run.

    python -m pytest tests/benchmarks/test_dynamics_speed.py --benchmark-enable -s

One state at a time, as in a student's loop or a live view: the peer sets its state and calls what gives the same
numbers. Ratios count: the machine is the same for both, and the two take turns.
"""

import time

import mujoco
import numpy as np
from arms import mujoco_model, random_states
from numba import njit

from ir50p_lab.modelling import (
    IR50P,
    coriolis_matrix,
    forward_dynamics,
    forward_kinematics,
    gravity,
    inverse_dynamics,
    inverse_kinematics,
    jacobian,
    mass_matrix,
)
from ir50p_lab.modelling import closed_form as cf

ARM = IR50P.without_friction()
q, qd, x = (states[0] for states in random_states(np.random.default_rng(0), 1))
p = forward_kinematics(ARM, q)


@njit(cache=True)
def many_forward(theta, gravity, q, qd, tau, n):
    """n forward dynamics one after the other, each with a little of the last result, so that none is left out."""
    total = 0.0
    for _ in range(n):
        A, B, C, _ = cf.forward(theta, gravity, q[1], q[2] + 1e-12 * total, qd[0], qd[1], qd[2], tau[0], tau[1], tau[2])
        total += A + B + C
    return total


class Peer:
    """MuJoCo's model of the arm: each method sets the state and calls the least that gives the numbers."""

    def __init__(self):
        self.model = mujoco_model(ARM)
        self.data = mujoco.MjData(self.model)
        self.M, self.J, self.tau = np.zeros((3, 3)), np.zeros((6, 3)), np.zeros(3)
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

    def bias(self, velocity):
        self.data.qvel[:] = velocity
        self.place()
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_comVel(self.model, self.data)
        mujoco.mj_rne(self.model, self.data, 0, self.tau)
        return self.tau

    def gravity(self):
        return self.bias(0.0)

    def coriolis_matrix(self):
        """The torques: MuJoCo does not have the matrix."""
        return self.bias(qd)

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
    gravity: (q,),
    coriolis_matrix: (q, qd),
    inverse_dynamics: (q, qd, x),
    forward_dynamics: (q, qd, x),
}
OF_A_THETA = {mass_matrix, gravity, coriolis_matrix, inverse_dynamics, forward_dynamics}


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
        if function is not coriolis_matrix:
            np.testing.assert_allclose(
                function(ARM, *state), getattr(Peer(), function.__name__)(), rtol=1e-9, atol=1e-12
            )
    np.testing.assert_allclose(coriolis_matrix(ARM, q, qd) @ qd + gravity(ARM, q), Peer().coriolis_matrix(), atol=1e-12)


def test_single_calls_beside_mujoco(request):
    number, rounds = (100, 1000) if request.config.getoption("benchmark_enable") else (1, 1)
    print(f"\n{'us of one call':<20}{'MuJoCo':>8}{'arrays':>8}{'lists':>8}{'theta':>8}{'ratio':>8}  target 2")
    for function, state in STATES.items():
        peer, lists = Peer(), [vector.tolist() for vector in state]
        calls = {
            "MuJoCo": getattr(peer, function.__name__),
            "arrays": lambda f=function, s=state: f(ARM, *s),
            "lists": lambda f=function, s=lists: f(ARM, *s),
        }
        if function in OF_A_THETA:
            calls["theta"] = lambda f=function, s=state: f(ARM.theta, *s)
        times = take_turns(calls, number, rounds)
        ratio = max(times.values()) / times["MuJoCo"]
        row = "".join(
            f"{1e6 * times[name]:8.2f}" if name in times else " " * 8 for name in ("MuJoCo", "arrays", "lists", "theta")
        )
        print(f"{function.__name__:<20}{row:<32}{ratio:8.2f}")
    ik = take_turns({"ik": lambda: inverse_kinematics(ARM, p)}, number, rounds)["ik"]
    print(f"inverse_kinematics, all branches: {1e6 * ik:.2f} us (target 10)")


def test_forward_dynamics_in_a_compiled_loop(request):
    rounds, loop = (5, 1_000_000) if request.config.getoption("benchmark_enable") else (1, 10)
    theta, peer = ARM.theta.copy(), Peer()
    times = take_turns({"MuJoCo": peer.forward_dynamics}, 1000 if loop > 10 else 1, rounds)
    times |= take_turns({"loop": lambda: many_forward(theta, ARM.g, q, qd, x, loop)}, 1, rounds)
    ours, theirs = times["loop"] / loop, times["MuJoCo"]
    print(
        f"\nforward dynamics in a compiled loop: {1e9 * ours:.0f} ns, mj_forward {theirs / ours:.0f}x that (target 20x)"
    )
    assert np.isfinite(many_forward(theta, ARM.g, q, qd, x, 10))
