"""Speed of simulations beside MuJoCo in the same run: `pytest tests/benchmarks --benchmark-enable -s`.

The same arm, friction off, PD with torque limits, 10 s, Runge-Kutta at 1 ms, command held for 10 ms. Ratios count.
"""

import time

import mujoco
import mujoco.rollout
import numpy as np
from arms import mujoco_model, mujoco_xml

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


def servo_model(kp, kd):
    """The arm with PD servos as affine actuators: what `mujoco.rollout` can run without Python in the loop."""
    spec = mujoco.MjSpec.from_string(mujoco_xml(ARM))
    for i, joint in enumerate(spec.joints):
        actuator = spec.add_actuator(name=f"servo{i}", target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        actuator.biastype = mujoco.mjtBias.mjBIAS_AFFINE
        actuator.gainprm[0] = kp[i]
        actuator.biasprm[1:3] = -kp[i], -kd[i]
        actuator.forcelimited, actuator.forcerange = True, (-LIMIT, LIMIT)
    return spec.compile()


def rollout(models, steps):
    """All models for `steps` steps of 1 ms on two threads; returns the last angles (N, 3)."""
    data = [mujoco.MjData(models[0]) for _ in range(2)]
    size = mujoco.mj_stateSize(models[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    states, _ = mujoco.rollout.rollout(
        models, data, np.zeros((len(models), size)), np.broadcast_to(TARGET, (len(models), steps, 3))
    )
    return states[:, -1, 1:4]


def best_of(call, repeats):
    """Shortest of `repeats` calls, s."""
    call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def test_all_ways_end_in_the_same_pose():
    np.testing.assert_allclose(ours(1.0).q[-1], mujoco_python_loop(100), atol=1e-6)
    # the servos of the rollout act in continuous time: the same set point, reached a little differently
    settled = rollout([servo_model(KP, KD)], 5000)[0]
    np.testing.assert_allclose(ours(5.0).q[-1], settled, atol=1e-4)


def test_single_simulation_against_mujocos_python_loop(request):
    full = request.config.getoption("benchmark_enable")
    mine, peer = best_of(ours, 20 if full else 1), best_of(mujoco_python_loop, 8 if full else 1)
    print(
        f"\nsingle simulation of 10 s: ours {mine * 1e3:.2f} ms, MuJoCo {peer * 1e3:.1f} ms: {peer / mine:.0f}x (target 35x)"
    )
