"""The table of what is not ideal, and the copies drawn from it."""

import numpy as np
import pytest

from ir50p_lab.bench import UNIT, ArmInstance, SimulatedArm, SimulatedBench
from ir50p_lab.errors import InputError
from ir50p_lab.modelling import IR50P

DRAWN = ("motor_gain", "friction", "pot_slope", "pot_shift", "pot_bow")


def test_a_seed_is_one_copy():
    assert UNIT.drawn(3) == UNIT.drawn(3)
    assert UNIT.drawn(3) != UNIT.drawn(4)
    assert UNIT.drawn(3).drawn(5) == UNIT.drawn(3)  # a copy is a copy


def test_copies_stay_within_the_tolerances_and_use_them():
    copies = [UNIT.drawn(seed) for seed in range(200)]
    widths = {"motor_gain": 0.03, "friction": 0.05, "pot_slope": 0.01, "pot_shift": 3.0, "pot_bow": 0.5}
    for name in DRAWN:
        off = np.array([getattr(copy, name) for copy in copies]) - getattr(UNIT, name)
        assert np.abs(off).max() <= widths[name]
        assert np.abs(off).max() > 0.9 * widths[name]
        assert np.abs(off.mean(axis=0)).max() < 0.15 * widths[name]
        assert abs(np.corrcoef(off.T)[0, 1]) < 0.2  # the joints differ from each other


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("noise", np.nan),
        ("backlash", (0.1, 0.1)),
        ("delay", 1.5),
        ("delay", 1000),
    ],
)
def test_impossible_values_are_refused_by_name(field, value):
    with pytest.raises(InputError, match=field):
        ArmInstance(**{field: value})


def test_the_environment_chooses_the_copy(monkeypatch):
    """IR50P_UNIT moves every copy of a course on, IR50P_SEED gives the same copies other noise."""
    plain = [SimulatedArm(IR50P, seed=seed) for seed in (0, 2, 3)]
    monkeypatch.setenv("IR50P_UNIT", "2")
    moved = [SimulatedArm(IR50P, seed=seed) for seed in (0, 1)]
    monkeypatch.setenv("IR50P_SEED", "5")
    other = SimulatedArm(IR50P)
    assert plain[0].unit != moved[0].unit == plain[1].unit == other.unit and moved[1].unit == plain[2].unit
    pictures = [[tuple(one.counts()) for _ in range(50)] for one in (plain[1], moved[0], other)]
    assert pictures[0] == pictures[1] != pictures[2]


def test_the_bench_says_which_copy_it_is(monkeypatch):
    monkeypatch.setenv("IR50P_UNIT", "2")
    assert SimulatedBench(IR50P, seed=1, record_to=False).name == "simulated IR50P, unit 3"
    monkeypatch.setenv("IR50P_SEED", "5")
    with SimulatedBench(IR50P, record_to=False) as bench:
        for _ in bench.run(0.1):
            pass
    assert bench.name == "simulated IR50P, unit 2, noise 5"
    assert (bench.recording.header["seed"], bench.recording.header["noise_seed"]) == ("2", "5")


@pytest.mark.parametrize("variable", ["IR50P_UNIT", "IR50P_SEED"])
def test_what_is_no_number_of_a_copy_is_refused(variable, monkeypatch):
    for text in ("-1", "1.5", "first"):
        monkeypatch.setenv(variable, text)
        with pytest.raises(InputError, match=variable):
            SimulatedArm(IR50P)
