"""Functions that stay in their notebook: right ones are taken, typical wrong ones named, and the course's serves meanwhile."""

import numpy as np
import pytest
from cells import cell

from ir50p_lab.course import badge_of, check, claim, measured, solution
from ir50p_lab.course.checking.tasks import of_notebook
from ir50p_lab.course.kinematics.functions.frames import frames
from ir50p_lab.course.kinematics.functions.jacobian import jacobian
from ir50p_lab.course.lab_book import predictions
from ir50p_lab.course.robot.catalogue import IN_NOTEBOOK
from ir50p_lab.modelling import IR50P, forward_dynamics, mass_matrix

WRONG = [
    ("pace", "    return fastest * np.sum(np.abs(direction @ tip(q, l)))", "in another direction"),
    ("push", "    return strongest / np.sum(np.abs(tip(q, l).T @ direction))", "a limit of its own"),
    ("push", "    return strongest / np.max(np.abs(tip(q, l).T @ direction) + 1e-30)", ""),
    ("along", "    return [q_start for p in places]", ""),
    ("along", "    return []", ""),
    ("centres", "    return np.array([T[k + 1][:3, 3] for k in range(3)])", ""),
    ("centres", "    return np.array([T[k][:3, 3] + lc[k] * T[k + 1][:3, 0] for k in range(3)])", ""),
    ("heaviness", "    return 1 / np.linalg.norm(J @ np.linalg.solve(M, J.T @ direction))", "whole acceleration"),
    ("heaviness", "    return 1 / (direction @ J @ np.linalg.solve(M, J @ direction))", "transpose"),
    ("heaviness", "    return direction @ J @ np.linalg.solve(M, J.T @ direction)", ""),
    ("shoulder_holds", "    return weight(q)[1] + load * tip(q, l)[2, 1]", "not newtons"),
    ("shoulder_holds", "    return weight(q) + load * 9.81 * tip(q, l)[2]", ""),
    ("lump_torque", "    return tip(q, l).T @ np.array([0, 0, 1.0])", ""),
    ("torque", "    return mass(q) * qdd", ""),
    ("torque", "    return mass(q) @ qdd + weight(q)", "the speeds alone"),
    ("acceleration", "    return np.linalg.solve(mass(q), tau - weight(q))", "the speeds alone"),
    ("acceleration", "    return tau / np.diag(mass(q))", ""),
    ("falling", "    return np.concatenate([np.zeros(3), fall(x)])", ""),
    ("falling", "    return np.concatenate([x[:3], fall(x)])", ""),
    ("halve", "    return enough", ""),
    ("halve", "    for _ in range(10):\n        too_short = (too_short + enough) / 2\n    return enough", ""),
    ("slide", "    return speed - taken", ""),
    ("slide", "    return speed - np.sign(speed) * taken", "moving backwards"),
    ("slide", "    return max(speed - taken, 0)", ""),
    ("motor_factors", "    return 0.0, 0.0", ""),
    ("motor_factors", "    return N * kt * V / (255 * Ra), N * kt * ke / Ra", "twice"),
    ("counts_for", "    return (mass(q) @ qdd + weight(q)) / 0.0157", ""),
    ("counts_for", "    return np.zeros(3)", "0 for every input"),
    ("circle", "    return [q_now, 0 * q_now, 0 * q_now]", ""),
    ("circle", "    return right(t) * [[1], [0], [1]]", ""),
    ("circle", "    return right(t) * [[1], [-1], [1]]", ""),
    ("circle", "    return np.degrees(right(t))", ""),
    ("circle", "    return right(t % 6.5)", ""),
    ("rule", "    return 1 / (K * (tau_c + L)), K, T", ""),
    ("rule", "    return 1 / (tau_c - tau_c), K, T", ""),
    ("rule", "    return np.eye(2)", ""),
    ("motor_law", "    return v * np.maximum(0, t - L)", ""),
    ("motor_law", "    return 0 * t", ""),
    ("once_round", "    return kp * K / (w * np.hypot(1, w * T)), 90 + np.arctan(w * T) + w * late", "radians"),
    ("once_round", "    return K / (w * np.hypot(1, w * T)), 90 + np.degrees(np.arctan(w * T) + w * late)", ""),
    ("once_round", "    return kp * K / (w * np.hypot(1, w * T)), 90 + np.degrees(np.arctan(w * T))", "left out"),
    ("carry", "    return weight(q)", "a motor takes counts"),
    ("cancel", "    return v - 9.81 * np.sin(x[0]) - 0.2 * x[1]", "the other way round"),
    ("cancel", "    return v + 9.81 * x[0] + 0.2 * x[1]", ""),
    ("model", "    return mass(q) @ qdd", ""),
    ("pushes", "    return theta @ qd", ""),
    ("into", "    return q, qd, np.sign(qd)", ""),
    ("planned", "    return model(plan[0], plan[1], plan[2], plan[1])", ""),
    ("nearest", "    return hand + (on_line - lens)", ""),
    ("nearest", "    return (lens + on_line) / 2", ""),
    ("nearest", "    a = on_line - lens\n    return lens + np.dot(hand - lens, a) / np.linalg.norm(a) * a", ""),
    ("nearest", "    return lens + np.cross(hand - lens, on_line - lens)", ""),
    ("nearest", "    a = on_line / np.linalg.norm(on_line)\n    return lens + np.dot(hand - lens, a) * a", ""),
    ("both_ways", "    return x", ""),
    ("both_ways", "    return np.convolve(x, np.ones(9) / 9, 'same')", ""),
    ("acted", "    return u", "delay does nothing"),
    ("acted", "    return np.concatenate([np.zeros((round(delay * 10), 3)), u])[: len(u)]", ""),
    ("fit_joint", "    return np.linalg.lstsq(Y, y, rcond=None)[0]", ""),
    ("fit_joint", "    return np.linalg.lstsq(Y[use], y[use], rcond=None)[0]", ""),
    ("most_counts", "    return 255", ""),
    ("most_counts", "    return seconds * np.abs(theta).max()", ""),
    ("when_it_acts", "    return plan_at(0)[0] + off, plan_at(0)[1] + off_rate, plan_at(0)", "delay does nothing"),
    ("when_it_acts", "    return off + delay * off_rate, off_rate, plan_at(delay)", ""),
    ("when_it_acts", "    p = plan_at(delay)\n    return p[0] - off, p[1] - off_rate, p", ""),
    ("camera_at", "    return np.eye(4)", ""),
]
GIVEN = {
    "tip": lambda q, l: jacobian(frames(q, l), 3, frames(q, l)[3][:3, 3])[:3],
    "l": np.array(IR50P.l),
    "mass": lambda q: mass_matrix(IR50P, q),
    "weight": lambda q: of_notebook("torque").reference(q, np.zeros(3), np.zeros(3)),
    "q_now": np.zeros(3),
    "right": of_notebook("circle").reference,
    "fall": lambda x: forward_dynamics(IR50P.without_friction(), x[:3], x[3:], np.zeros(3)),
}


def written(name, body):
    """The function with these lines, as a cell of a notebook has it."""
    function = cell(f"def {name}({', '.join(of_notebook(name).signature)}):\n{body}\n", name)
    function.__globals__.update(GIVEN)
    return function


@pytest.mark.parametrize("name", IN_NOTEBOOK)
def test_the_courses_own_is_right_and_its_lines_are_known(capsys, name):
    task = of_notebook(name)
    assert check(name, task.reference) is task.reference
    assert "right, and yours" in capsys.readouterr().out
    assert solution(name).startswith(f"def {name}({', '.join(task.signature)}):")


@pytest.mark.parametrize(("name", "body", "words"), WRONG)
def test_a_wrong_one_is_refused(capsys, name, body, words):
    right = of_notebook(name).reference
    found = check(name, written(name, body))
    assert found is right and badge_of(found) == "the course's"
    says = capsys.readouterr().out
    assert "not yet: " in says and words in says and "traceback" not in says.lower()


@pytest.mark.parametrize("name", IN_NOTEBOOK)
def test_each_typical_slip_has_its_sentence(capsys, name):
    for mistake in of_notebook(name).mistakes:
        check(name, mistake.function)
        assert mistake.says in capsys.readouterr().out


def test_dots_are_no_answer(capsys):
    assert check("slide", written("slide", "    return ...")) is of_notebook("slide").reference
    assert "not written yet" in capsys.readouterr().out


def test_a_right_one_is_used_and_its_badge_is_yours(capsys):
    mine = written("slide", "    return np.sign(speed) * max(abs(speed) - taken, 0)")
    assert check("slide", mine) is mine and badge_of(mine) == "yours"


def test_only_what_is_yours_is_ticked_or_written_down(capsys):
    claim("so", 1, below=2, by="yours")
    claim("so", 1, below=2, by="the course's")
    claim("so", 3, below=2, by="not written yet")
    claim("so", 1, below=2)
    measured("a", 1, by="the course's")
    measured("b", 2, by="yours")
    lines = capsys.readouterr().out.splitlines()
    assert [line[0] == "✓" for line in lines] == [True, False, False, False, False, False]
    assert list(predictions.read()["predictions"]) == ["b"]
