"""The table of what is not ideal, and the copies drawn from it."""

import dataclasses

import numpy as np
import pytest

from ir50p_lab.bench import UNIT, Unit
from ir50p_lab.errors import InputError

DRAWN = ("motor_gain", "friction", "pot_slope", "pot_shift", "pot_bow")


def test_the_table_is_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        UNIT.noise = 0.0


def test_a_seed_is_one_copy():
    assert UNIT.drawn(3) == UNIT.drawn(3)
    assert UNIT.drawn(3) != UNIT.drawn(4)
    assert UNIT.drawn(3).drawn(5) == UNIT.drawn(3)  # a copy is a copy


def test_without_spread_every_copy_is_the_nominal_one():
    assert Unit(spread=0).drawn(7) == Unit(spread=0)


def test_copies_stay_within_the_tolerances_and_use_them():
    copies = [UNIT.drawn(seed) for seed in range(200)]
    widths = {"motor_gain": 0.03, "friction": 0.05, "pot_slope": 0.01, "pot_shift": 3.0, "pot_bow": 0.5}
    for name in DRAWN:
        off = np.array([getattr(copy, name) for copy in copies]) - getattr(UNIT, name)
        assert np.abs(off).max() <= widths[name]
        assert np.abs(off).max() > 0.9 * widths[name]
        assert np.abs(off.mean(axis=0)).max() < 0.15 * widths[name]
        assert abs(np.corrcoef(off.T)[0, 1]) < 0.2  # the joints differ from each other


def test_half_the_spread_is_half_the_difference():
    full, half = Unit().drawn(1), Unit(spread=0.5).drawn(1)
    np.testing.assert_allclose(np.array(half.pot_shift), 0.5 * np.array(full.pot_shift))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("noise", -1.0),
        ("noise", np.nan),
        ("backlash", (0.1, 0.1)),
        ("dead_zone", (1, -1, 1)),
        ("motor_gain", (0, 1, 1)),
        ("delay", 1.5),
        ("delay", 1000),
        ("spread", -1),
    ],
)
def test_impossible_values_are_refused_by_name(field, value):
    with pytest.raises(InputError, match=field):
        Unit(**{field: value})
