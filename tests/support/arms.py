"""Random arms and states, and the same arm in MuJoCo: an engine that shares no line with ours."""

import mujoco
import numpy as np

from ir50p_lab.modelling import Actuators, Arm, Friction


def random_arm(rng, *, viscous=True, coulomb=False):
    """A valid arm drawn at random: lengths 0.1-1 m, masses 0.2-4 kg, inertias that some rigid body has."""
    spread = rng.uniform(1e-4, 5e-2, (3, 3))  # int x^2 dm, int y^2 dm, int z^2 dm of each link
    Ixx, Iyy, Izz = spread[:, 1] + spread[:, 2], spread[:, 0] + spread[:, 2], spread[:, 0] + spread[:, 1]
    l = rng.uniform(0.1, 1.0, 3)
    friction = Friction(
        fv=rng.uniform(0, 1, 3) if viscous else (0, 0, 0),
        fc=rng.uniform(0, 1, 3) if coulomb else (0, 0, 0),
        Tf=rng.normal(0, 0.1, 3) if coulomb else (0, 0, 0),
    )
    actuators = Actuators.from_joint_data(
        stall_torque=rng.uniform(2, 10, 3),
        no_load_speed=rng.uniform(1, 5, 3),
        reflected_inertia=rng.uniform(0.01, 0.3, 3),
        N=rng.uniform(20, 200, 3),
        V=24.0,
    )
    return Arm(
        name="random",
        l=l,
        m=rng.uniform(0.2, 4, 3),
        lc=rng.uniform(0.1, 0.9, 3) * l,
        Ixx=Ixx,
        Iyy=Iyy,
        Izz=Izz,
        friction=friction,
        actuators=actuators,
    )


def random_states(rng, n):
    """Poses over the whole circle, velocities of a few rad/s, accelerations or torques of tens: (n, 3) each."""
    return rng.uniform(-np.pi, np.pi, (n, 3)), rng.normal(0, 3, (n, 3)), rng.normal(0, 10, (n, 3))


def mujoco_model(arm, *, timestep=0.001):
    """The arm as a MuJoCo model: link frames, rotor inertia as armature, viscous friction as damping."""
    return mujoco.MjModel.from_xml_string(mujoco_xml(arm, timestep=timestep))


def mujoco_xml(arm, *, timestep=0.001):
    """The text of that model; joints are named joint1 .. joint3."""
    armature = np.zeros(3) if arm.actuators is None else arm.actuators.reflected_inertia
    text = ""
    places = ("0 0 0", f"0 0 {arm.l[0]!r}", f"{arm.l[1]!r} 0 0")
    turns = ("1 0 0 0", "0.7071067811865476 0.7071067811865476 0 0", "1 0 0 0")
    centres = (f"0 0 {arm.lc[0]!r}", f"{arm.lc[1]!r} 0 0", f"{arm.lc[2]!r} 0 0")
    for i in range(3):
        inertia = f"{arm.Ixx[i]!r} {arm.Iyy[i]!r} {arm.Izz[i]!r}"
        text += (
            f'<body pos="{places[i]}" quat="{turns[i]}">'
            f'<joint name="joint{i + 1}" type="hinge" axis="0 0 1" armature="{float(armature[i])!r}" damping="{arm.friction.fv[i]!r}"/>'
            f'<inertial pos="{centres[i]}" mass="{arm.m[i]!r}" diaginertia="{inertia}"/>'
        )
    text += f'<site name="tip" pos="{arm.l[2]!r} 0 0"/>' + "</body>" * 3
    return (
        f'<mujoco><option gravity="0 0 {-arm.g!r}" timestep="{timestep!r}" integrator="RK4"/>'
        f"<worldbody>{text}</worldbody></mujoco>"
    )
