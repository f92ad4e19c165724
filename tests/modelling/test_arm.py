"""Arms: what is refused and why, what is flagged, files, named arms, and what theta means."""

from dataclasses import FrozenInstanceError, fields, replace

import numpy as np
import pytest
from arms import random_arm
from refusals import refused

from ir50p_lab.errors import ArmError, LabError, SuspiciousArmWarning
from ir50p_lab.modelling import (
    IR50P,
    THESIS_A,
    THESIS_C,
    THESIS_RODS,
    Actuators,
    Arm,
    Friction,
    friction_torque,
)

GOOD = {"l": (0.3, 0.2, 0.3), "m": (3, 1, 1), "lc": (0.1, 0.1, 0.1)}


@pytest.mark.parametrize(
    "change, words",
    [
        ({"m": (3, -1, 1)}, ["m2 = -1", "negative"]),
        ({"m": (3, np.nan, 1)}, ["m", "nan"]),
        ({"m": (3, 1)}, ["m", "(2,)"]),
        ({"l": (0.3, 0, 0.3)}, ["l2 = 0", "> 0"]),
        ({"Ixx": (0, 0, 0.2), "Iyy": (0, 0, 0.01), "Izz": (0, 0, 0.01)}, ["Ixx = 0.2", "link 3", "triangle"]),
        ({"Izz": (0, -0.01, 0)}, ["Izz of link 2", "negative"]),
        ({"lc": (0.1, 90.0, 0.1)}, ["lc2 = 90", "millimetres"]),
        ({"g": -9.81}, ["g = -9.81"]),
        ({"q_min": (0, 0, 1), "q_max": (1, 1, 0.5)}, ["joint 3", "q_min = 1", "q_max = 0.5"]),
        ({"q_min": (0, 0)}, ["q_min", "three angles"]),
    ],
)
def test_impossible_arms_are_refused_with_the_reason(change, words):
    refused(words, Arm, **{**GOOD, **change}, error=LabError)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"l": (0.2, 0.2, 0.2), "lc": (0.1, 0.5, 0.1)}, "link 2 is 2.5 link lengths out"),
        ({"lc": (0.1, -0.05, 0.1)}, "behind its joint"),
        ({"l": (285, 200, 372)}, "millimetres"),
        ({"q_min": (-100, -50, -140), "q_max": (100, 110, 30)}, "in degrees"),
    ],
)
def test_suspicious_arms_are_flagged_and_made(change, words):
    with pytest.warns(SuspiciousArmWarning, match=words):
        arm = Arm(**{**GOOD, **change})
    assert any(words in text for text in arm.suspicions)


def test_slender_rods_and_point_masses_are_allowed():
    rod = 1 * 0.3**2 / 12
    assert Arm(**GOOD, Iyy=(0, rod, rod), Izz=(0, rod, rod)).suspicions == ()
    assert Arm(**GOOD).theta.shape == (3, 20)
    assert Arm(**{**GOOD, "lc": GOOD["l"]}).suspicions == ()  # all of the mass at the end of a link: a hand


def test_an_arm_cannot_be_changed():
    with pytest.raises(FrozenInstanceError):
        IR50P.l = (1, 1, 1)
    for theta in (IR50P.theta, IR50P.theta_pwm, THESIS_C):
        with pytest.raises(ValueError, match="read-only"):
            theta[0, 0] = 1.0


def test_theta_has_three_equal_rows_and_no_products_of_inertia():
    theta = random_arm(np.random.default_rng(1), coulomb=True).theta
    assert (theta == theta[0]).all() and (theta[:, 6:8] == 0).all()
    assert THESIS_C[0, 6] == 0.05


def test_an_arm_without_motors_has_no_pwm():
    with pytest.raises(ArmError, match="no actuators"):
        _ = THESIS_A.theta_pwm


def test_without_friction_keeps_the_rotors():
    bare = IR50P.without_friction()
    assert bare.friction == Friction() and bare.actuators == IR50P.actuators


@pytest.mark.parametrize("arm", [IR50P, THESIS_A, THESIS_RODS], ids=lambda a: a.name)
def test_file_round_trip_is_exact(arm, tmp_path):
    path = tmp_path / "arm with space é.toml"
    arm.save(path)
    assert Arm.load(path) == arm
    text = path.read_text(encoding="utf-8")
    assert "kg m^2" in text and "upper arm" in text


@pytest.mark.parametrize(
    "text, words",
    [
        ("l = [1, 2", ["not a TOML file"]),
        ("l = [0.3, 0.2, 0.3]\nm = [1, 1, 1]", ["lacks lc"]),
        ("l = [0.3, 0.2, 0.3]\nm = [1, 1, 1]\nlc = [0.1, 0.1, 0.1]\nmass = 3", ["unknown entry 'mass'", "known: name"]),
        ("l = [0.3, 0.2, 0.3]\nm = [1, 1, 1]\nlc = [0.1, 0.1, 0.1]\n[friction]\nfv = [1, 1, -1]", ["fv of joint 3"]),
        ("l = [0.3, 0.2, 0.3]\nm = [1, 1, 1]\nlc = [0.1, 0.1, 0.1]\nfriction = 3", ["must be a table"]),
    ],
)
def test_broken_files_are_named(text, words, tmp_path):
    path = tmp_path / "broken.toml"
    path.write_text(text)
    refused([str(path), *words], Arm.load, path, error=ArmError)


@pytest.mark.parametrize("encoding, letter", [("latin-1", "é"), ("utf-16", "é"), ("utf-16-le", "e")])
def test_a_file_in_another_encoding_is_told_which_to_use(encoding, letter, tmp_path):
    path = tmp_path / "arm.toml"
    IR50P.save(path)
    path.write_bytes(path.read_text("utf-8").replace("name = ", f"name = '{letter}'  # ").encode(encoding))
    refused(r"arm\.toml is not in UTF-8: .* save it with the encoding UTF-8", Arm.load, path, error=ArmError)


def test_missing_file_is_named(tmp_path):
    refused(r"nowhere\.toml.*IR50P_ARM", Arm.load, tmp_path / "nowhere.toml", error=ArmError)


# --- friction ---------------------------------------------------------------------------------------------


def test_friction_curve_has_the_limits_of_figure_1_9():
    f = Friction(fv=(0.5, 0.5, 0.5), fc=(1, 1, 1), fs=(1.6, 1.6, 1.6), qs=(0.05, 0.05, 0.05))
    np.testing.assert_allclose(friction_torque(f, [1e-9, -1e-9, 0]), [1.6, -1.6, 0], atol=1e-8)
    np.testing.assert_allclose(friction_torque(f, [5, -5, 5]), [3.5, -3.5, 3.5], rtol=1e-12)
    qd = np.random.default_rng(0).normal(0, 1, (500, 3))
    assert (friction_torque(f, qd) * qd >= 0).all()  # friction only takes energy
    np.testing.assert_allclose(friction_torque(f, -qd), -friction_torque(f, qd))


def test_friction_of_an_arm_and_its_offset():
    assert (friction_torque(IR50P, [0, 0, 0]) == np.array(IR50P.friction.Tf)).all()
    assert Friction(fc=(1, 2, 3)).fs == (1, 2, 3)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"fv": (0, -1, 0)}, "fv of joint 2"),
        ({"fc": (1, 1, 1), "fs": (1, 0.5, 1)}, "fs = 0.5"),
        ({"qs": (0.05, 0, 0.05)}, "qs = 0.0"),
        ({"fc": (0, np.nan, 0)}, "nan"),
    ],
)
def test_impossible_friction_is_refused(change, words):
    refused(words, Friction, **change, error=LabError)


# --- motors -----------------------------------------------------------------------------------------------


def test_a_motor_at_full_supply_stalls_and_runs_free_as_computed():
    motors = IR50P.actuators
    np.testing.assert_allclose(motors.voltage(motors.stall_torque, [0, 0, 0]), 12.0)
    np.testing.assert_allclose(motors.voltage([0, 0, 0], motors.no_load_speed), 12.0)
    faster = replace(motors, V=24.0)
    np.testing.assert_allclose(faster.stall_torque, 2 * motors.stall_torque)
    np.testing.assert_allclose(faster.no_load_speed, 2 * motors.no_load_speed)


def test_voltage_follows_from_the_motor_equations():
    # Independent route: armature u = Ra i + ke N qd, shaft kt i = Jm N qdd + tau / N
    m = IR50P.actuators
    tau, qd, qdd = np.random.default_rng(1).normal(0, 2, (3, 3))
    N, Jm, kt, ke, Ra = (np.array(getattr(m, name)) for name in ("N", "Jm", "kt", "ke", "Ra"))
    current = (Jm * N * qdd + tau / N) / kt
    np.testing.assert_allclose(m.voltage(tau, qd, qdd), Ra * current + ke * N * qd, rtol=1e-12)


@pytest.mark.parametrize("field", [f.name for f in fields(Actuators)])
def test_impossible_motors_are_refused(field):
    value = getattr(IR50P.actuators, field)
    bad = -value if np.ndim(value) == 0 else (value[0], -value[1], value[2])
    refused(field, replace, IR50P.actuators, **{field: bad}, error=ArmError)


def test_a_file_saved_by_an_editor_of_windows_is_read(tmp_path):
    IR50P.save(tmp_path / "arm.toml")
    text = (tmp_path / "arm.toml").read_text(encoding="utf-8")
    (tmp_path / "arm.toml").write_bytes(text.replace("\n", "\r\n").encode("utf-8-sig"))
    assert Arm.load(tmp_path / "arm.toml") == IR50P


def test_full_rigid_bodies_are_taken_or_refused():
    com = np.array([[0, 0, 0.1], [0.1, 0, 0], [0.1, 0, 0]])
    inertia = np.array([np.diag([0.01, 0.01, 0.01])] * 3)
    arm = Arm.from_rigid_bodies(l=GOOD["l"], m=GOOD["m"], com=com, inertia=inertia, name="bodies")
    assert arm == Arm(**GOOD, name="bodies", Ixx=(0.01,) * 3, Iyy=(0.01,) * 3, Izz=(0.01,) * 3)
    beside = com + np.array([[0, 0, 0], [0, 0.02, 0], [0, 0, 0]])
    with pytest.raises(ArmError, match=r"link 2 is 0.02 m off the link axis.*derive\(general=True\)"):
        Arm.from_rigid_bodies(l=GOOD["l"], m=GOOD["m"], com=beside, inertia=inertia)
    skewed = inertia.copy()
    skewed[2, 0, 1] = skewed[2, 1, 0] = 0.002
    with pytest.raises(ArmError, match=r"link 3 .* products of inertia reach 0\.002"):
        Arm.from_rigid_bodies(l=GOOD["l"], m=GOOD["m"], com=com, inertia=skewed)
    with pytest.raises(ArmError, match=r"\(3, 3, 3\)"):
        Arm.from_rigid_bodies(l=GOOD["l"], m=GOOD["m"], com=com, inertia=inertia[0])
