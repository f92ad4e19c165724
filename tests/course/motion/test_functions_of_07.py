"""Friction and motors: what check says of wrong answers, and which right ones it takes."""

import re

import numpy as np
import pytest
from told import told

from ir50p_lab.course import my_robot, parts
from ir50p_lab.course.motion import friction_views as views
from ir50p_lab.modelling import IR50P

DRY = "dry = fc + (fs - fc) * np.exp(-((qd / qs) ** 2))"
SUM = "return fv * qd + np.sign(qd) * dry + offset"
MOTOR = "gain * u_pwm - damping * qd"


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    my_robot._said.clear()


WRONG = [
    ("friction_torque", SUM, "return -fv * qd - np.sign(qd) * dry - offset", "sign of a torque that acts|wrong sign"),
    ("friction_torque", SUM, "return fv * qd + np.sign(qd) * dry - offset", "offset .*wrong sign"),
    ("friction_torque", SUM, "return fv * qd + np.sign(qd) * (dry + offset)", "twice the offset"),
    ("friction_torque", SUM, "return np.sign(qd) * (fv * qd + dry) + offset", "grease pushes along"),
    ("friction_torque", SUM, "return np.sign(qd) * dry + offset", "viscous part is missing|fv does nothing"),
    ("friction_torque", "-((qd / qs) ** 2)", "-2 * qd / qs", "forwards it is right, backwards it is not"),
    ("friction_torque", SUM, "return fv * qd + dry + offset", "backwards it pushes along|ask for the direction"),
    ("friction_torque", SUM, "return fv * qd + np.where(qd > 0, dry, -dry) + offset", "at rest gets dry friction"),
    ("friction_torque", SUM, "return fv * qd + np.where(qd < 0, -dry, dry) + offset", "at rest gets dry friction"),
    ("friction_torque", SUM, "return fv * qd + np.tanh(qd / 0.01) * dry + offset", "slow one is not|near rest"),
    ("friction_torque", SUM, "return fv * qd + np.tanh(qd / qs) * dry + offset", "near rest the dry part is too weak"),
    ("friction_torque", SUM, "return fv * qd + qd / np.abs(qd) * dry + offset", "division by (a )?zero|not finite"),
    ("friction_torque", DRY, "dry = fs + (fc - fs) * np.exp(-((qd / qs) ** 2))", "other way round|changed places"),
    ("friction_torque", DRY, "dry = fc + (fs - fc) * np.exp(-np.abs(qd / qs))", "squared"),
    ("friction_torque", DRY, "dry = fc + (fs - fc) * np.exp(-np.abs(qd) / qs**2)", "pure number"),
    ("friction_torque", DRY, "dry = fc + fs * np.exp(-((qd / qs) ** 2))", "more than its breakaway torque"),
    ("friction_torque", DRY, "dry = np.where(np.abs(qd) < qs, fs, fc)", "in one step, at qs"),
    ("friction_torque", DRY, "dry = fc + (fs - fc) * np.exp(-np.abs(qd / qs) ** 3)", "a slow one is not"),
    ("friction_torque", DRY, "dry = fc + (fs - fc) / (1 + (qd / qs) ** 2)", "a slow one is not"),
    ("friction_torque", DRY, "import math; dry = fc + (fs - fc) * math.exp(-((qd / qs) ** 2))", "three numbers|one number"),
    ("friction_torque", SUM, "return np.abs(fv * qd + np.sign(qd) * dry + offset)", "turns round with the motion"),
    ("friction_torque", SUM, "return np.where(qd == 0, fs, fv * qd + np.sign(qd) * dry + offset)", "gets its breakaway"),
    ("friction_torque", SUM, "return np.where(qd == 0, 0, fv * qd + np.sign(qd) * dry + offset)", "lacks its offset"),
    ("motor_torque", MOTOR, "gain * u_pwm + damping * qd", "must take, not give|wrong sign"),
    ("motor_torque", MOTOR, "gain * u_pwm", "is a generator|does nothing"),
    ("motor_torque", MOTOR, "gain * u_pwm / 255 - damping * qd", "255 times too little"),
    ("motor_torque", MOTOR, "255 * gain * u_pwm - damping * qd", "255 times too much"),
    ("motor_torque", MOTOR, "12 / 255 * u_pwm * gain - damping * qd", "no volts are needed"),
    ("motor_torque", MOTOR, "12 * u_pwm / gain - damping * qd", "stands still is wrong already"),
    ("motor_torque", MOTOR, "u_pwm / gain - damping * qd", "the gain divides"),
    ("motor_torque", MOTOR, "gain * (u_pwm - damping * qd)", "the gain multiplies it"),
    ("motor_torque", MOTOR, "gain * u_pwm - damping * np.sign(qd)", "same at any speed"),
    ("motor_torque", MOTOR, "gain * u_pwm - damping * np.abs(qd)", "lost its (direction|sign)|without its sign"),
    ("motor_torque", MOTOR, "np.where(u_pwm == 0, 0, gain * u_pwm - damping * qd)", "at 0 counts it gives nothing"),
    ("motor_torque", MOTOR, "gain[0] * u_pwm - damping[0] * qd", "joint 1 is right"),
    ("motor_torque", MOTOR, "damping * u_pwm - gain * qd", "changed places"),
    ("motor_torque", MOTOR, "gain * np.clip(u_pwm, -100, 100) - damping * qd", "stands still is wrong already"),
    ("motor_torque", MOTOR, "np.clip(gain * u_pwm - damping * qd, 0, None)", "turned at 0 counts is wrong"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "old", "new", "words"), WRONG)
def test_a_mistake_is_named(name, old, new, words, capsys):
    said = told(capsys, name, old, new)
    assert "right, and yours" not in said
    assert re.search(words, said), said


RIGHT = [
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
