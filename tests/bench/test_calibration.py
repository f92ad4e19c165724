"""Calibration of the joints: what cannot be is refused, files give it again, the nominal one fits any arm."""

import dataclasses
import math

import numpy as np
import pytest
from arms import random_arm
from hypothesis import given
from hypothesis import strategies as st

from ir50p_lab.bench import JointCalibration, nominal_calibration
from ir50p_lab.errors import InputError, SuspiciousArmWarning
from ir50p_lab.modelling import IR50P

TRUTH = nominal_calibration(IR50P)
MEASURED = JointCalibration(
    (190, 120, 191), (512, 470, 700), (0.5, 0.4, 0.6), (0.2, 0.3, 0.2), 'by "me", Nov 21', "IR50P"
)


def test_a_negative_slope_is_warned_of():
    with pytest.warns(SuspiciousArmWarning, match="joint 3.*negative.*run away"):
        JointCalibration((189, 122, -120), (512, 512, 512))


@pytest.mark.parametrize(
    ("fields", "match"),
    [
        ({"slope": (189, 0, 191)}, "joint 2 is 0"),
        ({"slope": (189, math.nan, 191)}, "slope holds nan"),
    ],
)
def test_impossible_calibrations(fields, match):
    with pytest.raises(InputError, match=match):
        JointCalibration(**{"slope": (189, 122, 191), "zero": (512, 512, 512)} | fields)


# ---- files


def test_a_file_gives_the_same_calibration(tmp_path):
    path = MEASURED.save(tmp_path / "mine.toml")
    assert JointCalibration.load(path) == MEASURED
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())  # as editors of Windows save it
    assert JointCalibration.load(path) == MEASURED
    older = "".join(f"[joint{joint}]\nq = [1.0, 2.0]\ncounts = [1, 2]\n" for joint in (1, 2, 3))
    path.write_text(path.read_text("utf-8-sig") + 'remarks = ["only 5 points"]\n' + older, encoding="utf-8")
    assert JointCalibration.load(path) == MEASURED


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("slope = [1, 2", "no calibration"),
        ("slope = [189, 122, 191]", "missing 1 required .*'zero'"),
        ("slope = [189, nan, 191]\nzero = [512, 512, 512]", "nan"),
        ("slope = [189, 122, 191]\nzero = [512, 512, 512]\ngain = 3", "unexpected keyword argument 'gain'"),
    ],
)
def test_broken_files(tmp_path, text, match):
    path = tmp_path / "c.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=match) as caught:
        JointCalibration.load(path)
    assert "c.toml" in str(caught.value)


def test_table_and_header():
    table = repr(MEASURED).splitlines()
    assert len(table) == 5 and table[-1] == 'source: by "me", Nov 21'
    assert [float(one) for one in table[2].split()[1:5]] == [120, 0.4, 470, 0.3]  # joint 2
    assert repr(TRUTH).count("None") == 6 and "nominal, not measured" in repr(TRUTH)
    assert set(MEASURED.header()) == {"counts_per_rad", "counts_at_zero", "calibration"}


@given(st.integers(0, 10**6))
def test_the_travel_of_any_arm_fits_the_converter(seed):
    rng = np.random.default_rng(seed)
    middle, half = rng.uniform(-1, 1, 3), rng.uniform(0.1, 3, 3)
    arm = dataclasses.replace(random_arm(rng), q_min=middle - half, q_max=middle + half)
    nominal = nominal_calibration(arm)
    ends = nominal.counts(np.clip([arm.q_min, arm.q_max], -np.pi, np.pi))
    assert ends.min() >= 20 and ends.max() <= 1004 and (np.array(nominal.slope) > 0).all()
