"""One joint of any machine: found again within its errors, bad data refused, good data never."""

from types import SimpleNamespace

import numpy as np
import pytest
import refusals

from ir50p_lab.errors import IdentificationError, InputError
from ir50p_lab.identification import fit_joint
from ir50p_lab.jit import jit

NAMES = ("inertia", "viscous", "coulomb", "offset")
# inertia, viscous, Coulomb, offset; period s, length s, size of u, noise of q rad
MACHINES = {
    "industrial arm, 1 kHz, encoder": ((2.0, 10.0, 8.0, 1.5), 0.001, 10.0, 60.0, 1e-5),
    "hobby servo, 50 Hz, 2 mrad": ((0.002, 0.02, 0.03, 0.002), 0.02, 20.0, 0.12, 2e-3),
    "this arm, 100 Hz, 6 mrad": ((0.15, 1.6, 0.28, 0.06), 0.01, 60.0, 3.0, 5.6e-3),
}
INDUSTRIAL, SERVO, ARM = MACHINES.values()
machines = pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)


@jit()
def moved(J, b, c, o, u, h, steps, q):
    """q under a held u with dry friction that can hold the joint: semi-implicit steps of h."""
    x, v = 0.0, 0.0
    for k in range(len(u)):
        q[k] = x
        for _ in range(steps):
            free = v + h / J * (u[k] - o - b * v)
            v = 0.0 if abs(free) <= h * c / J else free - np.sign(free) * h * c / J
            x += h * v


def angle(machine, u, seed=0):
    (J, b, c, o), period, _, _, noise = machine
    q = np.empty(len(u))
    moved(J, b, c, o, u, period / 100, 100, q)
    return q + np.random.default_rng(seed).normal(0, noise, len(u))


def recorded(machine, seed=0, *, scale=1.0, change=lambda u: u):
    """t, q, u of three sinusoids of random frequency and phase."""
    _, period, seconds, size, _ = machine
    t = np.arange(round(seconds / period)) * period
    rng = np.random.default_rng(seed)
    u = change(
        scale
        * size
        / 2
        * sum(np.sin(2 * np.pi * f * t + p) for f, p in zip((0.3, 0.7, 1.3), rng.uniform(0, 6, 3), strict=True))
    )
    return t, angle(machine, u, seed), u


def check(found, machine, tolerance):
    for name, true in zip(NAMES, machine[0], strict=True):
        assert abs(getattr(found, name) - true) <= tolerance * abs(true) + 3 * getattr(found, f"{name}_stderr"), name


def moves(rng, rate, seconds, size, speed, rest=0.3):
    """Quintic moves with rests between: t, q, v, a."""
    n, x0, first = round(rate * seconds), 0.0, 0
    out = np.zeros((3, n + 100 * rate))
    while first < n:
        x1 = rng.uniform(-size, size)
        T = max(1.9 * abs(x1 - x0) / speed * rng.uniform(1, 1.6), 0.3)
        s = np.arange(round(T * rate)) / rate / T
        end, stay = first + len(s), round(rest * rng.uniform() * rate)
        out[0, first:end] = x0 + (x1 - x0) * (10 * s**3 - 15 * s**4 + 6 * s**5)
        out[1, first:end] = (x1 - x0) / T * (30 * s**2 - 60 * s**3 + 30 * s**4)
        out[2, first:end] = (x1 - x0) / T**2 * (60 * s - 180 * s**2 + 120 * s**3)
        out[0, end : end + stay] = x0 = x1
        first = end + stay
    return np.arange(n) / rate, *out[:, :n]


def sines(rng, rate, seconds, size, lowest=0.1):
    """Five harmonics: t, q, v, a."""
    t = np.arange(round(rate * seconds)) / rate
    w = 2 * np.pi * lowest * np.arange(1, 6)
    x, A = w * t[:, None] + rng.uniform(0, 6, 5), size * rng.uniform(0.5, 1, 5) / np.arange(1, 6)
    return t, np.sin(x) @ A, np.cos(x) @ (A * w), -np.sin(x) @ (A * w**2)


def dry(v, c, rng):
    """Coulomb friction; anything below it where the joint stands."""
    return np.where(np.abs(v) > 1e-9, c * np.sign(v), rng.uniform(-c, c))


def fast_arm(seed, gravity=0.0):
    """Nine seconds at 2 kHz, rests at the ends of the moves, ripple and noise in the torque."""
    rng = np.random.default_rng(seed)
    t, q, v, a = moves(rng, 2000, 9, rng.uniform(1, 2), rng.uniform(3, 6), 0.2)
    J = 10 ** rng.uniform(-1.5, 0.3)
    b = J * np.std(a) / np.std(v) * rng.uniform(0.3, 1.0)
    c = b * np.std(v) * rng.uniform(0.5, 1.5)
    u = J * a + b * v + dry(v, c, rng) + gravity * c * np.sin(q + 0.3) + 0.1 * c
    u += np.std(u) * (0.08 * np.sin(40 * q) * np.sign(v) + rng.normal(0, 0.05, len(t)))
    return (t, q + rng.normal(0, 1e-7, len(t)), u), (J, b, c)


def motor(seed):
    """Whole PWM counts, an encoder of 1440 counts, 100 to 1000 Hz."""
    rng = np.random.default_rng(seed)
    t, q, v, a = sines(rng, (100, 200, 1000)[seed % 3], 20, 1.0, 0.3)
    J, b, c = rng.uniform((0.5, 3, 5), (3, 12, 25))
    return (t, np.round(q * 229.18) / 229.18, np.round(J * a + b * v + c * np.sign(v) + 3)), (J, b, c)


# --- good data


@pytest.mark.parametrize("seed", range(3))
@machines
def test_parameters_are_found_again(machine, seed):
    found = fit_joint(*recorded(machine, seed))
    check(found, machine, 0.03)
    assert found.fit > 94 and found.warnings == ()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("machine", [fast_arm, motor])
def test_within_three_standard_errors_and_near(machine, seed):
    record, truth = machine(seed)
    found = fit_joint(*record)
    for name, true, near in zip(NAMES[:3], truth, (0.1, 0.15, 0.2), strict=True):
        x, stderr = getattr(found, name), getattr(found, f"{name}_stderr")
        assert abs(x - true) < near * true, name
        if not found.warnings:
            assert abs(x - true) < 3 * stderr + 0.02 * true, name
    assert "outlier" not in " ".join(found.warnings)


@machines
@pytest.mark.parametrize("limit", [0.3, 0.6, 0.9])
def test_a_drive_that_really_saturates_is_not_refused(machine, limit):
    top = limit * 1.4 * machine[3]
    check(fit_joint(*recorded(machine, change=lambda u: np.clip(u, -top, top))), machine, 0.15 if limit < 0.5 else 0.05)


@machines
def test_switched_inputs_gaps_dropouts_and_coarse_angles_are_not_refused(machine):
    check(fit_joint(*recorded(machine, change=lambda u: np.sign(u) * 0.7 * machine[3])), machine, 0.15)
    t, q, u = recorded(machine)
    for kept in (t % 7 < 5, np.random.default_rng(0).uniform(size=len(t)) < 0.9):
        check(fit_joint(t[kept], q[kept], u[kept]), machine, 0.06)
    check(fit_joint(t, np.round(q / 0.005) * 0.005, u), machine, 0.06)
    check(fit_joint(SimpleNamespace(t=t + 1.7e9, q=q[:, None], u=u[:, None])), machine, 0.03)
    check(fit_joint(t, q, u, cutoff_hz=4.0, held=True), machine, 0.05)


def sweep(speeds, seconds=8.0, seed=0):
    """Steady speeds one after the other, at 1 kHz with an encoder: friction is all there is to see."""
    v = np.repeat(speeds, int(1000 * seconds))
    v = np.convolve(v, np.ones(100) / 100, "same")
    a = np.gradient(v, 0.001)
    u = 0.5 * a + 4 * v + 3 * np.sign(v) + 0.2
    return (
        np.arange(len(v)) * 0.001,
        np.round(v.cumsum() * 0.001, 5),
        u + np.random.default_rng(seed).normal(0, 0.1, len(v)),
    )


def test_friction_sweep_at_crawling_speed():
    found = fit_joint(*sweep([0.002, -0.002, 0.005, -0.005, 0.01, -0.01, 0.03, -0.03, 0.1, -0.1]))
    assert found.viscous == pytest.approx(4, rel=0.05) and found.coulomb == pytest.approx(3, rel=0.01)
    assert found.offset == pytest.approx(0.2, abs=0.02)
    only_slow = fit_joint(*sweep([0.002, -0.002, 0.005, -0.005, 0.01, -0.01]))
    assert only_slow.coulomb == pytest.approx(3, rel=0.05)


@pytest.mark.parametrize("bend", [-0.1, 0.2, 0.6])
@pytest.mark.parametrize("seed", range(3))
def test_what_friction_that_bends_changes_is_in_the_errors(seed, bend):
    """`bend` of the viscous friction at the highest speed goes with its square: slope and Coulomb friction at rest.

    Where the slope changes much a warning says so; where friction is a line no error is wider for it.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(0, 20, 0.004)
    w = rng.uniform(0.8, 6.0, 3)
    x = w * t[:, None] + rng.uniform(0, 6, 3)
    q, v, a = np.sin(x).sum(axis=1), np.cos(x) @ w, -np.sin(x) @ w**2
    J, b, c = rng.uniform(0.1, 3.0, 3)
    straight = J * a + b * v + c * np.sign(v) + 0.01 * c * rng.normal(size=len(t))
    bent = straight + bend * b * v * np.abs(v) / np.abs(v).max()
    plain, found = (fit_joint(t, q, u, held=False) for u in (straight, bent))
    for name, true in zip(NAMES, (J, b, c), strict=False):
        assert abs(getattr(found, name) - true) <= 3 * getattr(found, f"{name}_stderr"), name
        assert getattr(plain, f"{name}_stderr") < 0.05 * true, name
    assert plain.warnings == () and any("depends on the speed" in one for one in found.warnings) == (bend > 0.3)


@pytest.mark.parametrize("seed", range(4))
def test_gravity_is_named_and_then_found(seed):
    record, truth = fast_arm(seed, gravity=2.0)
    assert "gravity" in " ".join(fit_joint(*record).warnings)
    found = fit_joint(*record, terms=("inertia", "viscous", "coulomb", "offset", "gravity"))
    expected = 2 * truth[2] * np.array([np.cos(0.3), np.sin(0.3)])
    for name, true in zip((*NAMES[:3], "gravity_sin", "gravity_cos"), (*truth, *expected), strict=True):
        assert abs(getattr(found, name) - true) < 3 * getattr(found, f"{name}_stderr") + 0.05 * abs(true), name


def braked_by_friction(rng, rate=1000):
    """A drive of three levels under dry friction that stops the joint soon where the drive ends: t, q, u, true values.

    With tau = J/b the speed tends to (U - c)/b under the drive U, and to -c/b without it, until it is 0.
    """
    b, U = 5.0, 10.0
    tau, c = rng.uniform(0.06, 0.2), U * rng.uniform(0.5, 0.75)
    t = np.arange(20 * rate) / rate
    whole, part = np.divmod(t, rng.uniform(1.0, 2.0))
    half, driven = part.max(), 0.5 * part.max()
    s = np.minimum(part, driven)
    q = (U - c) / b * (s - tau * (1 - np.exp(-s / tau)))
    v = (U - c) / b * (1 - np.exp(-driven / tau))
    s = np.clip(part - driven, 0, min(tau * np.log(1 + v * b / c), half - driven))
    q += (v + c / b) * tau * (1 - np.exp(-s / tau)) - c / b * s
    there = whole % 2 == 0
    q = np.where(there, q, q.max() - q)
    u = np.where(part < driven, np.where(there, U, -U), 0.0)
    return t, q, u, (b * tau, b, c)


@pytest.mark.parametrize("counts", [4096, 20000])
@pytest.mark.parametrize("seed", range(4))
def test_a_joint_that_friction_stops_at_its_turning_points_was_not_clipped(counts, seed):
    """It brakes within an eighth of its rest: a quarter of these were refused."""
    t, q, u, truth = braked_by_friction(np.random.default_rng([seed, counts]))
    count = 2 * np.pi / counts
    found = fit_joint(t, np.round(q / count) * count, u)
    for name, true in zip(NAMES[:3], truth, strict=True):
        off = abs(getattr(found, name) - true)
        assert off < 3 * getattr(found, f"{name}_stderr") + 0.02 * true or found.warnings, name


def fast_sweep(rate=20.0, f=3.0):
    """Motion with less than eight samples a period; its rates; friction alone."""
    t = np.arange(1200) / rate
    w = 2 * np.pi * f * np.array([1.0, 0.37])
    q, qd = np.sin(np.outer(t, w)) @ (0.8, 0.3), np.cos(np.outer(t, w)) @ (0.8 * w[0], 0.3 * w[1])
    return t, q, 1.2 * qd + 0.6 * np.sign(qd) + 0.01 * np.random.default_rng(0).normal(size=len(t)), qd


def test_a_measured_speed_is_believed_at_few_samples_a_period_and_in_several_recordings():
    t, q, u, qd = fast_sweep()
    terms = ("viscous", "coulomb")
    one = fit_joint(t, q, u, qd=qd, terms=terms)
    two = fit_joint([(t, q, u, qd), (t, q, u, qd)], terms=terms)
    for found in (one, two):
        assert found.viscous == pytest.approx(1.2, abs=0.01) and not found.warnings
    assert any("times qd" in text for text in fit_joint(t, q, u, qd=2 * qd, terms=terms).warnings)
    with pytest.raises(InputError, match=r"\(t, q, u, qd\)"):
        fit_joint([(t, q, u)], qd=qd)
    with pytest.raises(InputError, match="qd is in some of the recordings only"):
        fit_joint([(t, q, u), (t, q, u, qd)])


def test_a_wheel_of_which_only_the_speed_was_measured():
    rng = np.random.default_rng(1)
    t, _, v, a = sines(rng, 100, 20, 6.0)
    u = 0.02 * a + 0.01 * v + 0.05 * np.sign(v) + rng.normal(0, 0.002, len(t))
    for found in (fit_joint(t, u=u, qd=v), fit_joint([(t, None, u, v)])):
        assert (found.inertia, found.viscous, found.coulomb) == pytest.approx((0.02, 0.01, 0.05), rel=0.02)
        assert found.warnings == ()
    lost = np.where(np.arange(len(t)) == 700, 300.0, v)
    assert "qd has 1 outlier" in " ".join(fit_joint(t, u=u, qd=lost).warnings)


def at_uneven_times(seed):
    """A joint that stands for 4 s and then moves slowly; each u is held until the next sample. t, q, u, true values."""
    rng = np.random.default_rng([seed, 5])
    short_or_long = np.where(rng.uniform(size=3000) < 0.7, rng.integers(15, 30, 3000), rng.integers(100, 270, 3000))
    sampled = np.cumsum(short_or_long)  # ms
    sampled = sampled[sampled < 40_000]
    t, phase = 0.001 * sampled, rng.uniform(0, 6, 3)
    u = np.where(
        t < 4, 0.0, 2.5 * sum(np.sin(2 * np.pi * f * t + p) for f, p in zip((0.07, 0.16, 0.3), phase, strict=True))
    )
    held = np.repeat(np.r_[0.0, u], np.diff(np.r_[0, sampled, 40_000]))
    truth = tuple(rng.uniform((0.3, 2, 0.3), (1, 5, 0.8)))
    q = angle(((*truth, 0.1), 0.001, 40.0, 2.5, 0.0), held)[sampled]
    return t, q + rng.normal(0, 5e-4, len(t)), u, truth


@pytest.mark.parametrize("seed", range(3))
def test_a_slow_uneven_loop_is_taken_as_it_is(seed):
    *record, truth = at_uneven_times(seed)
    found = fit_joint(*record)
    for name, true in zip(NAMES[:3], truth, strict=True):
        x, stderr = getattr(found, name), getattr(found, f"{name}_stderr")
        assert abs(x - true) < 3 * stderr + 0.01 * true, name
    assert found.viscous == pytest.approx(truth[1], rel=0.03)
    assert not any("outlier" in one or "milliseconds" in one for one in found.warnings)


# --- several recordings


@pytest.mark.parametrize("kind", ["battery", "load", "grease", "tilt"])
@machines
def test_a_recording_that_contradicts_is_named_and_the_error_reaches_to_each(machine, kind):
    """Each alone is without a warning; one of three was driven by a fresher battery, carries a load, is cold, is tilted."""
    J, b, c, o = machine[0]
    other = {"load": (2.5 * J, b, c, o), "grease": (J, 1.3 * b, c, o), "tilt": (J, b, c, o + 0.1 * machine[3])}.get(
        kind
    )
    scale = 1 / 1.15 if kind == "battery" else 1.0
    t, q, u = recorded((other or machine[0], *machine[1:]), 2)
    odd = t, q, scale * u
    healthy = fit_joint([recorded(machine, seed) for seed in (0, 1, 2)])
    found = fit_joint([recorded(machine, 0), odd, recorded(machine, 1)])
    said = " ".join(found.warnings)
    assert healthy.warnings == () and "recording 2 contradicts" in said and "recording 1 contradicts" not in said
    values = other or [scale * x for x in machine[0]]
    for name, x in zip(NAMES, values, strict=True):
        assert abs(getattr(found, name) - x) <= 3 * getattr(found, f"{name}_stderr") + 0.01 * abs(x), name


def test_recordings_are_pooled_and_one_that_contradicts_is_named():
    """One that contradicts is a test of its own; here u of one has the wrong sign, or its q was clipped."""
    first, second, third = (recorded(ARM, seed) for seed in range(3))
    together = fit_joint([first, SimpleNamespace(t=second[0], q=second[1], u=second[2]), third])
    check(together, ARM, 0.01)
    assert together.warnings == ()
    assert together.samples > 2.5 * fit_joint(*first).samples
    heavy = recorded(((0.225, *ARM[0][1:]), *ARM[1:]), 7)  # of two, none is the odd one
    assert "contradicts the others: inertia" in " ".join(fit_joint([first, heavy]).warnings)
    t, q, u = second
    with pytest.raises(IdentificationError, match=r"recording 2 alone would be refused: .*sign of u"):
        fit_joint([first, (t, q, -u), third])
    with pytest.raises(IdentificationError, match=r"^recording 2: q was clipped"):
        fit_joint([first, (t, np.clip(q, 0.5 * q.min(), 0.5 * q.max()), u)])


# --- what the data do not hold is said


def test_one_direction_or_one_speed():
    found = fit_joint(*sweep([0.02, 0.05, 0.1, 0.03]))
    assert found.coulomb == 0 and found.coulomb_stderr == np.inf
    assert found.offset == pytest.approx(3.2, rel=0.02) and "Coulomb friction cannot be told" in " ".join(
        found.warnings
    )
    for speed in (0.01, 0.1, 1.0):
        steady = [x[1000:-1000] for x in sweep([speed, speed])]
        with pytest.raises(IdentificationError, match=r"not exciting|does not belong"):
            fit_joint(*steady)


@pytest.mark.parametrize("size", [0.3, 1.0, 10.0])
def test_friction_that_is_all_negative(size):
    """u recorded with the wrong sign: the joint would speed up by itself. The right sign is taken."""
    t, q, u = sweep([0.02, -0.02, 0.1, -0.1, 0.05, -0.05])
    assert fit_joint(t, q, size * u).viscous > 0
    with pytest.raises(IdentificationError, match=r"friction come out negative.*sign"):
        fit_joint(t, q, -size * u)


@pytest.mark.parametrize("samples", [2, 4, 8])
def test_a_delay_is_flagged_and_taken(samples):
    machine = MACHINES["this arm, 100 Hz, 6 mrad"]
    machine = (*machine[:4], 1e-4)
    t, q, u = recorded(machine)
    late = t[:-samples], q[:-samples], u[samples:]
    assert "u seems to act" in " ".join(fit_joint(*late).warnings)
    check(fit_joint(*late, delay=samples * 0.01), machine, 0.03)
    early = t[:-samples], q[samples:], u[:-samples]
    assert "s earlier than" in " ".join(fit_joint(*early).warnings) or samples == 8  # there the inertia is all gone
    assert fit_joint(*early).warnings


@pytest.mark.parametrize("scale", [0.3, 1.0, 3.0])
@machines
def test_degrees_are_flagged(machine, scale):
    t, q, u = recorded(machine)
    q = scale / 2 * q
    assert "degrees" in " ".join(fit_joint(t, np.degrees(q), u).warnings)
    assert "degrees" not in " ".join(fit_joint(t, q, u).warnings)


@pytest.mark.parametrize("count, size", [(1, 0.3), (5, 1.0), (50, 10.0)])
@machines
def test_outliers_are_flagged(machine, count, size):
    for signal in (1, 2):
        record = [x.copy() for x in recorded(machine)]
        places = np.random.default_rng(0).choice(np.arange(2, len(record[0]) - 2, 3), count, replace=False)
        record[signal][places] += size * np.ptp(record[signal])
        try:
            assert "outlier(s)" in " ".join(fit_joint(*record).warnings)
        except IdentificationError:  # the worst are refused, for what they do to the fit
            assert count > 1 or size > 1


@pytest.mark.parametrize("rows", [2, 5, 20])
def test_a_sensor_slower_than_the_file(rows):
    t, q, u = analytic(200)
    held = np.repeat(q[::rows], rows)[: len(t)]
    found = fit_joint(t, held, u)
    assert f"in every {rows}" in " ".join(found.warnings)
    assert found.coulomb == pytest.approx(0.4, abs=0.1)


def analytic(rate, seconds=20.0, w=(1.3, 3.1, 5.9), size=0.4, seed=0):
    """t, q, u that were measured at one instant; inertia 0.7, viscous 1.1, Coulomb 0.4, offset -0.2, noise of u 0.01."""
    t, w = np.arange(round(seconds * rate)) / rate, np.array(w)
    x = w * t[:, None] + w
    q, v, a = size * np.sin(x).sum(axis=1), size * np.cos(x) @ w, -size * np.sin(x) @ w**2
    noise = 0.01 * np.random.default_rng(seed).normal(size=len(t))
    return t, q, 0.7 * a + 1.1 * v + 0.4 * np.sign(v) - 0.2 + noise


# --- refusals


def refused(words, *record, error=IdentificationError, **options):
    refusals.refused([words], fit_joint, *record, error=error, **options)


@machines
def test_too_short(machine):
    t, q, u = recorded(machine)
    for n in (2, 10, 39):
        refused("too short", t[:n], q[:n], u[:n])
    pieces = (np.arange(len(t)) % 100) < 15
    with pytest.raises(IdentificationError):
        fit_joint(t[pieces], q[pieces], u[pieces])


@pytest.mark.parametrize("scale", [1e-3, 0.02, 0.08])
@machines
def test_not_exciting(machine, scale):
    with pytest.raises(IdentificationError, match=r"not exciting|in motion|does not belong"):
        fit_joint(*recorded(machine, scale=scale))


@machines
def test_constant(machine):
    t, q, u = recorded(machine)
    refused("q is constant", t, np.full_like(q, 300.0), u)
    refused("u is constant", t, q, np.zeros_like(u))
    refused("only 2 values", t, np.sign(q), u)


@pytest.mark.parametrize("count", [1, 20, 400])
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_not_finite(count, bad):
    for column in range(3):
        record = [x.copy() for x in recorded(MACHINES["hobby servo, 50 Hz, 2 mrad"])]
        record[column][7 : 7 + count] = bad
        refused(f"{'tqu'[column]} holds {bad}", *record, error=InputError)


@pytest.mark.parametrize("share", [0.4, 0.7, 0.9])
@machines
def test_clipped(machine, share):
    for seed in range(2):
        t, q, u = recorded(machine, seed)
        top = share * np.abs(u).max()
        refused("u was clipped", t, q, np.clip(u, -top, top))
        middle, half = (q.max() + q.min()) / 2, share * np.ptp(q) / 2
        refused("q was clipped", t, np.clip(q, middle - half, middle + half), u)


@pytest.mark.parametrize("seconds", [0.2, 1.0, 5.0])
def test_a_frozen_sensor(seconds):
    t, q, u = analytic(100)
    begin = t[500 + np.argmax(np.abs(np.diff(q[500:1400])))] - 0.1
    hung = (t > begin) & (t < begin + seconds)
    refused("hung", t, np.where(hung, q[hung][0], q), u)
    assert fit_joint(t[~hung], q[~hung], u[~hung]).inertia == pytest.approx(0.7, rel=0.03)


@pytest.mark.parametrize("turns", [1, 5, 40])
def test_wrapped_angles(turns):
    t = np.arange(0, 20, 0.01)
    q = 2 * np.pi * turns / 10 * t
    for full in (2 * np.pi, 360.0):
        refused("a whole turn was wrapped", t, (q / (2 * np.pi) * full) % full, np.sin(t))


TURNED = {  # what a register or an encoder makes of a signed number, and what is said
    "sixteen bits without sign": (lambda u: u % 65536, "use np.unwrap(u, period=65536)"),
    "eleven bits without sign": (lambda u: u % 2048, "use np.unwrap(u, period=2048)"),
    "of hundredths": (lambda u: u % 65536 / 100, "use np.unwrap(u, period=655.36)"),
    "sign in bit 10": (lambda u: np.where(u < 0, 1024 - u, u), "use np.where(u < 1024, u, 1024 - u)"),
    "sign in bit 15": (lambda u: np.where(u < 0, 32768 - u, u), "use np.where(u < 32768, u, 32768 - u)"),
}


@pytest.mark.parametrize("size", [10, 60, 900])
@pytest.mark.parametrize("register, words", TURNED.values(), ids=TURNED)
def test_a_register_without_sign_is_named(register, words, size):
    t, q, u = recorded(ARM)
    refused(words, t, q, register(np.round(size * u / np.abs(u).max())))


@pytest.mark.parametrize("turn, said", [(2 * np.pi / 3, 2.0944), (2 * np.pi / 7, 0.897598), (1.234, 1.23), (120, 120)])
def test_an_encoder_that_wraps_before_its_gear_is_named(turn, said):
    t, q, u = recorded((*ARM[:4], 1e-4))
    size = 57.2958 if turn > 7 else 1.0
    for begin in (0.0, turn / 2):
        refused(f"use np.unwrap(q, period={said}", t, np.mod(size * q + begin, turn) - begin, u)


SWITCHED = {
    "square": lambda t, rng: np.sign(np.sin(2.5 * t)),
    "square with noise": lambda t, rng: np.sign(np.sin(2.5 * t)) + rng.normal(0, 0.07, len(t)),
    "three levels": lambda t, rng: np.repeat(rng.choice([-1.0, 0.0, 1.0], 200), 40)[: len(t)],
    "saw-tooth": lambda t, rng: 2 * ((0.4 * t) % 1) - 1,
    "friction compensated": lambda t, rng: 0.6 * np.sign(np.sin(2.5 * t)) + 0.8 * np.sin(2.5 * t),
    "answers to steps": lambda t, rng: np.where(t % 4 < 2, 1, -1) * 1.4 * np.exp(-(t % 2) / 0.3),
}


@pytest.mark.parametrize("drive", SWITCHED.values(), ids=SWITCHED)
def test_switched_drives_jump_by_one_size_and_are_taken(drive):
    t = np.arange(3000) * 0.01
    u = 1.5 * drive(t, np.random.default_rng(2))
    check(fit_joint(t, angle((*ARM[:4], 1e-4), u), u), ARM, 0.1)


@machines
def test_signs_and_strangers(machine):
    t, q, u = recorded(machine)
    for size in (1e-3, 1.0, 1e3):
        refused("sign", t, q, -size * u)
        refused("does not belong to this motion", t, q, size * np.random.default_rng(1).normal(size=len(u)))


def test_bad_arguments():
    t, q, u = recorded(MACHINES["hobby servo, 50 Hz, 2 mrad"])
    refused("2 columns", t, np.column_stack([q, q]), np.column_stack([u, u]), error=InputError)
    for option, value in (("held", 1), ("cutoff_hz", 25), ("cutoff_hz", -1), ("delay", -1), ("delay", np.nan)):
        refused(option, t, q, u, error=InputError, **{option: value})


def test_anyway_goes_on_with_the_reason():
    t, q, u = recorded(ARM)
    found = fit_joint(t, q, np.clip(u, -2.0, 2.0), anyway=True)
    assert "went on anyway: u was clipped" in " ".join(found.warnings) and found.viscous > 0


# -- readings that are held, that fail, that lack their sign, that were cut off under noise ----------------------------


@machines
@pytest.mark.parametrize("share", [0.25, 0.4, 0.6])
def test_held_at_any_rhythm(machine, share):
    """A logger that polls faster than the sensor answers: repeated rows bring nothing new."""
    t, q, u = recorded(machine, 3)
    new = np.random.default_rng(5).random(len(t)) < share
    new[0] = True
    last = np.maximum.accumulate(np.where(new, np.arange(len(t)), 0))
    check(fit_joint(t, q[last], u[last]), machine, 0.1)


@machines
@pytest.mark.parametrize("value, length", [(0.0, 3), (-9.0, 1), (4.5, 6)])
def test_failed_readings_are_named_and_left_out(machine, value, length):
    t, q, u = recorded(machine, 4)
    level = value - q.min() + 1.5 * np.ptp(q)
    for k in np.random.default_rng(6).choice(np.arange(50, len(t) - 50), 6, replace=False):
        q[k : k + length] = level
    found = fit_joint(t, q, u)
    check(found, machine, 0.1)
    assert any("failed readings" in text or "outlier" in text for text in found.warnings)


@machines
def test_readings_that_fail_to_two_values_and_within_the_range_of_the_motion(machine):
    t, q, u = recorded(machine, 4)
    q = q - np.quantile(q, 0.3)
    for k, value in zip(range(60, len(t) - 60, len(t) // 9), [0.0, 9.0 * np.ptp(q)] * 9, strict=False):
        q[k : k + 4] = value
    found = fit_joint(t, q, u)
    check(found, machine, 0.1)
    assert any("q leaps to 0, " in text for text in found.warnings)
    assert not any("degrees" in text for text in found.warnings)


@machines
def test_a_speed_without_its_sign_is_mended_as_a_speed(machine):
    t, q, u = recorded(machine, 5)
    refused("give np.abs(qd) * np.sign(u) as qd", t, None, u, qd=np.abs(np.gradient(q, t)))


@machines
def test_a_size_without_its_sign_is_told_how_to_get_it_back(machine):
    t, q, u = recorded(machine, 5)
    refused("u has one sign only", t, q, np.abs(u))
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(angle((*machine[:4], 0.0), u))))])
    refused("the joint moves one way only", t, way, u)


@machines
@pytest.mark.parametrize("share", [0.6, 0.75])
@pytest.mark.parametrize("noise", [0.005, 0.02])
def test_a_command_cut_off_under_noise(machine, share, noise):
    t, q, u = recorded(machine, 6)
    top = np.abs(u).max()
    scatter = np.random.default_rng(7).normal(0, noise * top, len(u))
    clipped = fit_joint(t, q, np.clip(u, -share * top, share * top) + scatter, anyway=True)
    assert "clipped" in " ".join(clipped.warnings)
    assert "clipped" not in " ".join(fit_joint(t, q, u + scatter).warnings)
