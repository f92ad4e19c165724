"""Every number exercise of every room: the rules for authors hold, and each right answer comes by another route too."""

import re
import warnings

import numpy as np
import pytest

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.controllers import PID, ContinuousPID
from ir50p_lab.course import solution
from ir50p_lab.course.checking.numbers import everything, find, grade_number
from ir50p_lab.modelling import IR50P, THESIS_A, energy, inverse_dynamics
from ir50p_lab.signals import hold, low_pass, quintic
from ir50p_lab.simulation import simulate

ALL = everything()


def secrets(number):
    """Return texts that no message may contain: the answer, where it is long enough to be recognised."""
    texts = {f"{abs(x):.{digits}g}" for x in np.ravel(number.right) for digits in (3, 4, 5)}
    return {text for text in texts if len(text.replace(".", "").strip("0")) >= 3 and text not in number.task}


def problems(number):
    """Return what is wrong with an exercise, as a list of sentences (empty: all is well)."""
    if not re.fullmatch(r"[a-z]+-[1-9]\d*", number.name):
        yield "its name is not prefix-number"
    if number.task.endswith((".", "?")) or any("\n" in text or len(text) > 220 for text in (number.task, number.why)):
        yield "task and why are not one line each"
    if len(number.every_mistake) < 3:
        yield "fewer than three mistakes are known"
    for says, wrong in number.every_mistake.items():
        note = grade_number(number, wrong)
        if not 15 <= len(says) <= 260 or says[-1] not in ".?:":
            yield f"{says!r} is not one or two sentences"
        if note.state != "mistake" or (says in number.mistakes and not note.text.endswith(says)):
            yield f"mistake {says!r} is answered by {note.text!r}"  # an own one may say more than a common one
    right, away = (
        grade_number(number, number.right.tolist()),
        grade_number(number, number.right + 3.3 * (1 + np.abs(number.right))),
    )
    if right.state != "right":
        yield f"the right answer is told {right.text!r}"
    if away.state != "wrong":
        yield f"any other answer is told {away.text!r}"
    told = " ".join(
        (
            number.task,
            number.hint,
            *number.every_mistake,
            grade_number(number, ...).text,
            grade_number(number, "x").text,
        )
    )
    if given := [secret for secret in secrets(number) if secret in told]:
        yield f"the answer is given away: {given}"


@pytest.mark.parametrize("number", ALL, ids=lambda number: number.name)
def test_the_rules_hold(number):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert list(problems(number)) == []


def test_names_are_unique():
    assert len({number.name for number in ALL}) == len(ALL)


# --- right answers by another route


def tip_velocity():
    """Chain rule for a 0.285, 0.200, 0.372 m arm at (30, 45, -60) degrees and (0.5, -0.2, 0.4) rad/s."""
    q1, q2, q23 = np.radians([30, 45, -15])
    radius = 0.2 * np.cos(q2) + 0.372 * np.cos(q23)
    radius_rate = -0.2 * np.sin(q2) * -0.2 - 0.372 * np.sin(q23) * (-0.2 + 0.4)
    height_rate = 0.2 * np.cos(q2) * -0.2 + 0.372 * np.cos(q23) * (-0.2 + 0.4)
    x_rate = radius_rate * np.cos(q1) - radius * np.sin(q1) * 0.5
    y_rate = radius_rate * np.sin(q1) + radius * np.cos(q1) * 0.5
    return np.array([x_rate, y_rate, height_rate])


def shortest_way(ways, speeds):
    """The fastest moment of a quintic of 1 rad in 1 s, by the package; times go with way over speed."""
    top = np.max(quintic(np.zeros(3), np.ones(3), duration=1).sample(np.linspace(0, 1, 1001))[:, 1])
    return max(top * way / speed for way, speed in zip(ways, speeds, strict=True))


def time_constant():
    """Inertia from the kinetic energy of the waist at 1 rad/s, over what brakes it."""
    folded = [0, 1.9, -2.44]
    inertia = 2 * energy(IR50P, folded, [1, 0, 0]).kinetic
    return inertia / (IR50P.actuators.back_emf_damping[0] + IR50P.friction.fv[0])


def remaining_errors():
    """Where a simulation ends."""
    set_point = (np.pi / 2, np.pi / 2, -np.pi / 3)
    return simulate(THESIS_A, ContinuousPID((50, 100, 50), kd=(20, 20, 20)), set_point).error[-1]


def lag():
    """A filtered ramp."""
    ramp = 0.5 * np.arange(500) * 0.01
    return ramp[-1] - low_pass(ramp, 2.0, 100)[-1]


def sag():
    """Steps of 1 ms until nothing moves."""
    e, rate = 0.0, 0.0
    for _ in range(20000):
        rate += 1e-3 * (0.6 * (-49 * e - 14 * rate) + 4.0 - 5.5) / 0.6
        e += 1e-3 * rate
    return e


def read_too_far():
    """A line from the lens through the ball meets the table; (along the table, height)."""
    lens, ball = np.array([0.0, 0.6]), np.array([0.5, 0.03])
    return (lens + (ball - lens) * lens[1] / (lens[1] - ball[1]))[0] - 0.5


def quickest_gear():
    """Every gear is tried."""
    gears = np.linspace(1, 300, 299_001)
    return gears[np.argmax(gears / (0.098 + gears**2 * 2e-5))]


def load_by_levers():
    """Kilograms at the tip, from levers drawn by hand: upper arm at 30 degrees, forearm at -30."""
    out = np.cos(np.pi / 6)
    links = IR50P.m[1] * IR50P.lc[1] * out + IR50P.m[2] * (IR50P.l[1] + IR50P.lc[2]) * out
    return (7.0 / 9.81 - links) / ((IR50P.l[1] + IR50P.l[2]) * out)


ROUTES = {
    "start-1": lambda: np.array([90, -45, 30]) * np.pi / 180,
    "start-5": time_constant,
    "pose-3": lambda: [-0.1, 0.3, -0.2],
    "ik-1": tip_velocity,
    "dyn-6": quickest_gear,
    "dyn-5": lambda: 1.6 * (2 + 0.2 * 3) + 2.5 * 0.5,
    "weight-1": load_by_levers,
    "traj-1": lambda: shortest_way((0.343, 1.523, 1.247), (2.5, 1.1, 1.3)),
    "pid-1": remaining_errors,
    "bench-4": lag,
    "ct-3": sag,
    "calib-4": read_too_far,
}
BY_TESTS = {"bench-5", "ident-2"}  # below


@pytest.mark.parametrize("name", ROUTES)
def test_by_another_route(name):
    np.testing.assert_allclose(solution(name), ROUTES[name](), rtol=1e-4, atol=1e-6)


def test_no_exercise_is_without_another_route():
    assert {*ROUTES, *BY_TESTS} == {number.name for number in ALL}


@pytest.mark.parametrize(("share", "moves"), [(0.8, False), (1.3, True)])
def test_friction_holds_up_to_that_error(share, moves):
    """From a set point that is nearer joint 1 does not start; from one farther away it does (units differ by 5 %)."""
    bench = SimulatedBench(IR50P, record_to=False).open()
    bench.follow(PID((289, 0, 0), limit_pwm=255), hold([share * solution("bench-5"), 0, 0]), 3)
    assert (np.ptp(bench.truth.q[:, 0]) > 0.01) == moves


def test_what_a_clamped_joint_hides():
    """The directions of theta that change any torque, from the inverse dynamics."""
    q, qd, qdd = np.random.default_rng(3).uniform(-2, 2, (3, 60, 3))
    qd[:, 0] = qdd[:, 0] = 0.0
    columns = []
    for k in sorted(set(range(20)) - {6, 7}):  # theta7 and theta8 belong to no rigid body
        theta = np.zeros((3, 20))
        theta[:, k] = 1.0
        columns.append(inverse_dynamics(theta, q, qd, qdd))
    assert np.linalg.matrix_rank(np.reshape(columns, (18, -1))) == solution("ident-2")


# --- what the remarks claim


@pytest.mark.parametrize(
    ("name", "answer", "words"),
    [
        ("ik-1", tip_velocity()[[0, 0, 2]], "printed"),
        ("ik-1", [0.1, -0.1 * np.sqrt(3), 0.5], "turns"),
        ("pose-3", [-0.3, -0.1, -0.2], "along the axes of"),
        ("pose-3", [0.1, -0.3, 0.2], "seen from"),
    ],
)
def test_wrong_answers_worked_out_by_hand(name, answer, words):
    assert words in grade_number(find(name), answer).text
