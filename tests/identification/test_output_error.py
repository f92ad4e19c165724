"""Output error knows only a recording, and finds the truth of a loop made by the engine."""

from dataclasses import replace

import numpy as np
import pytest

from ir50p_lab.bench import ArmInstance, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course.torque.views import thesis_pid
from ir50p_lab.errors import InputError
from ir50p_lab.identification import identify, load_excitations, nrmse_fit, output_error
from ir50p_lab.identification.output_error import ClosedLoopRun
from ir50p_lab.modelling import IR50P
from ir50p_lab.simulation import simulate

TRUE = np.array(IR50P.theta_pwm)
FS = np.array([36.0, 22.0, 22.0])
MOTION = load_excitations()["training"]
IDEAL = ArmInstance(dead_zone=(0, 0, 0), backlash=(0, 0, 0), pot_bow=(0, 0, 0), spread=0.0)


def recorded(seed=0, seconds=30.0, noise=1.0):
    unit = ArmInstance(**{**vars(IDEAL), "noise": noise})
    with SimulatedBench(IR50P, seed=seed, unit=unit, q0=MOTION.q_start, record_to=False) as bench:
        return bench.follow(thesis_pid(), MOTION, seconds)


@pytest.fixture(scope="module")
def record():
    return recorded()


@pytest.fixture(scope="module")
def refined(record):
    return output_error(identify(record, l2=0.2), record, thesis_pid(), MOTION, l2=0.2, progress=False)


def test_the_loop_is_that_of_simulate_and_of_the_bench(record):
    pid = PID(kp=(289, 225, 270), ki=(50, 10, 50), kd=(40, 30, 30), limit_pwm=255)
    again = simulate(TRUE, pid, MOTION, duration=5.0, q0=MOTION.q_start, unit="PWM")
    run = ClosedLoopRun(type("R", (), {"t": again.t, "q": again.q, "u": again.u}), pid, MOTION)
    run.start[:] = MOTION.q_start
    q, u = run.simulate(TRUE)
    np.testing.assert_allclose(q, again.q, atol=1e-12)
    np.testing.assert_allclose(u, again.u, atol=1e-9)
    # the bench, with its delay, rounding and friction, but for the noise of its sensors
    quiet = recorded(noise=0.0, seconds=10.0)
    run = ClosedLoopRun(quiet, thesis_pid(), MOTION, delay=0.02)
    q, u = run.simulate(TRUE, FS, np.full(3, 0.05))
    assert np.abs(q - quiet.q).max() < 0.02 and np.sqrt(np.mean((q - quiet.q) ** 2)) < 0.006


def test_finds_the_truth_and_breakaway_friction(refined, record):
    found = refined
    for joint, column in ((0, 0), (0, 10), (0, 11), (1, 2), (1, 3), (1, 12), (2, 3), (2, 14), (2, 15)):
        off = abs(found.theta[joint, column] - TRUE[joint, column])
        assert off < 0.1 * TRUE[joint, column] + 4 * found.stderr[joint, column]
    assert found.fs[0] == pytest.approx(36, abs=4) and found.qs[0] == pytest.approx(0.05, abs=0.03)
    assert (np.abs(found.fs - FS) < 5 * found.fs_stderr + 2).all()
    np.testing.assert_allclose(found.theta[1:, 5], 0.2 * found.theta[1:, 3])
    assert found.theta[0, 5] > 0  # the waist's own
    inertial_and_friction = np.delete(found.theta, [16, 17, 18], axis=1)
    assert (inertial_and_friction >= 0).all() and (found.fs >= found.theta[range(3), [11, 13, 15]]).all()
    q, u = ClosedLoopRun(record, thesis_pid(), MOTION, delay=0.02).simulate(identify(record, l2=0.2).theta)
    for after, measured, before in zip(
        found.score(record, thesis_pid(), MOTION), (record.q, record.u), (q, u), strict=True
    ):
        assert (after.fit > nrmse_fit(measured, before)[1] - 0.3).all()


def test_predicts_another_run_better_than_the_regression(refined, record):
    motion = load_excitations()["validation 2"]
    with SimulatedBench(IR50P, seed=9, unit=IDEAL, q0=motion.q_start, record_to=False) as bench:
        other = bench.follow(thesis_pid(), motion, 30)
    q, u = refined.score(other, thesis_pid(), motion)
    assert (q.fit > 95).all() and (u.fit > 92).all()
    run = ClosedLoopRun(other, thesis_pid(), motion, delay=0.02)
    before, _ = run.simulate(identify(record, l2=0.2).theta)
    assert q.rms.sum() < nrmse_fit(other.q, before)[0].sum()


@pytest.mark.parametrize("friction", [{"fs": IR50P.friction.fc}, {"qs": (3.0,) * 3}])
def test_what_is_left_at_a_bound_is_no_measurement(friction, capsys):
    """Friction that does not fall, or falls at a speed beyond the search: fs - fc or qs stands at its bound.

    The search settles before its last step: its bar is full all the same.
    """
    arm = replace(IR50P, friction=replace(IR50P.friction, **friction))
    with SimulatedBench(arm, seed=0, unit=IDEAL, q0=MOTION.q_start, record_to=False) as bench:
        record = bench.follow(thesis_pid(), MOTION, 12.0)
    found = output_error(arm.theta_pwm, record, thesis_pid(), MOTION, l2=0.2)
    assert "100%" in capsys.readouterr().err.splitlines()[-1]
    errors = np.r_[found.fs_stderr, found.qs_stderr]
    assert np.isinf(errors).any() and "at a bound: " in " ".join(found.warnings)
    assert np.isinf(found.qs_stderr[(found.qs < 0.0051) | (found.qs > 0.4999)]).all()


BAD = [
    ({"reference": 3.0}, "reference = 3.0"),
    ({"recording": []}, "."),
    ({"controller": None}, "controller is a"),
    ({"delay": -0.01}, "delay"),
    ({"estimate": TRUE[:2]}, "theta with shape"),
    ({"seconds": 0.1}, "50 or more"),
    ({"l2": -1}, "l2"),
]


@pytest.mark.parametrize("options, words", BAD)
def test_bad_arguments(record, options, words):
    given = {"estimate": TRUE, "recording": record, "controller": thesis_pid(), "reference": MOTION, **options}
    with pytest.raises(InputError, match=words):
        output_error(**given, progress=False)


def test_a_record_with_a_gap_is_refused(record):
    kept = (record.t < 8) | (record.t > 9)
    part = type("R", (), {"t": record.t[kept], "q": record.q[kept], "u": record.u[kept]})
    with pytest.raises(InputError, match="gaps"):
        output_error(TRUE, part, thesis_pid(), MOTION, progress=False)
    with pytest.raises(InputError, match="holds no reference"):
        whole = type("R", (), {"t": record.t, "q": record.q, "u": record.u})
        output_error(TRUE, whole, thesis_pid(), progress=False)
