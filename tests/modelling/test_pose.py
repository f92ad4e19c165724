"""Pose module against hand-written elementary matrices, NumPy's linear algebra and finite differences."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ir50p_lab.errors import InputError, LabError
from ir50p_lab.modelling import pose

ANGLE = st.floats(-10.0, 10.0)
ANGLES = st.tuples(ANGLE, ANGLE, ANGLE)
COORDINATE = st.floats(-5.0, 5.0)
VECTOR = st.tuples(COORDINATE, COORDINATE, COORDINATE)
SEQUENCE = st.sampled_from(pose.SEQUENCES)

REPEATABLE = settings(deadline=None, derandomize=True)  # the first call imports SciPy


def by_hand(letter, angle):
    """The elementary rotation written out: entry by entry, without SciPy."""
    c, s = np.cos(angle), np.sin(angle)
    return {
        "X": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "Y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "Z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[letter]


def product_by_hand(sequence, angles):
    first, second, third = (by_hand(letter, angle) for letter, angle in zip(sequence, angles, strict=True))
    return first @ second @ third


@pytest.mark.parametrize(("rot", "letter"), [(pose.rot_x, "X"), (pose.rot_y, "Y"), (pose.rot_z, "Z")])
@REPEATABLE
@given(angle=ANGLE)
def test_elementary_rotations(rot, letter, angle):
    np.testing.assert_allclose(rot(angle), by_hand(letter, angle), atol=1e-15)


@REPEATABLE
@given(sequence=SEQUENCE, angles=ANGLES)
def test_rotation_is_the_product_about_moving_axes(sequence, angles):
    R = pose.rotation_from_angles(sequence, angles)
    np.testing.assert_allclose(R, product_by_hand(sequence, angles), atol=2e-14)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=2e-15)
    assert np.linalg.det(R) == pytest.approx(1, abs=1e-14)


@REPEATABLE
@given(sequence=SEQUENCE, angles=ANGLES)
def test_angles_of_a_matrix_give_the_matrix_everywhere(sequence, angles):
    # Within 1e-7 rad of a singularity the third angle is set to 0, which costs up to that much.
    R = product_by_hand(sequence, angles)
    back = pose.angles_from_rotation(sequence, R)
    np.testing.assert_allclose(product_by_hand(sequence, back), R, atol=3e-7)
    low, high = pose.singular_angles(sequence)
    assert low - 1e-12 <= back[1] <= high + 1e-12
    assert np.all(np.abs(back[[0, 2]]) <= np.pi + 1e-12)


@pytest.mark.parametrize("sequence", pose.SEQUENCES)
@pytest.mark.parametrize("end", [0, 1])
def test_at_a_singularity_the_matrix_is_reproduced_with_third_angle_zero(sequence, end):
    middle = pose.singular_angles(sequence)[end]
    R = product_by_hand(sequence, (0.7, middle, -1.9))
    back = pose.angles_from_rotation(sequence, R)
    np.testing.assert_allclose(product_by_hand(sequence, back), R, atol=1e-12)
    assert back[2] == 0


@REPEATABLE
@given(sequence=SEQUENCE, angles=st.tuples(*[st.floats(-3.0, 3.0)] * 3), rates=VECTOR)
def test_rate_matrix_is_the_derivative_of_the_rotation(sequence, angles, rates):
    # Independent route: dR/dt R^T is the skew matrix of omega, by central differences.
    step = 1e-5
    angles, rates = np.array(angles), np.array(rates)
    ahead, behind = (product_by_hand(sequence, angles + sign * step * rates) for sign in (1, -1))
    S = (ahead - behind) / (2 * step) @ product_by_hand(sequence, angles).T
    omega = np.array([S[2, 1] - S[1, 2], S[0, 2] - S[2, 0], S[1, 0] - S[0, 1]]) / 2
    np.testing.assert_allclose(pose.rate_matrix(sequence, angles) @ rates, omega, atol=2e-6)


@REPEATABLE
@given(sequence=SEQUENCE, angles=st.tuples(*[st.floats(-3.0, 3.0)] * 3))
def test_gimbal_lock_measures_the_middle_angle(sequence, angles):
    lock = pose.gimbal_lock(sequence, angles)
    middle = angles[1]
    cosine_of_axes, sine = (
        (np.cos(middle), np.sin(middle)) if sequence in pose.EULERIAN else (np.sin(middle), np.cos(middle))
    )
    assert lock.sine == pytest.approx(abs(sine), abs=1e-14)
    # The three axes are two unit vectors at that angle and one normal to both: smallest singular value known.
    if abs(sine) > 1e-3:
        assert lock.gain == pytest.approx(1 / np.sqrt(1 - abs(cosine_of_axes)), rel=1e-8)


@pytest.mark.parametrize("sequence", pose.SEQUENCES)
@pytest.mark.parametrize("end", [0, 1])
def test_at_a_singularity_no_angle_rate_turns_about_the_lost_axis(sequence, end):
    angles = (0.4, pose.singular_angles(sequence)[end], 1.1)
    lock = pose.gimbal_lock(sequence, angles)
    assert lock.sine < 1e-15
    assert lock.gain > 1e14
    E = pose.rate_matrix(sequence, angles)
    np.testing.assert_allclose(lock.lost_axis @ E, 0, atol=1e-7)
    # It is normal to the axes of the first and of the second turn.
    normal = np.cross(E[:, 0], E[:, 1])
    assert abs(lock.lost_axis @ normal) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("leading", [(), (2, 3), (0,)])
def test_every_function_keeps_leading_dimensions(leading):
    angles = np.random.default_rng(1).uniform(-1, 1, (*leading, 3))
    R, lock = pose.rotation_from_angles("YZX", angles), pose.gimbal_lock("YZX", angles)
    assert R.shape == pose.rate_matrix("YZX", angles).shape == pose.rot_z(angles[..., 0]).shape == (*leading, 3, 3)
    assert pose.angles_from_rotation("YZX", R).shape == lock.lost_axis.shape == angles.shape
    assert lock.sine.shape == leading and pose.homogeneous(R, angles).shape == (*leading, 4, 4)
    for place in np.ndindex(*leading):
        np.testing.assert_array_equal(R[place], pose.rotation_from_angles("YZX", angles[place]))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: pose.rot_x(np.nan), "NaN or infinity"),
        (lambda: pose.rot_y("quarter"), "angle must hold numbers in rad; got 'quarter'"),
        (lambda: pose.rotation_from_angles("XYZ", (1, 2)), r"angles has shape \(2,\); give shape \(3,\)"),
        (lambda: pose.rotation_from_angles("XXY", (1, 2, 3)), "sequence = 'XXY': choose 'XYX'"),
        (lambda: pose.singular_angles("XYW"), "sequence = 'XYW': choose"),
        (lambda: pose.rate_matrix("ABC", (0, 0, 0)), "sequence = 'ABC': choose"),
        (lambda: pose.angles_from_rotation("ABC", np.eye(3)), "sequence = 'ABC': choose"),
        (lambda: pose.angles_from_rotation("XYZ", np.eye(4)), r"R has shape \(4, 4\)"),
        (lambda: pose.check_rotation(np.diag([1, 1, -1])), "det R is -1.*reflection"),
        (lambda: pose.check_rotation(2 * np.eye(3)), "R\\^T R - I is 3 and det R is 8"),
        (lambda: pose.check_rotation([np.eye(3), np.zeros((3, 3))]), "R is not a rotation.*det R is 0"),
        (lambda: pose.homogeneous(np.ones((3, 3))), "not a rotation"),
        (lambda: pose.homogeneous(t=(1, 2)), "t has shape"),
    ],
)
def test_bad_input_is_refused_with_the_reason(call, message):
    with pytest.raises(InputError, match=message) as caught:
        call()
    assert isinstance(caught.value, LabError) and isinstance(caught.value, ValueError)
