"""Wrong answers are told apart from their numbers, right ones of any shape are taken, and nothing makes check raise."""

import dataclasses
import itertools
import re

import numpy as np
import pytest
import solutions
from cells import cell

from ir50p_lab.course import check, my_robot, reset
from ir50p_lab.course.checking import grade as grading
from ir50p_lab.course.checking.calling import call, given
from ir50p_lab.course.checking.task import Mistake
from ir50p_lab.course.robot import student_package as folder
from ir50p_lab.course.robot.catalogue import task, written


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path))
    my_robot._said.clear()
    return tmp_path


def told(capsys, name, *changes, text=None, notebook=()):
    """What check says of the reference solution with some words replaced."""
    text = solutions.source(name) if text is None else text
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    capsys.readouterr()
    check(name, cell(text, name, notebook))
    return capsys.readouterr().out.split("one input that fails")[0]


HAND = "def rot_z(angle):\n    {}\n    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])"
SINE = "c, s = np.cos(angle), np.sin(angle)"
SLOPE = "np.arctan2(up, out) - np.arctan2"
REACH_LIMITS = "np.all(q >= limits[0]) and np.all(q <= limits[1])"


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        ("rot_z", "[c, -s, 0.0]", "[c, s, 0.0]", "a minus is missing"),
        ("rot_z", "np.cos(angle), np.sin(angle)", "np.sin(angle), np.cos(angle)", "sine and cosine have changed"),
        (
            "dh_matrix",
            "turn_z(theta) @ shift(0, 0, d) @ shift(a, 0, 0)",
            "shift(a, 0, d) @ turn_z(theta)",
            "sticks out",
        ),
        ("dh_matrix", "shift(a, 0, 0)", "shift(0, a, 0)", "a shifts along y"),
        ("frames", "[0, l[2], -np.pi / 2", "[l[1], l[2], 1", "look at frame 3|frame 2 to frame 3"),
        ("frames", "np.pi / 2]", "3.14 / 2]", "nearly right"),
        ("forward_kinematics", "[:3, 3]", "[:3, 2]", "another row or column"),
        ("inverse_kinematics", "np.array(poses)", "np.degrees(poses)", "degrees"),
        ("inverse_kinematics", "[1, -1]", "[1]", "two poses a place, all on one side"),
        ("inverse_kinematics", "[-bend, bend]", "[bend]", "two poses a place, one facing it and one with its back"),
        ("inverse_kinematics", "np.arctan2(side * y, side * x)", "np.arctan2(y, x)", "half a turn off in the poses"),
        ("inverse_kinematics", "np.arctan2(side * y, side * x)", "np.arctan(y / x)", "can that which it is taken from"),
        ("inverse_kinematics", "= side * np.hypot(x, y)", "= np.hypot(x, y)", "the shoulder of the one that faces it"),
        ("inverse_kinematics", SLOPE, SLOPE.replace("-", "+"), "do not fit together: is it the sign"),
        ("inverse_kinematics", " or r < shortest - 1e-9", "", r"too near the shoulder \(r < |l2 - l3|\)"),
        ("inverse_kinematics", "r > longest + 1e-9", "r > longest - 1e-9", "very edge"),
        ("inverse_kinematics", "r > longest + 1e-9", "r > longest + 2e-6", "out of reach gets poses"),
        ("inverse_kinematics", "return np.empty((0, 3))", "return None", "no pose means no row"),
        ("reach", REACH_LIMITS, "np.all(q <= limits[1]) and q[0] >= limits[0][0]", "joint [23] would stand"),
        (
            "inverse_kinematics",
            "q2 = np.arctan2(np.sin(q2), np.cos(q2))",
            "pass",
            r"the shoulder of pose \d is -?\d.\d rad",
        ),
        (
            "inverse_kinematics",
            "for q3 in [-bend, bend]",
            "for q3 in [bend - np.pi, np.pi - bend]",
            "inside the triangle",
        ),
        ("reach", REACH_LIMITS, "np.all(q <= limits[1])", "only the upper limits"),
        ("reach", "np.max(np.abs(q - q_now))", "abs(q[2] - q_now[2])", "only the turn of joint 3"),
        ("reach", "[2:, 2, 3]", "[2:, 0, 3]", "another row or column is read than the one needed"),
        (
            "inverse_kinematics",
            "np.arctan2(side * y, side * x)",
            "np.arccos(x / np.hypot(x, y))",
            "mm beside the place",
        ),
        (
            "inverse_kinematics",
            "r > longest + 1e-9 or r < shortest - 1e-9",
            "False",
            "near the shoulder, and those too",
        ),
        ("jacobian", "axis = T[joint]", "axis = T[link]", "z of the link's own frame"),
        ("damped_step", "damping**2", "2 * damping", "twice the damping is added on the diagonal"),
        ("step_metrics", "t[-1] - 1]", "t[-1] - 0.995]", "its first sample is included"),
        (
            "step_metrics",
            "return rise, overshoot",
            "return overshoot, rise",
            "rise time and overshoot have changed places",
        ),
        ("frames", "l[0], 0, np.pi / 2", "l[0], 0, 0", "alpha of row 1 is missing"),
        ("reach", REACH_LIMITS, "all(limits[k][0] <= q[k] <= limits[k][1] for k in range(2))", "read as columns"),
        ("reach", REACH_LIMITS, "all(limits[0][k] <= q[k] <= limits[1][k] for k in range(2))", "of joint 3 are not"),
        ("reach", "np.max(np.abs(q - q_now))", "np.sum(np.abs(q - q_now))", "adds up the turns of the three joints"),
        ("reach", "np.max(np.abs(q - q_now))", "max(q - q_now)", "with their sign"),
        ("rot_z", "[s, c, 0.0]", "[-s, c, 0.0]", "row 2, column 1 has the wrong sign"),
        (
            "rot_z",
            "[c, -s, 0.0], [s, c, 0.0]",
            "[c, np.cos(angle + 90), 0.0], [s, np.sin(angle + 90), 0.0]",
            "how many rad are a quarter turn",
        ),
        ("rot_z", "-s", "...", r"dots still stand in `return np.array\(\[\[c, ..., 0.0"),
        ("dh_matrix", "return turn_z(theta) @ shift(0, 0, d) @", "return", "theta and d do nothing"),
        ("dh_matrix", "shift(0, 0, d) @ shift(a, 0, 0)", "(shift(0, 0, d) + shift(a, 0, 0))", "matrices are added"),
        ("dh_matrix", "@ shift(0, 0, d)", "@ shift(a, 0, 0)", "d does nothing in it and a counts twice"),
        ("dh_matrix", "turn_x(alpha)", "turn_x(alpha) * [1, 1, 1, 0]", "is a turn put into zeros"),
        (
            "dh_matrix",
            "turn_z(theta) @ shift(0, 0, d) @ shift(a, 0, 0) @ turn_x(alpha)",
            "turn_x(theta) @ shift(a, 0, d) @ turn_z(alpha)",
            "theta turns about x and alpha about z",
        ),
        ("forward_kinematics", "[3]", "[2]", "the place of the elbow, not that of the tip"),
        ("damped_step", "T[3]", "T[2]", "the elbow is taken for the tip"),
        ("forward_kinematics", "frames(q, l)", "frames(l, q)", "q and l have changed places"),
        ("forward_kinematics", "frames(q, l)[3]", "np.linalg.multi_dot(frames(q, l))", "multiplied once more"),
        ("forward_kinematics", "frames(q, l)[3][:3, 3]", "frames(q, l)[:, :3, 3].sum(0)", "are added up"),
        (
            "forward_kinematics",
            "[:3, 3]",
            "[:3, :3].T @ frames(q, l)[3][:3, 3]",
            "turned by the frame's axes once more",
        ),
        ("forward_kinematics", "[:3, 3]", "[:3, 3] - frames(q, l)[1][:3, 3]", "counted from the shoulder"),
        ("forward_kinematics", "[:3, 3]", "[:3][3]", "row and column stand in one bracket"),
        ("reach", "[2:, 2, 3]", "[2:, 3, 2]", "another number than their heights"),
        ("reach", "    return best", "    return min([q] if smallest < 9 else [], key=len)", "of nothing"),
        ("reach", "best = q\n", "best = q - q_now\n", "it returns the turn from q_now"),
        ("reach", "frames(q, l)", "frames(q_now, l)", "the heights are those of the arm as it stands now"),
        (
            "reach",
            "if inside and",
            "if not (inside and above_the_table):\n            return None\n        if",
            "ends the search",
        ),
        ("reach", REACH_LIMITS, "np.any((q >= limits[0]) & (q <= limits[1]))", "one joint within its limits is enough"),
        ("jacobian", "T[joint][:3, 2]", "T[link - 1][:3, 2]", "the axis of the link's last one"),
        ("jacobian", "    return J", "    return np.roll(J * (np.arange(3) < link - 1), 1, axis=1)", "column number 0"),
        ("jacobian", "range(link)", "range(link - 1, link)", "the link's own joint alone"),
        ("jacobian", "range(link)", "range(link, 3)", "the joints after the link move it"),
        (
            "jacobian",
            "    return J",
            "    J[:3] /= np.maximum(np.linalg.norm(J[:3], axis=0), 1e-12)\n    return J",
            "has length 1",
        ),
        ("jacobian", "    return J", "    J[1] *= -1\n    return J", "row 2 has the wrong sign, the rest is right"),
        (
            "jacobian",
            "    return J",
            "    J[3:, :link] = np.cumsum(J[3:, :link], axis=1)\n    return J",
            "added up from column to column",
        ),
        ("dh_matrix", "T[:3, 3] = [x", "T[3, :3] = [x", "stands in the bottom row"),
        ("jacobian", "axis = T[joint]", "axis = T[joint + 1]", "axis of joint k is taken from frame k, one too far"),
        (
            "jacobian",
            "origin = T[joint]",
            "origin = T[joint + 1]",
            "lever of joint k is taken from frame k, one too far",
        ),
        (
            "damped_step",
            "J.T @ np.linalg.solve(A, p - tip)",
            "np.linalg.pinv(J) @ (p - tip) / (1 + damping**2)",
            "without damping, made shorter",
        ),
        ("damped_step", "J.T @ np.linalg.solve", "0.5 * J.T @ np.linalg.solve", "counts by half|length is not"),
        ("step_metrics", "t[np.argmax(done >= 0.1)]", "t[np.argmax(done >= 0.1) - 1]", "time is 1 sample too long"),
        ("reach", "    return best", "    return None", "None for a place that has an allowed pose"),
        ("reach", "    return best", "    return best, smallest", "things that make no array"),
        ("jacobian", "axis = T[joint][:3, 2]", "axis = T[joint][:3, 0]", "look at the axis"),
        ("jacobian", "np.zeros((6, 3))", "np.zeros((6, 3), dtype=int)", "array of integers|whole numbers"),
        ("damped_step", "J @ J.T", "J * J.T", r"entry by entry \(`\*`"),
        ("damped_step", "damping**2", "damping", "a square is missing"),
        ("damped_step", "damping**2 * np.eye(3)", "damping**2", "all nine entries"),
        ("damped_step", "+ J.T @ np.linalg.solve", "+ np.linalg.solve", "it is no turn of joints yet"),
        ("jacobian", "axis = T[joint][:3, 2]", "axis = T[joint][2, :3]", "read by rows: an axis is a column"),
        ("damped_step", "damping**2", "damping^2", "no power in Python"),
        ("step_metrics", "(q - start) / jump", "q / target", "begins at 0 rad and wrong elsewhere"),
        (
            "step_metrics",
            "    if np.any(done >= 0.9):\n        rise",
            "    if True:\n        rise",
            "what never happens has no time, nan",
        ),
        ("step_metrics", "np.abs(q - target) > band", "np.abs(q - np.mean(last_second)) > band", "about the target"),
        ("step_metrics", "np.std(np.diff(last_second)) / np.sqrt(2)", "np.std(q)", "last second"),
        ("step_metrics", "np.diff(last_second)", "np.diff(q)", "that of the whole run"),
        ("step_metrics", "np.std(np.diff(last_second)) / np.sqrt(2)", "np.std(last_second)", "slow swing widens"),
        ("step_metrics", "4 * ", "3 * ", "3 standard deviations"),
        ("step_metrics", "0.02", "0.04", "4 % of the way"),
        ("step_metrics", " / np.sqrt(2)", "", "too wide"),
        ("step_metrics", "4 * ", "5 * ", "too wide"),
        ("step_metrics", "np.max(np.sign(jump) * (q - target))", "max(abs(q)) - abs(target)", "sizes"),
        ("step_metrics", " if np.any(outside) else 0.0", "", "the array is empty"),
        ("damped_step", "[:3]\n", "\n", r"`J @ J.T` has the shape \(6, 6\)"),
        ("damped_step", "np.linalg.solve(A, p - tip)", "((p - tip) / A)", "`/` divides entry by entry"),
        ("reach", ">= -1e-9", "> 0", "exactly on the table, z = 0, are refused"),
        (
            "inverse_kinematics",
            "np.arctan2(l3 * np.sin(q3), l2 + l3 * np.cos(q3))",
            "np.arcsin(l3 * np.sin(q3) / r)",
            "arcsin does not know angles",
        ),
        (
            "inverse_kinematics",
            "np.arctan2(l3 * np.sin(q3), l2 + l3 * np.cos(q3))",
            "np.arctan2(l2 * np.sin(q3), l3 + l2 * np.cos(q3))",
            "have changed places",
        ),
        ("rot_z", "np.cos(angle), np.sin(angle)", "np.cos(angle), np.sqrt(1 - np.cos(angle)**2)", "without its sign"),
        ("rot_z", "[c, -s, 0.0], [s, c, 0.0]", "[c, -s, 0.0], [-s, c, 0.0]", r"column 1 has the wrong sign\.\s"),
        ("rot_z", "[c, -s, 0.0], [s, c, 0.0], [0", "[c, 0, s], [0, 1, 0], [-s, 0, c]][:3] or [[0", "leaves y alone"),
        ("dh_matrix", "turn_x(alpha)", "turn_x(theta)", "alpha does nothing in it, and theta turns twice"),
        ("dh_matrix", "T[:3, 3] = [x", "T[:3, 3] == [x", "compares and puts nothing anywhere"),
        ("frames", "[l[0], 0, np.pi", "[0, l[0], np.pi", "d and a have changed places in row 1 alone"),
        ("forward_kinematics", "frames(q, l)[3]", "dh_matrix(q[2], 0, l[2], 0)", "as frame 2 sees it, at the elbow"),
        ("inverse_kinematics", "[1, -1]", "[-1]", "all with their back to it"),
        ("reach", REACH_LIMITS, "all(limits[0, 0] <= a <= limits[0, 1] for a in q)", "read as columns"),
        ("reach", REACH_LIMITS, "len(q := np.clip(q, *limits))", "stands exactly on a limit"),
        ("reach", "best = q\n", "return q\n", "the first allowed pose wins"),
        ("jacobian", "origin = T[joint]", "origin = T[link]", "the link's own frame"),
        ("jacobian", "range(link)", "range(3)", "all three joints move every link"),
        ("jacobian", "    return J", "    J[3:] = 0\n    return J", "lower three rows are never filled"),
        ("jacobian", "    return J", "    J[3:] = T[:3, :3, 2].T\n    return J", "in the lower rows all three joints"),
        ("damped_step", "+ damping**2", "- damping**2", "subtracted on the diagonal"),
        ("damped_step", "J.T @ np.linalg.solve(A, p - tip)", "J.T @ (p - tip) / 2", "follows the transpose alone"),
        (
            "damped_step",
            "J.T @ np.linalg.solve(A, p - tip)",
            "damping * np.linalg.solve(J, p - tip)",
            "only multiplies the plain step",
        ),
        ("damped_step", "    T = ", "    damping = 0.03\n    T = ", "`damping = 0.03` overwrites what came in"),
    ],
)
def test_a_usual_mistake_has_its_sentence(name, old, new, words, capsys):
    said = told(capsys, name, (old, new))
    assert re.search(words, said), said


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        ("frames", "q[k], d, a, alpha", "d, a, alpha, q[k]", "arguments of `dh_matrix` stand in another order"),
        ("frames", "d, a, alpha = ", "a, d, alpha = ", "d and a have changed places in every row"),
        ("frames", "range(len(q))", "range(1, len(q))", "the loop leaves out the first"),
        ("frames", "q[k]", "q[k - 1]", "q is read one place too early"),
        ("frames", "table[k]", "table[0]", "number 1 of table is taken each time"),
        ("frames", "T[-1] @ step", "(dh_matrix(q[k - 1], *table[k - 1]) if k else T[0]) @ step", "back two links only"),
        ("inverse_kinematics", "out = np.hypot(x, y)", "out = x", "x alone counts, not the distance: look at out"),
        ("inverse_kinematics", "/ (2 * l2 * l3)", "/ (l2 * l3)", "a factor is missing: look at the cosine"),
        ("inverse_kinematics", "np.array(poses)", "np.array(poses).astype(int)", "mm beside the place"),
        (
            "inverse_kinematics",
            "in [-bend, bend]:",
            "in [-bend, bend][: 2 * (bend < 2.44)]:",
            "a place within reach gets no pose",
        ),
        (
            "inverse_kinematics",
            "poses.append([waist + np.pi, np.arctan2(up, -out) - beta, q3])\n    p",
            "if abs(cosine) > 1 + 1e-9:\n            return []\n    p",
            "two poses a place, all on one side",
        ),
        (
            "inverse_kinematics",
            "np.arctan2(l3 * np.sin(q3), l2 + l3 * np.cos(q3))",
            "np.arctan2(l2 * np.sin(q3), l3 + l2 * np.cos(q3))",
            "the elbow is right, in the shoulder l2 and l3",
        ),
        ("damped_step", "+ damping**2 * np.eye(3)", "+ damping**2", "a factor is missing .the identity.: look at A"),
        ("damped_step", "J.T @ e", "e", "the right side is what is missing, untouched"),
        ("damped_step", "J.T @ J", "J @ J", "a transpose is missing: look at A"),
        ("damped_step", "np.linalg.solve(A, J.T @ e)", "J.T @ e / A", "`/` divides entry by entry"),
        ("damped_step", "forward_kinematics(q, l)", "forward_kinematics(l, q)", "arguments 1 and 2 of `forward_kin"),
        ("damped_step", "frames(q, l)", "frames(p, l)", "`p` stands where something else belongs: look at T"),
        ("damped_step", "e = p - tip", "e = p", "it steps by p itself"),
        ("damped_step", "np.eye(3)", "np.diag(np.diag(J.T @ J))", "multiplied with the diagonal"),
        ("damped_step", "np.linalg.solve(A, J.T @ e)", "J.T @ e / np.diag(A)", "each joint steps as if it were alone"),
        (
            "damped_step",
            "return q + dq",
            "return q + np.linalg.solve(J.T @ J, J.T @ e) + damping**2",
            "added to the turn",
        ),
        ("damped_step", "np.linalg.solve(A, J.T @ e)", "np.linalg.lstsq(J, e, rcond=damping)[0]", "`rcond`"),
        ("damped_step", "solve(A, J.T @ e)", "solve(J.T @ e, A)", "a row where a matrix belongs: in `solve` it comes"),
    ],
)
def test_a_mistake_in_the_form_the_notebook_leads_to(name, old, new, words, capsys):
    said = told(capsys, name, (old, new), text=task(name).routes[0])
    assert re.search(words, said), said


@pytest.mark.parametrize("name", ["dh_matrix", "frames", "jacobian"])
def test_integers_that_cut_off_are_named_everywhere(name, capsys):
    whole = {
        "dh_matrix": [("T = np.eye(4)", "T = np.eye(4, dtype=int)")],
        "frames": [("return np.array(T)", "return np.array(T).astype(int)")],
        "jacobian": [("np.zeros((6, 3))", "np.zeros((6, 3), int)")],
    }[name]  # fmt: skip
    assert "integers" in told(capsys, name, *whole)


@pytest.mark.parametrize(
    "value", ["[[1, 2], [3]]", "np", "'text'", "{1: 2}", "None", "np.nan", "[]", "(1, [2, 3])", "..."]
)
@pytest.mark.parametrize("name", ["rot_z", "inverse_kinematics", "reach", "damped_step"])
def test_whatever_comes_back_is_no_error(name, value, capsys):
    arguments = ", ".join(task(name).signature)
    assert "not" in told(capsys, name, text=f"def {name}({arguments}):\n    x = {value}\n    return x")


def test_an_empty_list_out_of_reach_and_a_numeric_jacobian_are_right(capsys):
    assert "right, and yours" in told(capsys, "inverse_kinematics", ("return np.empty((0, 3))", "return []"))
    step = "((np.cos(1e-6) - 1) * np.cross(axis, np.cross(lever, axis)) + np.sin(1e-6) * np.cross(axis, lever)) / 1e-6"
    text = task("jacobian").loan.replace("np.cross(axis, lever)", step)
    assert "right, and yours" in told(capsys, "jacobian", text=text)


def test_a_number_of_the_edge_is_a_nanometre(capsys):
    for step, inside in ((-0.5e-9, True), (0.5e-9, True), (1e-6, False)):
        l = np.array([0.285, 0.2, 0.372])
        p = np.array([0, 0, l[0]]) + (l[1] + l[2] + step) * np.array([0.6, 0, 0.8])
        assert (len(task("inverse_kinematics").right(p, l)) > 0) == inside


@pytest.mark.parametrize("difference", ["(place(q + e) - place(q - e)) / 2e-6", "(place(q + e) - place(q)) / 1e-6"])
def test_a_good_numeric_jacobian_is_right(difference, capsys):
    text = f"""def damped_step(q, p, l, damping):
    def place(q):
        return forward_kinematics(q, l)
    J = np.zeros((3, 3))
    for k in range(3):
        e = np.zeros(3)
        e[k] = 1e-6
        J[:, k] = {difference}
    return q + J.T @ np.linalg.solve(J @ J.T + damping**2 * np.eye(3), p - place(q))"""
    assert "right, and yours" in told(capsys, "damped_step", text=text)


@pytest.mark.parametrize(
    "text",
    [
        "from math import *\n\n\n" + HAND.format("c, s = cos(angle), sin(angle)"),
        "from functools import lru_cache\n\n\n@lru_cache\n" + HAND.format(SINE),
        "import itertools\nfrom typing import Any\nfrom collections import namedtuple\n\nPair = namedtuple('Pair', 'c s')\n\n\n"
        + HAND.format("c, s = Pair(*itertools.chain([np.cos(angle)], [np.sin(angle)]))"),
        "cosine = lambda a: np.cos(a)\n\n\n" + HAND.format("c, s = cosine(angle), np.sin(angle)"),
        "cosine, sine = np.cos, np.sin\n\n\n" + HAND.format("c, s = cosine(angle), sine(angle)"),
        "rot_z = lambda a: np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])",
        HAND.format("f = np; c, s = f.cos(angle), f.sin(angle)"),
    ],
)
def test_right_ones_of_any_shape_are_kept_and_run_alone(text, capsys):
    said = told(capsys, "rot_z", text=text, notebook={"sin": 0})
    assert "right, and yours" in said
    np.testing.assert_allclose(my_robot.rot_z(0.3), task("rot_z").right(0.3))


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("np.allclose = lambda *a, **k: True; c, s = 1, 0", "changes or opens `np.allclose`"),
        ("c = s = __import__('ir50p_lab.modelling').modelling.rot_z(angle)", "uses `__import__`"),
        ("exec('from ir50p_lab.modelling import rot_z as r', d := {}); c = s = d['r'](angle)", "uses `exec`"),
        ("c = s = np.__builtins__", "changes or opens"),
        ("c = s = frames(angle, angle)", "calls `frames`: this function is to do without"),
    ],
)
def test_ways_round_the_task_are_refused(line, words, capsys):
    before = np.allclose
    assert words in told(capsys, "rot_z", text=HAND.format(line))
    assert np.allclose is before


def test_what_is_not_written_in_the_cell_is_refused(monkeypatch, capsys):
    monkeypatch.setattr(np, "allclose", np.allclose)  # to put it back
    patched = "np.allclose = lambda *a, **k: True\n\n\ndef rot_z(angle):\n    return np.eye(3)"
    assert "changes or opens `np.allclose`" in told(capsys, "rot_z", text=patched)
    assert "the course's own" in told(capsys, "rot_z", text="from ir50p_lab.modelling import rot_z")
    assert "right, and yours" not in told(capsys, "rot_z", text="def rot_z(angle):\n    return np.eye(3) + angle")


def test_a_loan_pasted_back_stays_a_loan(capsys):
    assert "right, and yours" in told(capsys, "rot_z", text=task("rot_z").loan)  # before it was lent, it is one's own
    reset("rot_z")
    for k in range(6):
        told(capsys, "rot_z", text=f"def rot_z(angle):\n    return {k} * np.eye(3)")
    lent = folder.path_of("rot_z").read_text()
    disguised = lent.replace("c = ", "ahead = ").replace("c,", "ahead,").replace("[s, c", "[s, ahead")
    disguised = disguised.replace("    s =", "    # mine\n    s   =").replace("angle", "a")
    wrapped = lent.replace("def rot_z", "def turn") + "\n\ndef rot_z(a):\n    unused = 3\n    return 1 * turn(a) + 0.0"
    for text in (lent, disguised, wrapped):
        assert "it stays a loan" in told(capsys, "rot_z", text=text)
        assert my_robot.whose("rot_z") == "on loan"
    assert "right, and yours" in told(capsys, "rot_z")


def test_a_loan_with_a_new_last_line_is_no_work_of_ones_own(capsys):
    for k in range(6):
        told(capsys, "frames", text=f"def frames(q, l):\n    return {k} * np.eye(3)")
    lent = task("frames").loan
    for last in (
        "np.stack([T0, T1, T2, T3])",
        "+np.array([T0, T1, T2, T3])",
        "(lambda x: x)(np.array([T0, T1, T2, T3]))",
    ):
        text = lent.replace("np.array([T0, T1, T2, T3])", last)
        assert "it stays a loan" in told(capsys, "frames", text=text)
    assert "right, and yours" in told(capsys, "frames")


def test_no_sentence_says_not_yet_twice(capsys):
    said = told(capsys, "forward_kinematics", text="def forward_kinematics(q, l):\n    return np.cos(q * l) + q**3")
    assert said.count("not yet") == 1 and "0 of 9 inputs" in said


def test_crossings_between_two_samples_are_right_too(capsys):
    text = """def step_metrics(t, q, target):
    rise, *others = by_samples(t, q, target)
    done = (q - q[0]) / (target - q[0])
    if np.any(done >= 0.9):
        first, last = np.argmax(done >= 0.1), np.argmax(done >= 0.9)
        rise = np.interp(0.9, done[last - 1:last + 1], t[last - 1:last + 1])
        rise -= np.interp(0.1, done[first - 1:first + 1], t[first - 1:first + 1])
    return rise, *others"""
    check(
        "step_metrics",
        cell(solutions.source("step_metrics").replace("step_metrics", "by_samples") + "\n\n\n" + text, "step_metrics"),
    )
    assert "from now on my_robot.step_metrics is this function" in capsys.readouterr().out


def test_long_runs_are_shown_short_and_last(capsys):
    text = solutions.source("step_metrics").replace("0.02", "0.05")
    check("step_metrics", cell(text, "step_metrics"))
    said = capsys.readouterr().out
    assert "expected (s, rad, s, rad)" in said and said.index("target = ") < said.index("t = [")
    assert len(re.findall(r"\d\.\d*", said.split("expected")[0])) < 25


def test_a_question_ends_as_one_and_names_are_the_students(capsys):
    said = told(capsys, "rot_z", ("[c, -s, 0.0], [s", "[c, s, 0.0], [-s"))
    assert "?." not in said and said.rstrip().endswith("?")
    text = task("damped_step").loan.replace("missing = p - tip", "e = tip - p").replace("missing", "e")
    said = told(capsys, "damped_step", text=text)
    assert "wrong way round" in said and "missing" not in said


def test_a_waist_beyond_half_a_turn_is_told(capsys):
    said = told(capsys, "inverse_kinematics", ("q1 = np.arctan2(side * y, side * x)",
                "q1 = np.arctan2(y, x) + (np.pi if side < 0 else 0)"))  # fmt: skip
    assert re.search(r"the waist of pose 3 is (\d.\d) rad: the same pose is -\d.\d rad", said), said


def test_numbers_that_two_mistakes_share_name_both(capsys):
    said = told(capsys, "jacobian", text=task("jacobian").loan.replace("cross(axis, lever)", "cross(lever, axis)"))
    assert "factors of the cross product" in said and "from the point to the joint" in said
    said = told(capsys, "reach", text=task("reach").loan.replace("            smallest = turn\n", ""))
    assert "compared" in said and "kept up to date" in said


def test_places_to_reach_have_one_best_pose():
    for p, l, q_now, limits in task("reach").cases():
        turns = [np.abs(q - q_now).max() for q in task("inverse_kinematics").right(p, l)
                 if (q >= limits[0]).all() and (q <= limits[1]).all()
                 and (task("frames").right(q, l)[2:, 2, 3] >= 0).all()]  # fmt: skip
        assert len(turns) < 2 or np.diff(np.sort(turns))[0] > 0.05


def test_the_search_for_a_mistake_ends_in_time(monkeypatch):
    monkeypatch.setattr(grading, "_PATIENCE", 0.05)
    endless = (Mistake(lambda angle: np.zeros(angle), f"number {k}") for k in itertools.count())
    monkeypatch.setattr(grading, "distortions", lambda task: endless)
    assert grading.grade(task("rot_z"), lambda angle: np.eye(3) + angle).state == "wrong"


CLOSED = """def dh_matrix(theta, d, a, alpha):
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, a], [0, 0, 0, 1]])"""
TOO_MANY_ROWS = """def damped_step(q, p, l, damping):
    J = jacobian(frames(q, l), 3, forward_kinematics(q, l))
    return q + J.T @ np.linalg.solve(J @ J.T + damping**2 * np.eye(6), p - forward_kinematics(q, l))"""
ALL_ROWS = TOO_MANY_ROWS.replace("p - forward_kinematics(q, l))", "np.append(p - forward_kinematics(q, l), [0, 0, 0]))")
ONE_ARRAY = """def dh_matrix(theta, d, a, alpha):
    joint = link = np.eye(4)
    joint[:3, :3] = rot_z(theta)
    link[:3, 3] = [a, 0, d]
    return joint @ link"""
EMPTIED = (
    task("inverse_kinematics")
    .loan.replace("    poses = []\n", "")
    .replace("        distance", "        poses = []\n        distance")
)
OUT_OF_ITS_LIST = """def reach(p, l, q_now, limits):
    poses = inverse_kinematics(p, l).tolist()
    for q in poses:
        if np.any(q < limits[0]) or np.any(q > limits[1]) or np.any(frames(q, l)[2:, 2, 3] < -1e-9):
            poses.remove(q)
    if not poses:
        return None
    return np.array(min(poses, key=lambda q: np.max(np.abs(q - q_now))))"""
UNTIL_IT_IS_THERE = """def damped_step(q, p, l, damping):
    for _ in range(100):
        e = p - forward_kinematics(q, l)
        if np.linalg.norm(e) < 2e-3:
            break
        J = jacobian(frames(q, l), 3, forward_kinematics(q, l))[:3]
        q = q + np.linalg.solve(J.T @ J + damping**2 * np.eye(3), J.T @ e)
    return q"""
ELBOW_KEPT = """def inverse_kinematics(p, l):
    q1, out, up = np.arctan2(p[1], p[0]), np.hypot(p[0], p[1]), p[2] - l[0]
    c = (out**2 + up**2 - l[1]**2 - l[2]**2) / (2 * l[1] * l[2])
    if abs(c) > 1 + 1e-7:
        return np.empty((0, 3))
    q3 = np.arccos(np.clip(c, -1, 1)) * np.array([1, -1])
    q2 = np.arctan2(up, out) - np.arctan2(l[2] * np.sin(q3), l[1] + l[2] * np.cos(q3))
    poses = [[q1, q2[k], q3[k]] for k in (0, 1)] + [[q1 + np.pi, np.pi - q2[k], q3[k]] for k in (0, 1)]
    return (np.array(poses) + np.pi) % (2 * np.pi) - np.pi"""


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("dh_matrix", CLOSED, "row 3, column 4 holds a"),
        ("dh_matrix", ONE_ARRAY, "joint and link are names of one array"),
        ("inverse_kinematics", EMPTIED, "is the list emptied in each round"),
        ("damped_step", TOO_MANY_ROWS, r"shape \(6, 6\); `p - forward_kinematics\(q, l\)` has the shape \(3,\)"),
        ("inverse_kinematics", ELBOW_KEPT, "do not fit together in the poses with their back"),
        ("rot_z", "def rot_z(angle):\n    return my_robot.rot_z(angle)", "the function you are about to write"),
        (
            "rot_z",
            "R = np.eye(3)\n\n\ndef rot_z(angle):\n    R[0, 0] += angle\n    return R",
            "it changes `R`, made once",
        ),
        ("reach", OUT_OF_ITS_LIST, "makes it skip the next one"),
        ("reach", "def reach(p, l, q_now, limits):\n    return by_course(p)", "it calls `by_course`, the course's own"),
        ("damped_step", UNTIL_IT_IS_THERE, "it is at the place already"),
        ("damped_step", ALL_ROWS, "the hand must not turn, either"),
        (
            "inverse_kinematics",
            "def inverse_kinematics(p, l):\n    raise ValueError(p)",
            "asked for an answer there, too",
        ),
    ],
)
def test_other_ways_to_be_wrong_have_theirs(name, text, words, capsys):
    said = told(capsys, name, text=text, notebook={"my_robot": my_robot, "by_course": task("frames").right})
    assert re.search(words, said) and "gufunc" not in said, said


@pytest.mark.parametrize("name", [name for name in written() if task(name).cases is not None])
def test_the_example_shown_is_one_where_the_mistake_named_happens(name, monkeypatch):
    """With the sentences for known mistakes taken away, the symptom has to speak of what is shown."""
    monkeypatch.setattr(grading, "distortions", lambda task: ())
    monkeypatch.setattr(grading, "variants", lambda task: ())
    known, one = task(name).slips, dataclasses.replace(task(name), slips=())
    cases, shown = one.cases(), 0
    for mistake in known:
        verdict = grading.grade(one, mistake.wrong)
        returned = [call(one, mistake.wrong, case) for case in cases]
        answers = {k: (case, returned[k], one.right(*case)) for k, case in enumerate(cases)}
        answers = {k: answer for k, answer in answers.items() if not grading._agrees(one, *answer[1:])}
        there = [k for k, case in enumerate(cases) if verdict.example.startswith(given(one, case) + "\n")]
        shown += bool(there)
        assert not there or any(k in answers for k in there)
        if there and one.symptom and not verdict.says.startswith("it stops"):
            if verdict.says not in {one.symptom(*answer) for answer in answers.values()}:
                continue
            assert verdict.says in {one.symptom(*answers[k]) for k in there if k in answers}
    assert shown > 0.8 * len(known)
