"""Taken home: MuJoCo reads what was written, and accelerates as the equations here say."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from arms import random_arm, random_states

from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.modelling import IR50P, Friction, forward_dynamics
from ir50p_lab.modelling.export import export_arm

mujoco = pytest.importorskip("mujoco")


def accelerations(path, states, torques):
    """qdd (n, 3) of a model that MuJoCo reads."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data, found = mujoco.MjData(model), []
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    for (q, qd), torque in zip(states, torques, strict=True):
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = q, qd, torque
        mujoco.mj_forward(model, data)
        found.append(data.qacc.copy())
    return np.array(found)


def drawn(n=20):
    rng = np.random.default_rng(3)
    q, qd, _ = random_states(rng, n)
    return list(zip(q, qd, strict=True)), rng.normal(0, 3, (n, 3))


def ours(arm, states, torques):
    return np.array([forward_dynamics(arm, *state, torque) for state, torque in zip(states, torques, strict=True)])


@pytest.mark.parametrize("seed", range(4))
def test_mjcf_moves_alike(tmp_path, seed):
    """With rotors and viscous friction; without back-EMF, for no motor is driven."""
    arm = IR50P if seed == 0 else random_arm(np.random.default_rng(seed))
    arm = replace(arm, friction=Friction(fv=(0.3, 0.2, 0.1)))
    states, torques = drawn()
    path = export_arm(replace(arm, actuators=None) if seed % 2 else arm, tmp_path / "arm.xml")
    arm = replace(arm, actuators=None) if seed % 2 else arm
    text = path.read_text("utf-8")
    start, _, rest = text.partition("<actuator>")  # at 0 counts a motor would brake
    path.write_text(start + rest.partition("</actuator>")[2] if rest else text, "utf-8")
    expected = ours(arm, states, torques)
    assert (
        np.abs(accelerations(path, states, torques) / np.abs(expected).max() - expected / np.abs(expected).max()).max()
        < 1e-9
    )


def test_urdf_moves_alike_without_rotors_and_friction(tmp_path):
    arm = replace(IR50P, actuators=None, friction=Friction())
    states, torques = drawn()
    expected = ours(arm, states, torques)
    found = accelerations(export_arm(arm, tmp_path / "arm.urdf"), states, torques)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_motors_give_counts_and_brake(tmp_path):
    arm = replace(IR50P, friction=Friction())
    model = mujoco.MjModel.from_xml_path(str(export_arm(arm, tmp_path / "arm.xml")))
    data = mujoco.MjData(model)
    data.qvel[:], data.ctrl[:] = (0.3, -0.2, 0.5), (100, -50, 20)
    mujoco.mj_forward(model, data)
    torque = arm.actuators.gain * data.ctrl - arm.actuators.back_emf_damping * data.qvel
    np.testing.assert_allclose(data.qfrc_actuator, torque, rtol=1e-12)


def test_dry_friction_and_what_is_left_out_stand_in_the_file(tmp_path):
    text = export_arm(IR50P, tmp_path / "arm.xml").read_text("utf-8")
    assert f'frictionloss="{IR50P.friction.fc[0]!r}"' in text and "left out: breakaway" in text
    urdf = export_arm(IR50P, tmp_path / "arm.urdf").read_text("utf-8")
    assert "rotors" in urdf and f'friction="{IR50P.friction.fc[1]!r}"' in urdf


def test_an_estimate_becomes_bodies_that_move_alike(tmp_path):
    arm = replace(IR50P, friction=Friction(fv=(0.3, 0.2, 0.1)))
    gain = arm.actuators.gain
    found = SimpleNamespace(theta=arm.theta / gain[:, None], unit="PWM")
    states, torques = drawn()
    expected = ours(arm, states, torques)
    made = accelerations(export_arm(found, tmp_path / "arm.xml", gain=gain), states, torques)
    np.testing.assert_allclose(made, expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("arm", "name", "gain", "error", "words"),
    [
        (IR50P, "arm.obj", None, InputError, "end it in .xml"),
        (SimpleNamespace(theta=IR50P.theta_pwm, unit="PWM"), "arm.xml", None, InputError, "gain="),
        (SimpleNamespace(theta=-IR50P.theta_pwm, unit="PWM"), "arm.xml", (1, 1, 1), ArmError, "no rigid body"),
        ("arm", "arm.xml", None, InputError, "give an Arm"),
    ],
)
def test_what_is_missing_is_said(tmp_path, arm, name, gain, error, words):
    with pytest.raises(error, match=words):
        export_arm(arm, tmp_path / name, gain=gain)
