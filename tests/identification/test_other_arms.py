"""`identify` on recordings of other people's arms: good ones are taken, bad ones refused or flagged at three magnitudes."""

from types import SimpleNamespace

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.controllers import PID
from ir50p_lab.errors import IdentificationError, SuspiciousAngleWarning
from ir50p_lab.identification import identify
from ir50p_lab.modelling import Arm
from ir50p_lab.modelling.friction import Friction
from ir50p_lab.signals import at_rest, fourier
from ir50p_lab.simulation import simulate


def arm(name, l, m, Izz, fv, fc):
    """An honest arm of the shape: slender links, u in N m."""
    across = tuple(x * y**2 / 12 for x, y in zip(m, l, strict=True))
    return Arm(
        name=name,
        l=l,
        m=m,
        lc=tuple(x / 2 for x in l),
        Ixx=(Izz, 0.001 * m[1] * l[1] ** 2, 0.001 * m[2] * l[2] ** 2),
        Iyy=(Izz, *across[1:]),
        Izz=(Izz, *across[1:]),
        friction=Friction(fv=fv, fc=fc, fs=fc, qs=(0.05,) * 3, Tf=(0.0,) * 3),
    )


# arm; period s; period of the motion s; cut-off Hz; noise of q rad; PD gains
ARMS = {
    "small and fast, 500 Hz": (
        arm("small", (0.1, 0.15, 0.12), (0.5, 0.3, 0.2), 0.002, (0.02, 0.03, 0.01), (0.01, 0.02, 0.01)),
        0.002, 2.0, 8.0, 5e-5, ((15, 15, 6), (0.8, 0.8, 0.3)),
    ),
    "big and slow, 1 kHz": (
        arm("big", (0.8, 1.0, 1.2), (200.0, 80.0, 40.0), 30.0, (200.0, 300.0, 80.0), (40.0, 60.0, 20.0)),
        0.001, 10.0, 2.0, 1e-5, ((9000, 20000, 6000), (2500, 5000, 1000)),
    ),
    "direct drive, 250 Hz": (
        arm("direct", (0.3, 0.35, 0.3), (5.0, 4.0, 2.0), 0.1, (0.1, 0.1, 0.05), (0.05, 0.05, 0.03)),
        0.004, 4.0, 4.0, 2e-5, ((200, 250, 80), (25, 30, 8)),
    ),
}  # fmt: skip
arms = pytest.mark.parametrize("case", ARMS.values(), ids=ARMS)


def recording(case, seed=0):
    body, period, length, _, noise, (kp, kd) = case
    rng = np.random.default_rng(seed)
    motion = fourier(*at_rest(*rng.normal(0, 0.25, (2, 3, 4))), period=length, q0=(0, 0.7, -1), periods=8)
    run = simulate(
        body,
        PID(kp=kp, kd=kd, period=period, filter_hz=0.2 / period),
        motion,
        duration=8 * length,
        period=period,
        step=period / 2,
        q0=motion.q_start,
    )
    q = run.q + rng.normal(0, noise, run.q.shape)
    return SimpleNamespace(t=run.t, q=q, u=run.u)


@arms
def test_good_recordings_are_taken_and_explained(case):
    record, other = recording(case), recording(case, 1)
    found = identify(record, l2=case[0].l[1], delay=0.0, cutoff_hz=case[3], unit="N m")
    assert (found.score(other).fit > 80).all()
    assert found.unit == "N m" and not any("degrees" in text or "clipped" in text for text in found.warnings)
    theta = case[0].theta
    for joint, column in ((1, 2), (1, 3), (2, 3)):  # gravity is surest
        assert found.theta[joint, column] == pytest.approx(theta[joint, column], rel=0.1)
    assert found.theta[0, 10] == pytest.approx(theta[0, 10], rel=0.25)


@pytest.fixture(scope="module")
def good():
    return recording(ARMS["direct drive, 250 Hz"])


def spoilt(record, **changes):
    return SimpleNamespace(**{**vars(record), **changes})


def test_a_constant_joint_is_refused(good):
    q = good.q.copy()
    q[:, 1] = 2.0
    refused("joint 2: q is constant", identify, spoilt(good, q=q), error=IdentificationError)


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_a_clipped_angle_is_refused(good, share):
    q = good.q.copy()
    top = q[:, 2].min() + share * np.ptp(q[:, 2])
    q[:, 2] = np.minimum(q[:, 2], top)
    refused("joint 3: q was clipped", identify, spoilt(good, q=q), error=IdentificationError)


@pytest.mark.parametrize("level", [40, 80])
def test_a_clipped_drive_is_flagged(good, level):
    limit = np.percentile(np.abs(good.u), level, axis=0)
    found = identify(spoilt(good, u=np.clip(good.u, -limit, limit)), cutoff_hz=4.0, delay=0.0, unit="N m")
    assert all(f"joint {joint}: u is at its largest" in " ".join(found.warnings) for joint in (1, 2, 3))


def test_degrees_are_flagged(good):
    with pytest.warns(SuspiciousAngleWarning):
        found = identify(spoilt(good, q=np.degrees(good.q)), cutoff_hz=4.0, delay=0.0)
    assert any("degrees" in text for text in found.warnings)


@pytest.mark.parametrize("seconds", [0.2, 1.0, 5.0])
def test_a_frozen_sensor_is_refused_a_slow_one_and_outliers_are_flagged(good, seconds):
    q = good.q.copy()
    hung = (good.t > 9) & (good.t < 9 + seconds)
    q[hung, 1] = q[hung, 1][0]
    refused("joint 2: q stands", identify, spoilt(good, q=q), unit="N m", error=IdentificationError)
    rows = round(4 * seconds) + 2
    slow = identify(spoilt(good, q=np.repeat(good.q[::rows], rows, axis=0)[: len(q)]), unit="N m")
    assert "joint 1: q is new only" in " ".join(slow.warnings)
    q = good.q.copy()
    q[777, 2] += seconds
    assert "joint 3: q has 1 outlier(s)" in " ".join(identify(spoilt(good, q=q), unit="N m").warnings)
