"""Pose module against hand-written elementary matrices, NumPy's linear algebra and finite differences."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ir50p_lab.errors import InputError, LabError
from ir50p_lab.modelling import pose

ANGLE = st.floats(-10.0, 10.0)

REPEATABLE = settings(deadline=None, derandomize=True)  # the first call imports SciPy


def by_hand(letter, angle):
    """The elementary rotation written out: entry by entry, without SciPy."""
    c, s = np.cos(angle), np.sin(angle)
    return {
        "X": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "Y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "Z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[letter]


@pytest.mark.parametrize(("rot", "letter"), [(pose.rot_x, "X"), (pose.rot_y, "Y"), (pose.rot_z, "Z")])
@REPEATABLE
@given(angle=ANGLE)
def test_elementary_rotations(rot, letter, angle):
    np.testing.assert_allclose(rot(angle), by_hand(letter, angle), atol=1e-15)


@pytest.mark.parametrize("leading", [(), (2, 3), (0,)])
def test_every_function_keeps_leading_dimensions(leading):
    angles = np.random.default_rng(1).uniform(-1, 1, (*leading, 3))
    R = pose.rot_z(angles[..., 0])
    assert R.shape == (*leading, 3, 3)
    for place in np.ndindex(*leading):
        np.testing.assert_array_equal(R[place], pose.rot_z(angles[place][0]))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: pose.rot_x(np.nan), "NaN or infinity"),
        (lambda: pose.rot_y("quarter"), "angle must hold numbers in rad; got 'quarter'"),
    ],
)
def test_bad_input_is_refused_with_the_reason(call, message):
    with pytest.raises(InputError, match=message) as caught:
        call()
    assert isinstance(caught.value, LabError) and isinstance(caught.value, ValueError)
