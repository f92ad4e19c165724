"""Steps, ways, friction and motors: which right answers check takes; a spring balance."""

import numpy as np
import pytest
from told import told

from ir50p_lab.course import my_robot, parts
from ir50p_lab.course.motion import friction_views as views
from ir50p_lab.modelling import IR50P

DRY = "dry = fc + (fs - fc) * np.exp(-((qd / qs) ** 2))"
SUM = "return fv * qd + np.sign(qd) * dry + offset"
MOTOR = "gain * u_pwm - damping * qd"


RIGHT = [
    ("integrate", "dt * np.arange(steps + 1)", "np.linspace(0, duration, steps + 1)"),
    ("quintic", "return q, qd, qdd", "return np.array([q, qd, qdd])"),
    ("quintic", "(10 * s**3 - 15 * s**4 + 6 * s**5)", "s**3 * (10 - 15 * s + 6 * s**2)"),
    ("friction_torque", SUM, "return offset + fv * qd + np.where(qd == 0, 0, np.copysign(dry, qd))"),
    ("friction_torque", SUM, "return np.array([fv[i] * qd[i] + np.sign(qd[i]) * dry[i] + offset[i] for i in range(3)])"),
    ("friction_torque", DRY, "fade = np.exp(-np.abs(qd / qs) ** 2); dry = fc * (1 - fade) + fs * fade"),
    ("motor_torque", MOTOR, "gain * np.clip(u_pwm, -255, 255) - damping * qd"),
    ("motor_torque", MOTOR, "np.diag(gain) @ u_pwm - np.diag(damping) @ qd"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "old", "new"), RIGHT)
def test_right_ones_of_another_shape_are_kept(name, old, new, capsys):
    assert "right, and yours" in told(capsys, name, old, new)


@pytest.mark.parametrize("wires", ["cut", "joined"])
@pytest.mark.parametrize("speed", [0.03, -0.5])
def test_the_spring_balance_shows_friction_and_brake(speed, wires):
    own = parts(IR50P)
    law = my_robot.friction_torque(np.array([speed, 0, 0]), *own[5:10])[0] + own.damping[0] * speed * (
        wires == "joined"
    )
    assert views.dragged(IR50P, speed, wires=wires) == pytest.approx(law, abs=1e-6)
