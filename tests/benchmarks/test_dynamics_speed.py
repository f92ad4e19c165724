"""Speed of the dynamics beside MuJoCo in the same run: `pytest tests/benchmarks --benchmark-enable -s`.

Ratios, not times, are what counts: the machine is the same for both. The targets are printed with the result.
"""

import time

import mujoco
import numpy as np
import pytest
from arms import mujoco_model, random_states
from numba import njit

from ir50p_lab.modelling import IR50P, forward_dynamics
from ir50p_lab.modelling import closed_form as cf

ARM = IR50P.without_friction()
q, qd, tau = (x[0] for x in random_states(np.random.default_rng(0), 1))


@njit(cache=True)
def many_forward(theta, gravity, q, qd, tau, n):
    """n forward dynamics one after the other, each with a little of the last result, so that none is left out."""
    total = 0.0
    for _ in range(n):
        A, B, C, _ = cf.forward(theta, gravity, q[1], q[2] + 1e-12 * total, qd[0], qd[1], qd[2], tau[0], tau[1], tau[2])
        total += A + B + C
    return total


def mujoco_forward():
    model = mujoco_model(ARM)
    data = mujoco.MjData(model)

    def set_state_and_forward():
        data.qpos[:] = q
        data.qvel[:] = qd
        data.qfrc_applied[:] = tau
        mujoco.mj_forward(model, data)
        return data.qacc

    return set_state_and_forward


def best_of(call, number, repeats=15):
    """Shortest time per call of `repeats` batches, s."""
    call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        for _ in range(number):
            call()
        times.append((time.perf_counter() - start) / number)
    return min(times)


def ours():
    return forward_dynamics(ARM, q, qd, tau)


def test_both_compute_the_same():
    np.testing.assert_allclose(ours(), mujoco_forward()(), rtol=1e-9)


@pytest.mark.benchmark(group="forward dynamics called from Python")
@pytest.mark.parametrize("engine", ["ours", "mujoco"])
def test_forward_from_python(benchmark, engine):
    benchmark({"ours": ours, "mujoco": mujoco_forward()}[engine])


def test_ratios_to_mujoco(request):
    if not request.config.getoption("benchmark_enable"):
        number, loop = 1, 10  # the plain test run only sees that it works
    else:
        number, loop = 20_000, 1_000_000
    peer = best_of(mujoco_forward(), number)
    from_python = best_of(ours, number)
    in_a_loop = best_of(lambda: many_forward(ARM.kernel_theta, ARM.g, q, qd, tau, loop), 1, repeats=5) / loop
    print(
        f"\nforward dynamics, MuJoCo set state and mj_forward {peer * 1e6:.2f} us; "
        f"ours from Python {from_python * 1e6:.2f} us: {peer / from_python:.1f}x (target 2x); "
        f"in a jitted loop {in_a_loop * 1e9:.0f} ns: {peer / in_a_loop:.0f}x (target 20x)"
    )
    assert np.isfinite(many_forward(ARM.kernel_theta, ARM.g, q, qd, tau, 10))
