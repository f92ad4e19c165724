"""The recipe in one call, motions kept in a file, and the simulation that chose them."""

from types import SimpleNamespace

import numpy as np
import pytest
from refusals import refused

from data.make_excitations import (
    SETTINGS,
    save_excitations,
)
from ir50p_lab.bench import SimulatedBench
from ir50p_lab.course.torque.views import thesis_pid
from ir50p_lab.identification import fit, identify, load_excitations, process, regressor, validate
from ir50p_lab.identification.excitation import regressor_condition
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals.fourier import heights

MOTIONS = load_excitations()


def run(name, seed=5, seconds=40, arm=IR50P, **options):
    motion = MOTIONS[name]
    with SimulatedBench(arm, seed=seed, q0=motion.q_start, record_to=False, **options) as bench:
        return bench.follow(thesis_pid(), motion, seconds)


@pytest.fixture(scope="module")
def records():
    return run("training"), run("validation 1", seed=6)


def test_the_recipe_is_its_steps(records):
    train, valid = records
    found = identify(train, l2=0.2)
    motion = process(train, cutoff_hz=1.2, delay=0.02, slow=0.05)
    Phi = regressor(motion.q, motion.qd, motion.qdd, sign=0.05)
    again = fit(Phi, motion.u, method="bounded", l2=0.2, use=motion.use)
    np.testing.assert_array_equal(found.theta, again.theta)
    np.testing.assert_array_equal(found.stderr, again.stderr)
    np.testing.assert_allclose(found.theta[1:, 5], 0.2 * found.theta[1:, 3])
    score = found.score(valid)
    same = validate(found, valid, cutoff_hz=1.2, delay=0.02, sign=0.05)
    np.testing.assert_array_equal(score.fit, same.fit)
    assert (score.fit > [88, 85, 88]).all()  # on everything that is not ideal, 40 s


def test_two_recordings_are_better_than_one(records):
    """One recording given twice has no new noise: the same numbers, and errors smaller by the root of two."""
    train, valid = records
    one, twice = identify(train, l2=0.2), identify([train, train], l2=0.2)
    seen = np.isfinite(one.stderr) & (one.stderr > 0)
    np.testing.assert_allclose(twice.theta, one.theta, atol=1e-6)
    assert np.median(twice.stderr[seen] / one.stderr[seen]) == pytest.approx(np.sqrt(0.5), abs=0.05)
    assert len(identify([train, valid], l2=0.2).residuals) > 1.9 * len(one.residuals)


def test_samples_that_do_not_count_do_not_matter(records):
    motion = process(records[0], delay=0.02, slow=0.05)
    Phi = regressor(motion.q, motion.qd, motion.qdd)
    spoilt = np.where(motion.use, motion.u, 1e4)
    for method in ("ls", "bounded"):
        clean, other = (fit(Phi, u, method=method, use=motion.use) for u in (motion.u, spoilt))
        np.testing.assert_allclose(clean.theta, other.theta, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(clean.sigma, other.sigma, rtol=1e-9)
    kept = [fit(Phi[use], motion.u[use]).theta[j] for j, use in enumerate(motion.use.T)]
    np.testing.assert_allclose(fit(Phi, motion.u, use=motion.use).theta, kept, rtol=1e-7, atol=1e-7)


def test_the_motions_in_the_file():
    assert [*MOTIONS] == ["plain", "training", *(f"validation {k}" for k in range(1, 21))]
    assert len({motion.a for motion in MOTIONS.values()}) == 22
    conditions = {name: regressor_condition(motion) for name, motion in MOTIONS.items()}
    assert all((conditions[name] < 20).all() for name in MOTIONS if name != "plain")
    assert (conditions["plain"] > 1.5 * conditions["training"]).all()
    assert all(motion.duration == 110 for motion in MOTIONS.values())


def test_the_motions_in_the_file_keep_the_limits_they_were_made_for():
    top = 0.9 * np.array(IR50P.actuators.no_load_speed)
    for motion in MOTIONS.values():
        q, qd, _ = np.swapaxes(motion.sample(np.linspace(0, motion.period, 5000)), 0, 1)
        assert (q > np.add(IR50P.q_min, SETTINGS["margin"]) - 1e-3).all()
        assert (q < np.subtract(IR50P.q_max, SETTINGS["margin"]) + 1e-3).all()
        assert (np.abs(qd) < top + 1e-3).all()
        assert np.min(heights(IR50P.l, q)) > SETTINGS["table"] - 1e-3


def test_motions_come_back_as_they_were(tmp_path):
    save_excitations(tmp_path / "some.json", {"x": MOTIONS["training"]}, made_by="here")
    assert load_excitations(tmp_path / "some.json") == {"x": MOTIONS["training"]}
    (tmp_path / "bad.json").write_text("{}")
    refused("not a file of excitations", load_excitations, tmp_path / "bad.json")
    refused("not a file of excitations", load_excitations, tmp_path / "none.json")


@pytest.mark.parametrize(
    "options, words",
    [
        ({"recordings": []}, "no recording"),
        ({"delay": -1}, "delay"),
        ({"method": "best"}, "method"),
    ],
)
def test_bad_arguments(options, words):
    record = run("training", seconds=5)
    refused(words, identify, **{"recordings": record, **options})


def test_a_run_that_contradicts_the_others_is_named(records):
    """A fresher battery in one, an unlike load; three that agree say nothing."""
    train, valid = records
    third, loaded = run("validation 2", seed=5), run("validation 1", arm=IR50P.with_payload(0.1))
    fresher = SimpleNamespace(t=valid.t, q=valid.q, u=valid.u / 1.15)
    agreed = identify([train, valid, third], l2=0.2)
    assert not any("contradicts" in text for text in agreed.warnings)
    for odd in (fresher, loaded):
        found = identify([train, odd, third], l2=0.2)
        assert any("recording 2 contradicts the others" in text for text in found.warnings)
        seen = np.isfinite(found.stderr) & np.isfinite(agreed.stderr) & (agreed.stderr > 0)
        assert np.median(found.stderr[seen] / agreed.stderr[seen]) > 2
    assert "contradicts the others" in " ".join(identify([fresher, train], l2=0.2).warnings)
