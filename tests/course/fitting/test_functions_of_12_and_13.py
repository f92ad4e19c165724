"""Notebooks 12 and 13: what check says of wrong answers, and which right ones it takes."""

import re

import numpy as np
import pytest
import solutions
from told import told_of_body

from ir50p_lab.course import my_robot
from ir50p_lab.identification import regressor as columns_of_the_package

LINES = "C = np.linalg.inv(A.T @ A)\n    theta = C @ A.T @ y\n    r = y - A @ theta\n    "
LEFT = "np.sum(r**2) / (len(y) - A.shape[1])"
WEIGHTS = "    Y[1, 2] = 9.81 * c2\n    Y[1, 3] = 9.81 * c23\n    Y[2, 3] = 9.81 * c23\n"
FRICTION = "    for j in range(3):\n        Y[j, 10 + 2 * j], Y[j, 11 + 2 * j], Y[j, 16 + j] = qd[j], direction[j], 1\n"


def of_rows(weights=WEIGHTS, friction=FRICTION):
    cosines = "    c2, c23 = np.cos(q[1]), np.cos(q[1] + q[2])\n"
    return f"Y = body_columns(q, qd, qdd)\n{cosines}{weights}{friction}    return Y"


def of_gain(
    gain="P @ phi / (forgetting + phi @ P @ phi)", theta="theta + K * (y - phi @ theta)", P="np.outer(K, phi @ P)"
):
    return f"K = {gain}\n    theta = {theta}\n    return theta, (P - {P}) / forgetting"


MISSED = "np.linalg.norm(measured - predicted)"
WRONG = [  # function, its body, what is said
    ("least_squares", f"{LINES}return theta, np.sqrt(np.diag(C) * r.var())", "about its own mean"),
    ("least_squares", f"{LINES}return theta, np.sqrt(np.diag(C) * np.mean(r**2))", "divided by n:"),
    ("least_squares", f"{LINES}return theta, np.sqrt(np.diag(C) * (r @ r) / (len(y) - 2))", "n - 2"),
    ("least_squares", f"{LINES}return theta, np.diag(C) * {LEFT}", "variances, squares"),
    ("least_squares", f"{LINES}return theta, np.sqrt({LEFT} / np.diag(A.T @ A))", "right angles"),
    ("least_squares", f"{LINES}return theta, np.sqrt(np.diag(C))", "do not depend on the noise"),
    ("least_squares", f"{LINES}return theta, C * {LEFT}", "a whole table"),
    ("least_squares", f"{LINES}return theta, np.sqrt(np.diag(C) * {LEFT}) / abs(theta)", "shares of theta"),
    ("least_squares", f"{LINES}return theta", "2 results"),
    ("least_squares", f"{LINES}return np.sqrt(np.diag(C) * {LEFT}), theta", "changed places"),
    ("regressor", of_rows(WEIGHTS.replace("c2\n", "np.sin(q[1])\n")), "row 2, column 3"),
    ("regressor", of_rows(WEIGHTS.replace("9.81 * ", "")), "not yet a weight"),
    ("regressor", of_rows(WEIGHTS.replace("9.81", "-9.81")), "wrong sign"),
    ("regressor", of_rows(WEIGHTS.replace("c23", "np.cos(q[2])")), "leans with it"),
    ("regressor", of_rows(WEIGHTS.replace("Y[1, 3] = 9.81 * c23", "Y[1, 3] = 0")), "carries the forearm as well"),
    ("regressor", of_rows(friction=FRICTION.replace("direction[j]", "np.sign(qd[j])")), "direction that came in"),
    ("regressor", of_rows(friction=FRICTION.replace("qd[j], direction[j]", "direction[j], qd[j]")), "other way round"),
    ("regressor", of_rows(friction=FRICTION.replace("Y[j", "Y[:")), "all joints"),
    ("regressor", of_rows(friction=FRICTION.replace("2 * j", "j")), "move on by one"),
    ("regressor", of_rows().replace("body_columns(q, qd, qdd)", "np.zeros((3, 20))"), "you start another"),
    ("rls_step", of_gain(theta="theta + K * y"), "uses y itself"),
    ("rls_step", of_gain(theta="theta + K * (phi @ theta - y)"), "wrong sign"),
    ("rls_step", of_gain(theta="theta + K * (-phi @ theta - y)"), "as \\(2.40\\) prints"),
    ("rls_step", of_gain("P @ phi / (1 + phi @ P @ phi)"), "while nothing is forgotten"),
    ("rls_step", of_gain("P @ phi"), "divided by one number"),
    ("rls_step", of_gain(P="0 * P"), "P is not|P stays|theta is right"),
    ("rls_step", of_gain(P="np.diag(K * (phi @ P))"), "off its diagonal"),
    ("rls_step", of_gain().replace("/ forgetting", "* forgetting").replace("P) * f", "P) * f"), "less sure"),
    ("rls_step", of_gain().replace("theta = theta + ", "theta += "), "changes what it was given"),
    ("rls_step", of_gain("P @ phi / (forgetting + phi @ np.linalg.inv(P) @ phi)"), "as \\(2.44\\) prints"),
    (
        "fit_percent",
        f"return 100 * (1 - {MISSED}**2 / np.sum((measured - measured.mean())**2))",
        "share of the variance",
    ),
    ("fit_percent", "return 100 * (1 - np.var(measured - predicted) / np.var(measured))", "share of the variance"),
    ("fit_percent", "return 100 * (1 - np.std(measured - predicted) / np.std(measured))", "3 counts too high"),
    ("fit_percent", f"return 100 * (1 - {MISSED} / np.linalg.norm(measured))", "measured from 0"),
    ("fit_percent", f"return 100 * (1 - {MISSED} / np.std(measured))", "both have to be the same"),
    ("fit_percent", f"return 1 - {MISSED} / np.linalg.norm(measured - measured.mean())", "a share, from 0 to 1"),
    ("fit_percent", f"return 100 * {MISSED} / np.linalg.norm(measured - measured.mean())", "what is missed"),
    ("fit_percent", f"return 100 - {MISSED} / np.linalg.norm(measured - measured.mean())", "turn it into percent"),
    ("fit_percent", "return 100 * (1 - np.mean(np.abs((measured - predicted) / measured)))", "by the value itself"),
    (
        "fit_percent",
        f"return 100 * (1 - {MISSED} / np.linalg.norm(predicted - predicted.mean()))",
        "scatters|not finite",
    ),
]


@pytest.mark.parametrize(("name", "body", "words"), WRONG, ids=range(len(WRONG)))
def test_a_wrong_answer_is_told_by_its_symptom(capsys, name, body, words):
    says = told_of_body(capsys, name, body)
    assert "not yet" in says and re.search(words, says), says


ROUTES = [
    ("least_squares", f"{LINES}return theta, np.sqrt(np.diag(C) * {LEFT})"),
    ("least_squares", f"{LINES}return np.linalg.lstsq(A, y, rcond=None)[0], np.sqrt(np.diag(C) * {LEFT})"),
    ("regressor", of_rows()),
    ("rls_step", of_gain()),
    (
        "rls_step",
        "P = np.linalg.inv(forgetting * np.linalg.inv(P) + np.outer(phi, phi))\n"
        "    return theta + P @ phi * (y - phi @ theta), P",
    ),
    ("fit_percent", f"return 100 - 100 * {MISSED} / np.linalg.norm(measured - measured.mean())"),
]


@pytest.mark.parametrize(("name", "body"), ROUTES, ids=range(len(ROUTES)))
def test_other_routes_are_right(capsys, name, body):
    assert "right, and yours" in told_of_body(capsys, name, body)


def test_what_is_given_comes_along(capsys):
    """body_columns stands in no cell of the student's, and in the file that is kept."""
    assert "right, and yours" in told_of_body(capsys, "regressor", of_rows())
    q, qd, qdd = np.random.default_rng(0).uniform(-1, 1, (3, 3))
    ours = columns_of_the_package(q[None], qd[None], qdd[None])[0]
    assert np.allclose(my_robot.regressor(q, qd, qdd, np.sign(qd)), ours)


def test_solutions_agree_with_the_package():
    robot, rng = solutions.load(), np.random.default_rng(1)
    A, theta, P = rng.normal(size=(40, 3)), np.zeros(3), 1e8 * np.eye(3)
    y = A @ [1, -2, 3] + 0.1 * rng.normal(size=40)
    for row, one in zip(A, y, strict=True):
        theta, P = robot.rls_step(theta, P, row, one, 1)
    assert np.allclose(theta, robot.least_squares(A, y)[0], atol=1e-6)
