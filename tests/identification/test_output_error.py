"""Output error and instruments: both know only recordings, and find the truth of a loop made by the engine."""

import dataclasses

import numpy as np
import pytest

from ir50p_lab.bench import ArmInstance, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.course.torque.views import thesis_pid
from ir50p_lab.errors import InputError
from ir50p_lab.identification import (
    fit_with_instruments,
    identify,
    load_excitations,
    nrmse_fit,
    output_error,
)
from ir50p_lab.identification.closed_loop import ClosedLoopRun
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


def test_the_recorded_reference_does_as_well(record):
    first = identify(record, l2=0.2)
    given, as_recorded = (
        output_error(first, record, thesis_pid(), motion, seconds=10, iterations=3, progress=False).score(
            record.between(0, 10), thesis_pid(), motion
        )
        for motion in (MOTION, None)
    )
    np.testing.assert_allclose(given[0].rms, as_recorded[0].rms, rtol=0.1)


@pytest.mark.parametrize("breakaway", [1, 2, 3])
def test_instruments_take_the_bias_of_noise_away(breakaway):
    """Least squares on noisy angles is off by many standard errors; instruments from the simulated loop are not."""
    fs = tuple(breakaway * f for f in IR50P.friction.fc)
    arm = dataclasses.replace(IR50P, friction=dataclasses.replace(IR50P.friction, fs=fs))
    by_instruments, by_squares = [], []
    for seed in range(4):
        with SimulatedBench(arm, seed=seed, unit=IDEAL, q0=MOTION.q_start, record_to=False) as bench:
            known = bench.follow(thesis_pid(), MOTION, 60)
        first = identify(known, method="ls")
        found = fit_with_instruments(first, known, thesis_pid(), MOTION)
        for estimate, z in ((found, by_instruments), (first, by_squares)):
            seen = np.isfinite(estimate.stderr) & (estimate.stderr > 0)
            z.append(((estimate.theta - arm.theta_pwm) / estimate.stderr)[seen])
        assert found.method == "iv"
    assert np.abs(np.mean(by_instruments, axis=0)).max() < 2  # no parameter is off on average
    assert np.mean(np.abs(by_instruments) < 3) >= 0.97 and np.mean(np.abs(by_squares) < 3) < 0.85


BAD = [
    ({"recordings": []}, "0 recordings"),
    ({"references": [MOTION, MOTION]}, "references"),
    ({"references": 3.0}, "reference = 3.0"),
    ({"controller": None}, "controller is a"),
    ({"delay": np.nan}, "delay"),
    ({"delay": -0.01}, "delay"),
    ({"estimate": TRUE[:2]}, "theta with shape"),
]


@pytest.mark.parametrize("options, words", [*BAD, ({"seconds": 0.1}, "50 or more"), ({"l2": -1}, "l2")])
def test_bad_arguments(record, options, words):
    given = {"estimate": TRUE, "recordings": record, "controller": thesis_pid(), "references": MOTION, **options}
    if isinstance(given["references"], list):
        given["recordings"] = [given["recordings"]]
    with pytest.raises(InputError, match=words):
        output_error(given.pop("estimate"), given.pop("recordings"), given.pop("controller"), progress=False, **given)


@pytest.mark.parametrize("options, words", [*BAD, ({"cutoff_hz": 40.0}, "cutoff_hz = 80"), ({"slow": 0}, "slow")])
def test_bad_arguments_of_instruments(record, options, words):
    given = {"estimate": TRUE, "recordings": record, "controller": thesis_pid(), "references": MOTION, **options}
    if isinstance(given["references"], list):
        given["recordings"] = [given["recordings"]]
    with pytest.raises(InputError, match=words):
        fit_with_instruments(given.pop("estimate"), given.pop("recordings"), given.pop("controller"), **given)


def test_a_record_with_a_gap_is_refused(record):
    kept = (record.t < 8) | (record.t > 9)
    part = type("R", (), {"t": record.t[kept], "q": record.q[kept], "u": record.u[kept]})
    with pytest.raises(InputError, match="gaps"):
        output_error(TRUE, part, thesis_pid(), MOTION, progress=False)
    with pytest.raises(InputError, match="holds no reference"):
        whole = type("R", (), {"t": record.t, "q": record.q, "u": record.u})
        output_error(TRUE, whole, thesis_pid(), progress=False)
