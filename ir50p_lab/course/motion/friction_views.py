"""Notebook 07: the torque that drags the waist, its picture, and a lift."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from ir50p_lab.controllers import PID
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.draw.traces import STAMP
from ir50p_lab.modelling.dynamics import mass_matrix
from ir50p_lab.modelling.friction import Friction
from ir50p_lab.signals import trapezoid
from ir50p_lab.simulation import simulate

_BRAKE = 1e4  # N m: a friction that nothing overcomes


def dragged(arm, speed, *, wires):
    """Return the torque that drags the waist at a steady speed, N m.

    Simulated: a stiff controller drags it, shoulder and elbow are held, and the third second is averaged.

    Args: arm: Arm; speed: rad/s, not 0; wires: of its motor, "cut", or "joined" as at 0 counts.
    """
    rub, brake = arm.friction, arm.actuators.back_emf_damping[0] * (wires == "joined")
    held = Friction(
        fv=(rub.fv[0] + brake, 0, 0),
        fc=(rub.fc[0], _BRAKE, _BRAKE),
        fs=(rub.fs[0], _BRAKE, _BRAKE),
        qs=rub.qs,
        Tf=(rub.Tf[0], 0, 0),
    )
    waist = mass_matrix(arm, np.zeros(3))[0, 0]
    stiff = PID(kp=(100 + 100 * waist, 0, 0), kd=(10 + 20 * waist, 0, 0), period=0.001, filter_hz=200)
    way = trapezoid(np.zeros(3), (4 * speed, 0, 0), v_max=abs(speed), a_max=50)
    return simulate(replace(arm, friction=held), stiff, way, duration=3, period=0.001).u[2000:, 0].mean()


def seconds_to_lift(arm, counts):
    """Return the time until these counts (3,) have lifted the shoulder of the level arm to 0.5 rad, s."""
    push = SimpleNamespace(unit="PWM", step=lambda t, q, reference: counts)
    lifted = simulate(arm, push, duration=5, stops=True, table=0.0)
    return lifted.t[np.argmax(lifted.q[:, 1] > 0.5)]


def friction_figure(speeds, torques, law=None):
    """Draw torques that drag a joint over its speed (dots), and a law of friction (Figure 1.9). Returns: LabFigure.

    Args: speeds, torques (n,): what was found, rad/s, N m; law: function of one speed, N m; None: dots alone.
    """
    figure, ax = subplots(8.0, 3.6, note=STAMP)
    ax.plot(speeds, torques, "o", color=COLOURS["orange"], label="torque that drags the waist")
    for side in (-1, 1) if law else ():
        fine = side * np.linspace(1e-4, 1.05 * np.max(speeds), 300)
        ax.plot(fine, [law(one) for one in fine], color=COLOURS["blue"], label="the law" if side > 0 else None)
    ax.axhline(0, color=COLOURS["grey"], linewidth=1)
    ax.set(xlabel="speed of the waist [rad/s]", ylabel="torque [N m]")
    ax.legend(loc="upper left")
    return figure
