"""Notebooks 14 and 15: what check says of wrong answers, and which right ones it takes."""

import re

import pytest
from told import told_of_body


def law(v="qdd + kd * (rate - qd) + kp * (place - q)", u="model(q, qd, v)", read="place, rate, qdd = reference"):
    return f"{read}\n    v = {v}\n    return {u}"


ROWS = "theta = theta.copy()\n    for j in range(3):\n        theta[j] -= dt * gain[j] * Y[j] * s[j]\n    return theta"
WRONG = [  # function, its body, what is said
    ("computed_torque", law("qdd - kd * (rate - qd) - kp * (place - q)"), "both errors have the wrong sign"),
    ("computed_torque", law("kd * (rate - qd) + kp * (place - q)"), "the plan's own is missing"),
    ("computed_torque", law("qdd - kd * qd - kp * (q - place)"), "counts the whole speed"),
    ("computed_torque", law("qdd - kd * (q - place) - kp * (qd - rate)"), "changed places"),
    ("computed_torque", law("qdd", "model(q, qd, v) + kd * (rate - qd) + kp * (place - q)"), "outside the model"),
    ("computed_torque", law(u="model(place, rate, v)"), "given the planned ones"),
    ("computed_torque", law(u="v"), "never asked"),
    ("computed_torque", law(u="model(q, qd, 0.01 * v)"), ""),
    ("computed_torque", law("qdd + kd @ (rate - qd) + kp @ (place - q)"), ""),
    ("computed_torque", "e = reference[0]\n    e -= q\n    return model(q, qd, reference[2] + kp * e)", ""),
    ("adaptive_step", "return theta + dt * gain * Y * s.reshape(3, 1)", "away from what is right"),
    ("adaptive_step", "return theta - dt * gain * (Y.T @ s)", "the s of its own joint"),
    ("adaptive_step", "return theta - gain * Y * s[:, None]", "dt is missing"),
    ("adaptive_step", "return theta - dt * gain * s[:, None]", "Y is missing"),
    ("adaptive_step", "return theta - dt * Y * s[:, None]", "table of gains"),
    ("adaptive_step", "return -dt * gain * Y * s[:, None]", "only the change"),
    ("adaptive_step", "return theta - dt * gain * Y * s", "\\(3, *20\\)"),
    ("adaptive_step", "return theta - dt * gain * Y * s[::-1, None]", "another joint"),
    ("adaptive_step", "theta -= dt * gain * Y * s[:, None]\n    return theta", "changes what it was given"),
    ("adaptive_step", "return theta * (1 - dt * gain * Y * s[:, None])", ""),
]


@pytest.mark.parametrize(("name", "body", "words"), WRONG, ids=range(len(WRONG)))
def test_a_wrong_answer_is_told_by_its_symptom(capsys, name, body, words):
    says = told_of_body(capsys, name, body)
    assert "not yet" in says and re.search(words, says), says


MATRIX = (
    "rest = model(q, qd, np.zeros(3))\n"
    "    M = np.column_stack([model(q, qd, one) - rest for one in np.eye(3)])\n"
    "    v = reference[2] + kd * (reference[1] - qd) + kp * (reference[0] - q)\n"
    "    return M @ v + rest"
)
ROUTES = [
    ("computed_torque", law("qdd - kd * (qd - rate) - kp * (q - place)")),
    ("computed_torque", MATRIX),
    ("adaptive_step", ROWS),
    ("adaptive_step", "return theta - dt * (gain * (np.diag(s) @ Y))"),
]


@pytest.mark.parametrize(("name", "body"), ROUTES, ids=range(len(ROUTES)))
def test_other_routes_are_right(capsys, name, body):
    assert "right, and yours" in told_of_body(capsys, name, body)
