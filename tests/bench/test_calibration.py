"""Calibration of the joints: truth recovered within its standard errors, the right regression, faults in the data named."""

import dataclasses
import math

import numpy as np
import pytest
from arms import random_arm
from hypothesis import given
from hypothesis import strategies as st
from refusals import refused

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


def test_the_line_is_that_of_polyfit():
    q, counts = experiment()
    read = fit_calibration(q, counts)
    for i in range(3):
        (b, a), cov = np.polyfit(counts[:, i], q[:, i], 1, cov=True)
        assert read.slope[i] == pytest.approx(1 / b) and read.zero[i] == pytest.approx(-a / b)
        assert read.stderr_slope[i] == pytest.approx(math.sqrt(cov[0, 0]) / b**2, rel=1e-6)


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


def test_a_misread_point_is_named():
    q, counts = experiment()
    q[4, 0] += 0.1
    remarks = fit_calibration(q, counts).remarks
    assert any("joint 1: point 5" in text for text in remarks)


def test_a_negative_slope_is_warned_of():
    q, counts = experiment()
    counts[:, 2] = 512 - (counts[:, 2] - 512) / 1.6
    with pytest.warns(SuspiciousArmWarning, match="joint 3.*negative.*run away"):
        fit_calibration(q, counts)


def test_narrow_and_rough_data_are_remarked():
    remarks = " ".join(fit_calibration(*experiment(span=0.08, error=0.02)).remarks)
    assert "span" in remarks
    q, counts = experiment()
    assert "end of the converter" in " ".join(fit_calibration(q, counts - counts.min(axis=0)).remarks)


@pytest.mark.parametrize(("offset", "sign"), [(400, 1), (230, -1)])
def test_a_wrapping_potentiometer_is_refused(offset, sign):
    q, counts = experiment()
    counts[:, 0] = (512 + sign * (counts[:, 0] - 512) + sign * offset) % 1024
    refused(r"joint 1: the counts do not follow .* the gap of its track", fit_calibration, q, counts)


def test_swapped_cables_are_named():
    q, counts = experiment()
    counts[:, [0, 2]] = counts[:, [2, 0]]
    refused("swapped", fit_calibration, q, counts)


def with_one(array, place, value):
    array = array.copy()
    array[place] = value
    return array


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda q, c: (np.degrees(q), c), "in degrees"),
        (lambda q, c: (q, c * 4), "10-bit"),
        (lambda q, c: (with_one(q, (3, 1), math.nan), c), "holds nan"),
        (lambda q, c: (q[:2], c[:2]), "row per pose"),
        (lambda q, c: (q[:5], c), "pairs"),
        (lambda q, c: (q[:, 0], c[:, 0]), "give shape"),
        (lambda q, c: (with_one(q, (slice(None), 1), 0.5), c), "nothing moved"),
        (lambda q, c: (q, np.random.default_rng(0).uniform(400, 600, c.shape)), "do not follow"),
    ],
)
def test_what_no_line_fits_is_refused(change, match):
    refused(match, fit_calibration, *change(*experiment()))


def test_an_impossible_calibration():
    refused("joint 2 is 0", JointCalibration, slope=(189, 0, 191), zero=(512, 512, 512))


# ---- files


def test_a_file_gives_the_same_calibration(tmp_path):
    found = fit_calibration(*experiment(), arm=IR50P, source='by "me", Nov 21')
    path = found.save(tmp_path / "mine.toml")
    assert JointCalibration.load(path) == found
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())  # as editors of Windows save it
    assert JointCalibration.load(path) == found


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("slope = [1, 2", "not a calibration"),
        ("slope = [189, 122, 191]", "missing 1 required .*'zero'"),
        ("slope = [189, nan, 191]\nzero = [512, 512, 512]", "nan"),
        ("slope = [189, 122, 191]\nzero = [512, 512, 512]\ngain = 3", "unexpected keyword argument 'gain'"),
        ("slope = [189, 122, 191]\nzero = [512, 512, 512]\n[joint1]\nq = [1]\ncounts = [1, 2]", "pairs"),
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
    row = [found.slope[1], found.stderr_slope[1], found.zero[1], found.stderr_zero[1]]  # joint 2
    assert [float(one) for one in table[2].split()[1:5]] == pytest.approx(row, abs=0.005)
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
