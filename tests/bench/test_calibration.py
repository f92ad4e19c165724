"""Calibration of the joints: truth recovered within its standard errors, the right regression, faults in the data named."""

import dataclasses
import math

import numpy as np
import pytest
from arms import random_arm
from hypothesis import given
from hypothesis import strategies as st

from ir50p_lab.bench import JointCalibration, fit_calibration, nominal_calibration
from ir50p_lab.errors import InputError, SuspiciousArmWarning
from ir50p_lab.modelling import IR50P

TRUTH = nominal_calibration(IR50P)
LOW, HIGH = np.array(IR50P.q_min), np.array(IR50P.q_max)


def experiment(seed=0, m=12, error=0.01, span=1.0):
    rng = np.random.default_rng(seed)
    middle, half = (LOW + HIGH) / 2, span * (HIGH - LOW) / 2
    q = middle + half * rng.permuted(np.repeat(np.linspace(-1, 1, m)[:, None], 3, axis=1), axis=0)
    return q + rng.normal(0, error, q.shape), TRUTH.counts(q)


@given(st.integers(0, 10**6))
def test_exact_data_give_the_exact_line(seed):
    rng = np.random.default_rng(seed)
    slope, zero = rng.uniform(50, 190, 3), rng.uniform(450, 560, 3)
    q = rng.uniform(-1.5, 1.5, (8, 3))
    found = fit_calibration(q, zero + slope * q)
    np.testing.assert_allclose(found.slope, slope, rtol=1e-9)
    np.testing.assert_allclose(found.zero, zero, rtol=1e-9)
    np.testing.assert_allclose(found.radians(found.counts(q)), q, atol=1e-12)


def test_the_line_is_that_of_polyfit():
    q, counts = experiment()
    read = fit_calibration(q, counts)
    for i in range(3):
        (b, a), cov = np.polyfit(counts[:, i], q[:, i], 1, cov=True)
        assert read.slope[i] == pytest.approx(1 / b) and read.zero[i] == pytest.approx(-a / b)
        assert read.stderr_slope[i] == pytest.approx(math.sqrt(cov[0, 0]) / b**2, rel=1e-6)


def test_standard_errors_are_the_spread_of_many_experiments():
    fits = [fit_calibration(*experiment(seed)) for seed in range(300)]
    for value, error, truth in (("slope", "stderr_slope", TRUTH.slope), ("zero", "stderr_zero", TRUTH.zero)):
        values = np.array([getattr(fit, value) for fit in fits])
        said = np.sqrt(np.mean([np.square(getattr(fit, error)) for fit in fits], axis=0))
        np.testing.assert_allclose(values.std(axis=0), said, rtol=0.15)
        np.testing.assert_allclose(values.mean(axis=0), truth, atol=4 * said.max() / math.sqrt(300))


def test_errors_of_the_protractor_make_the_usual_regression_too_flat():
    span, error = 0.1, 0.05  # narrow and rough, to see it well
    data = [experiment(seed, m=40, error=error, span=span) for seed in range(60)]
    with_counts = np.mean([fit_calibration(*d).slope for d in data], axis=0)
    usual = np.mean(
        [[np.polyfit(q, c, 1)[0] for q, c in zip(*map(np.transpose, d), strict=True)] for d in data], axis=0
    )
    np.testing.assert_allclose(with_counts, TRUTH.slope, rtol=0.02)
    variance = np.var(np.linspace(-1, 1, 40)) * (span * (HIGH - LOW) / 2) ** 2
    np.testing.assert_allclose(usual / TRUTH.slope, variance / (variance + error**2), rtol=0.03)


def test_the_points_of_a_calibration_give_it_again():
    whole = fit_calibration(*experiment(), arm=IR50P)
    q, counts = np.transpose(whole.points, (1, 2, 0))
    assert fit_calibration(q, counts, arm="IR50P") == whole
    few = fit_calibration(q[:5], counts[:5])
    assert [len(r) for r in few.residuals] == [5, 5, 5]
    assert any("joint 3: only 5 points" in text for text in few.remarks)


# ---- what looks wrong


def test_good_data_give_no_remarks():
    assert sum(bool(fit_calibration(*experiment(seed)).remarks) for seed in range(50)) <= 5


@pytest.mark.parametrize("size", [0.1, 0.2, 0.3])
def test_a_bow_is_seen(size):
    q, counts = experiment()
    x = (counts[:, 1] - 512) / 200
    q[:, 1] += size * x**2
    remarks = fit_calibration(q, counts).remarks
    assert "joint 2: the line leaves a bow" in remarks[-1] and all("joint 2" in text for text in remarks)


@pytest.mark.parametrize("size", [0.1, -0.3, 1.0])
def test_a_misread_point_is_named(size):
    q, counts = experiment()
    q[4, 0] += size
    remarks = fit_calibration(q, counts).remarks
    assert any("joint 1: point 5" in text for text in remarks)


@pytest.mark.parametrize("scale", [0.5, 1.0, 1.5])
def test_a_negative_slope_is_warned_of(scale):
    q, counts = experiment()
    counts[:, 2] = 512 - scale * (counts[:, 2] - 512) / 1.6
    with pytest.warns(SuspiciousArmWarning, match="joint 3.*negative.*run away"):
        fit_calibration(q, counts)


def test_narrow_and_rough_data_are_remarked():
    remarks = " ".join(fit_calibration(*experiment(span=0.08, error=0.02)).remarks)
    assert "span" in remarks
    q, counts = experiment()
    assert "end of the converter" in " ".join(fit_calibration(q, counts - counts.min(axis=0)).remarks)


@pytest.mark.parametrize(("joint", "offset", "sign"), [(1, 400, 1), (1, 270, 1), (1, 230, 1), (1, 230, -1)])
def test_a_wrapping_potentiometer_is_refused(joint, offset, sign):
    q, counts = experiment()
    counts[:, 0] = (512 + sign * (counts[:, 0] - 512) + sign * offset) % 1024
    with pytest.raises(InputError, match=r"joint 1: the counts do not follow .* the gap of its track"):
        fit_calibration(q, counts)


@pytest.mark.parametrize(("i", "j"), [(0, 1), (1, 2), (0, 2)])
def test_swapped_cables_are_named(i, j):
    q, counts = experiment()
    counts[:, [i, j]] = counts[:, [j, i]]
    with pytest.raises(InputError, match="swapped"):
        fit_calibration(q, counts)


def spoilt(change):
    q, counts = experiment()
    return change(q, counts)


def _put(array, place, value):
    array = array.copy()
    array[place] = value
    return array


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda q, c: (np.degrees(q), c), "in degrees"),
        (lambda q, c: (q, c * 4), "10-bit"),
        (lambda q, c: (q, c - 600), "10-bit"),
        (lambda q, c: (_put(q, (3, 1), math.nan), c), "holds nan"),
        (lambda q, c: (q, _put(c, (3, 1), math.inf)), "holds inf"),
        (lambda q, c: (q[:2], c[:2]), "row per pose"),
        (lambda q, c: (q[:1], c[:1]), "row per pose"),
        (lambda q, c: (q[:5], c), "pairs"),
        (lambda q, c: (q[:, 0], c[:, 0]), "give shape"),
        (lambda q, c: (q[:, :2], c[:, :2]), "give shape"),
        (lambda q, c: (_put(q, (slice(None), 1), 0.5), c), "nothing moved"),
        (lambda q, c: (q, _put(c, (slice(None), 1), 512)), "nothing moved"),
        (lambda q, c: (q, np.random.default_rng(0).uniform(400, 600, c.shape)), "do not follow"),
    ],
)
def test_what_no_line_fits_is_refused(change, match):
    with pytest.raises(InputError, match=match):
        fit_calibration(*spoilt(change))


@pytest.mark.parametrize(
    ("fields", "match"),
    [
        ({"slope": (189, 0, 191)}, "joint 2 is 0"),
        ({"slope": (189, math.nan, 191)}, "slope holds nan"),
        ({"slope": (189, 191)}, "slope"),
        ({"zero": (512, math.inf, 512)}, "zero holds inf"),
    ],
)
def test_impossible_calibrations(fields, match):
    with pytest.raises(InputError, match=match):
        JointCalibration(**{"slope": (189, 122, 191), "zero": (512, 512, 512)} | fields)


# ---- files


def test_a_file_gives_the_same_calibration(tmp_path):
    found = fit_calibration(*experiment(), arm=IR50P, source='by "me", Nov 21')
    assert JointCalibration.load(found.save(tmp_path / "mine.toml")) == found


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("slope = [1, 2", "no calibration"),
        ("slope = [189, 122, 191]", "missing 1 required .*'zero'"),
        ("slope = [189, 122, 191]\nzero = [512, 512]", "zero"),
        ("slope = [189, 0, 191]\nzero = [512, 512, 512]", "joint 2 is 0"),
        ("slope = [189, nan, 191]\nzero = [512, 512, 512]", "nan"),
        ("slope = [189, 122, 191]\nzero = [512, 512, 512]\ngain = 3", "unexpected keyword argument 'gain'"),
        ("slope = [189, 122, 191]\nzero = [512, 512, 512]\n[joint1]\nq = [1]\ncounts = [1, 2]", "pairs"),
        ("slope = [189, 122, 191]\nzero = [512, 512, 512]\n[joint1]\nq = [1]", "missing 1 required .*'counts'"),
    ],
)
def test_broken_files(tmp_path, text, match):
    path = tmp_path / "c.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=match) as caught:
        JointCalibration.load(path)
    assert "c.toml" in str(caught.value)


def test_table_and_header():
    found = fit_calibration(*experiment(), source="me")
    table = repr(found).splitlines()
    assert len(table) == 5 + len(found.remarks) and "source: me" in table
    slope, error, zero, zero_error, rms = map(float, table[2].split()[1:])  # joint 2
    assert (slope, error) == pytest.approx((found.slope[1], found.stderr_slope[1]), abs=0.005)
    assert (zero, zero_error) == pytest.approx((found.zero[1], found.stderr_zero[1]), abs=0.005)
    assert rms == pytest.approx(np.degrees(found.residuals[1].std()), abs=0.01)
    assert repr(TRUTH).count("None") == 9 and "nominal, not measured" in repr(TRUTH)
    assert set(found.header()) == {"counts_per_rad", "counts_at_zero", "calibration"}
    assert TRUTH.residuals == []


@given(st.integers(0, 10**6))
def test_the_travel_of_any_arm_fits_the_converter(seed):
    rng = np.random.default_rng(seed)
    middle, half = rng.uniform(-1, 1, 3), rng.uniform(0.1, 3, 3)
    arm = dataclasses.replace(random_arm(rng), q_min=middle - half, q_max=middle + half)
    nominal = nominal_calibration(arm)
    ends = nominal.counts(np.clip([arm.q_min, arm.q_max], -np.pi, np.pi))
    assert ends.min() >= 20 and ends.max() <= 1004 and (np.array(nominal.slope) > 0).all()
