"""Speed of simulations beside MuJoCo in the same run: `pytest tests/benchmarks --benchmark-enable -s`.

The same arm, friction off, PD with torque limits, 10 s, Runge-Kutta at 1 ms, command held for 10 ms. Ratios count.
"""

import time

import mujoco
import numpy as np
from arms import mujoco_model

from ir50p_lab.controllers import PID
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate

ARM = IR50P.without_friction()
TARGET, KP, KD, LIMIT = np.array([1.0, 0.5, -0.7]), np.full(3, 50.0), np.full(3, 5.0), 20.0


def ours(duration=10.0):
    return simulate(ARM, PID(kp=KP, kd=KD, limit=LIMIT, filter_hz=np.inf), TARGET, duration=duration)


def mujoco_python_loop(periods=1000):
    """MuJoCo stepped from Python: the command every 10 ms, ten Runge-Kutta steps between."""
    model = mujoco_model(ARM)
    data = mujoco.MjData(model)
    last = np.zeros(3)
    for _ in range(periods):
        velocity, last = (data.qpos - last) / 0.01, data.qpos.copy()
        data.qfrc_applied[:] = np.clip(KP * (TARGET - data.qpos) - KD * velocity, -LIMIT, LIMIT)
        mujoco.mj_step(model, data, 10)
    return data.qpos.copy()


def best_of(call, repeats):
    """Shortest of `repeats` calls, s."""
    call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def test_both_ways_end_in_the_same_pose():
    np.testing.assert_allclose(ours(1.0).q[-1], mujoco_python_loop(100), atol=1e-6)


def test_single_simulation_against_mujocos_python_loop(request):
    full = request.config.getoption("benchmark_enable")
    mine, peer = best_of(ours, 20 if full else 1), best_of(mujoco_python_loop, 8 if full else 1)
    print(
        f"\nsingle simulation of 10 s: ours {mine * 1e3:.2f} ms, MuJoCo {peer * 1e3:.1f} ms: {peer / mine:.0f}x (target 35x)"
    )
