"""The equations of motion: against MuJoCo, against the corrected thesis' numbers, and by their own invariants."""

import mujoco
import numpy as np
import pandas as pd
import pytest
from arms import mujoco_model, random_arm, random_states
from hypothesis import given
from hypothesis import strategies as st

from ir50p_lab.errors import InputError
from ir50p_lab.modelling import (
    IR50P,
    THESIS_A,
    THESIS_C,
    THESIS_RODS,
    Arm,
    closed_form,
    coriolis_matrix,
    energy,
    forward_dynamics,
    gravity,
    inverse_dynamics,
    mass_matrix,
)

# Source: the thesis' models with its equations corrected, evaluated from the symbolic Lagrangian in 20 digits.
# State: q, qd; then per model M11, M12, M22, M23, M33 (M13 = 0), C qd, and g of joints 2 and 3 (g1 = 0).
STATES = {
    1: ((0.3, 0.5, -0.7), (0.4, -0.6, 0.8)),
    2: ((-1.1, 1.2, 0.9), (1.5, 0.7, -1.3)),
    3: ((2.0, -0.4, -1.6), (-0.9, 1.1, 2.2)),
    4: ((0.0, 2.3, -2.0), (0.5, -1.4, 0.3)),
    5: ((1.57, 0.9, 1.4), (-2.1, 0.2, -0.5)),
}
MODELS = {"A": THESIS_A, "B": THESIS_RODS, "C": THESIS_C}
# fmt: off
REFERENCE = {
    "A1": ((2.812910903623, 0, 2.264842187284, 0.632421093642, 0.25), (0.386946108779, -0.003074481791, -0.137695449772), (17.720853962528, 4.807226564311)),
    "A2": ((0.7949114243, 0, 2.121609968271, 0.560804984135, 0.25), (-0.307075309319, 0.578191754873, 0.298673840577), (2.855824214062, -2.476270143062)),
    "A3": ((1.470439621813, 0, 1.470800477699, 0.235400238849, 0.25), (-2.652797274224, 4.27783838223, -0.867310725868), (11.512212293489, -2.041200233264)),
    "A4": ((0.896553827571, 0, 1.083853163453, 0.041926581726, 0.25), (-0.401455623687, -0.414168005606, -0.898078654433), (-5.118326173972, 4.685925479161)),
    "A5": ((0.929815808503, 0, 1.6699671429, 0.33498357145, 0.25), (0.156544516099, 1.983044137348, 0.49403766303), (5.878906798725, -3.268083884378)),
    "B1": ((2.207134374451, 0, 2.431508853951, 0.715754426976, 0.333333333333), (0.406371650758, -0.000060797507, -0.140291572054), (17.720853962528, 4.807226564311)),
    "B2": ((0.077092485263, 0, 2.288276634937, 0.644138317469, 0.333333333333), (-0.431546520548, 0.559806199386, 0.216963611914), (2.855824214062, -2.476270143062)),
    "B3": ((0.8055672505, 0, 1.637467144365, 0.318733572183, 0.333333333333), (-2.524670534135, 4.279169698378, -0.841768641651), (11.512212293489, -2.041200233264)),
    "B4": ((0.259603122904, 0, 1.25051983012, 0.12525991506, 0.333333333333), (-0.433541485535, -0.418637261129, -0.892196962002), (-5.118326173972, 4.685925479161)),
    "B5": ((0.249009365935, 0, 1.836633809567, 0.418316904783, 0.333333333333), (0.242797960871, 1.979397917604, 0.311446941113), (5.878906798725, -3.268083884378)),
    "C1": ((1.535494326242, 0.05, 0.792968437457, 0.376484218728, 0.3), (0.091698036687, -0.004152882684, -0.033769783431), (10.833586016812, 4.807226564311)),
    "C2": ((0.965208328415, 0.05, 0.764321993654, 0.362160996827, 0.3), (-0.246668154481, -0.050070354694, -0.136369780678), (0.012040556929, -2.476270143062)),
    "C3": ((1.112657696463, 0.05, 0.63416009554, 0.29708004777, 0.3), (-0.109426073832, 0.905247509893, -0.112161143054), (4.283725612554, -2.041200233264)),
    "C4": ((1.129601276467, 0.05, 0.556770632691, 0.258385316345, 0.3), (-0.046003800766, -0.073685994305, -0.165499669052), (0.110608041033, 4.685925479161)),
    "C5": ((1.040203867113, 0.05, 0.67399342858, 0.31699671429, 0.3), (0.172874609876, 0.044284455911, -0.339410199996), (1.000511767737, -3.268083884378)),
}
# fmt: on
seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize("case", REFERENCE)
def test_reproduces_the_corrected_thesis_models(case):
    model, (q, qd) = MODELS[case[0]], STATES[int(case[1])]
    (M11, M12, M22, M23, M33), h, (g2, g3) = REFERENCE[case]
    np.testing.assert_allclose(
        mass_matrix(model, q), [[M11, M12, 0], [M12, M22, M23], [0, M23, M33]], atol=1e-12, rtol=0
    )
    np.testing.assert_allclose(coriolis_matrix(model, q, qd) @ qd, h, atol=1e-12, rtol=0)
    np.testing.assert_allclose(gravity(model, q), [0, g2, g3], atol=1e-12, rtol=0)


@pytest.mark.parametrize("seed", range(20))
def test_equals_mujoco_on_a_random_arm(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng)
    model = mujoco_model(arm)
    data = mujoco.MjData(model)
    q, qd, qdd = random_states(rng, 1000)
    tau = inverse_dynamics(arm, q, qd, qdd)
    found = forward_dynamics(arm, q, qd, tau)
    M_ours, K_ours = mass_matrix(arm, q), energy(arm, q, qd).kinetic
    torques, accelerations = np.empty((2, 1000, 3))
    for k in range(1000):
        data.qpos[:], data.qvel[:], data.qacc[:] = q[k], qd[k], qdd[k]
        mujoco.mj_inverse(model, data)
        torques[k] = data.qfrc_inverse
        data.qfrc_applied[:] = tau[k]
        mujoco.mj_forward(model, data)
        accelerations[k] = data.qacc
        data.qfrc_applied[:] = 0
        if k < 50:
            M = np.zeros((3, 3))
            mujoco.mj_fullM(model, data, M)
            np.testing.assert_allclose(M_ours[k], M, rtol=1e-12, atol=1e-12)
            mujoco.mj_energyVel(model, data)
            np.testing.assert_allclose(K_ours[k], data.energy[1], rtol=1e-12)
    np.testing.assert_allclose(tau, torques, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found, accelerations, rtol=1e-9, atol=1e-9)


@given(seeds)
def test_mass_matrix_is_symmetric_and_positive(seed):
    rng = np.random.default_rng(seed)
    M = mass_matrix(random_arm(rng), random_states(rng, 20)[0])
    assert (M == np.swapaxes(M, 1, 2)).all()
    assert (np.linalg.eigvalsh(M) > 0).all()


@given(seeds)
def test_mdot_minus_2c_is_skew_and_power_balances(seed):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng, viscous=False)
    q, qd, qdd = (x[0] for x in random_states(rng, 1))
    step = 1e-6
    M_dot = (mass_matrix(arm, q + step * qd) - mass_matrix(arm, q - step * qd)) / (2 * step)
    N = M_dot - 2 * coriolis_matrix(arm, q, qd)
    np.testing.assert_allclose(N + N.T, 0, atol=1e-6)
    ahead, behind = (energy(arm, q + s * qd, qd + s * qdd).total for s in (step, -step))
    power = qd @ inverse_dynamics(arm, q, qd, qdd)
    assert (ahead - behind) / (2 * step) == pytest.approx(power, rel=1e-6, abs=1e-5)


@given(seeds)
def test_gravity_is_the_slope_of_the_potential(seed):
    rng = np.random.default_rng(seed)
    arm, q, step = random_arm(rng), random_states(rng, 1)[0][0], 1e-6
    slope = [
        (energy(arm, q + d, np.zeros(3)).potential - energy(arm, q - d, np.zeros(3)).potential) / (2 * step)
        for d in step * np.eye(3)
    ]
    np.testing.assert_allclose(gravity(arm, q), slope, atol=1e-6)


@given(seeds, st.booleans())
def test_forward_undoes_inverse_also_with_a_row_of_its_own_per_joint(seed, in_pwm):
    rng = np.random.default_rng(seed)
    arm = random_arm(rng, coulomb=True)
    theta = arm.theta_pwm if in_pwm else arm.theta
    q, qd, qdd = random_states(rng, 30)
    tau = inverse_dynamics(theta, q, qd, qdd)
    np.testing.assert_allclose(forward_dynamics(theta, q, qd, tau), qdd, rtol=1e-8, atol=1e-8)
    M = mass_matrix(theta, q)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", M, qdd) + bias(theta, q, qd), tau, rtol=1e-9, atol=1e-9)


def test_a_theta_in_pwm_is_the_same_motion_seen_from_the_counts():
    rng = np.random.default_rng(7)
    q, qd, qdd = random_states(rng, 50)
    K, damping = IR50P.actuators.gain, IR50P.actuators.back_emf_damping
    in_newton_metres = inverse_dynamics(IR50P, q, qd, qdd) + damping * qd
    np.testing.assert_allclose(inverse_dynamics(IR50P.theta_pwm, q, qd, qdd), in_newton_metres / K, rtol=1e-12)
    assert not np.allclose(mass_matrix(IR50P.theta_pwm, q[0]), mass_matrix(IR50P.theta_pwm, q[0]).T)


def test_theta_with_products_of_inertia_solves_against_lapack():
    q, qd, tau = (x[:100] for x in random_states(np.random.default_rng(3), 100))
    expected = np.linalg.solve(mass_matrix(THESIS_C, q), (tau - bias(THESIS_C, q, qd))[:, :, None])[:, :, 0]
    np.testing.assert_allclose(forward_dynamics(THESIS_C, q, qd, tau), expected, rtol=1e-11, atol=1e-11)


def test_friction_in_theta_opposes_motion_and_is_silent_at_rest():
    still, moving = np.zeros(3), np.array([0.5, -0.5, 0.5])
    rigid = IR50P.without_friction()
    extra = bias(IR50P, still, moving) - bias(rigid, still, moving)
    f = IR50P.friction
    np.testing.assert_allclose(extra, np.sign(moving) * f.fc + f.Tf, rtol=1e-12)
    np.testing.assert_allclose(bias(IR50P, still, still) - bias(rigid, still, still), f.Tf, rtol=1e-12)


def test_moon_gravity_counts():
    moon = Arm(**{**vars_of(THESIS_RODS), "g": 1.62})
    np.testing.assert_allclose(gravity(moon, [0, 0.3, 0.2]) * 9.81, gravity(THESIS_RODS, [0, 0.3, 0.2]) * 1.62)


def test_a_theta_takes_the_gravity_it_is_given():
    moon = Arm(**{**vars_of(THESIS_RODS), "g": 1.62})
    q, qd, x = (a[:20] for a in random_states(np.random.default_rng(4), 20))
    for function, vectors in (
        (gravity, (q,)), (inverse_dynamics, (q, qd, x)), (forward_dynamics, (q, qd, x)),
    ):  # fmt: skip
        given = function(moon.theta, *vectors, g=1.62)
        np.testing.assert_allclose(given, function(moon, *vectors), rtol=1e-12, atol=1e-12)
        assert np.abs(given - function(moon.theta, *vectors)).max() > 1  # 9.81 unless told
        with pytest.raises(InputError, match=r"carries its own gravity \(1\.62 m/s"):
            function(moon, *vectors, g=1.62)
    np.testing.assert_allclose(energy(moon.theta, q, qd, g=1.62).total, energy(moon, q, qd).total, rtol=1e-12)
    with pytest.raises(InputError, match="carries its own"):
        energy(moon, q, qd, g=9.81)
    one = np.zeros(3)  # the short way for one state of an Arm
    with pytest.raises(InputError, match="carries its own"):
        forward_dynamics(moon, one, one, one, g=9.81)


def bias(arm, q, qd):
    """All torques but those of acceleration."""
    return inverse_dynamics(arm, q, qd, np.zeros(3))


def vars_of(arm):
    return {name: getattr(arm, name) for name in ("l", "m", "lc", "Ixx", "Iyy", "Izz")}


FUNCTIONS = {mass_matrix: 1, gravity: 1, coriolis_matrix: 2, inverse_dynamics: 3, forward_dynamics: 3}


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: f.__name__)
@pytest.mark.parametrize("model", [IR50P, IR50P.theta, IR50P.theta_pwm.tolist()], ids=["arm", "theta", "rows"])
def test_one_state_or_many_as_arrays_lists_or_tuples_of_any_numbers(function, model):
    rng = np.random.default_rng(11)
    states = [rng.integers(-3, 4, (5, 3)).astype(float) for _ in range(FUNCTIONS[function])]
    many = function(model, *states)
    assert type(many) is np.ndarray and len(many) == 5
    assert (function(model, *[x.reshape(5, 1, 3) for x in states])[:, 0] == many).all()
    for k in range(5):
        one = [x[k] for x in states]
        locked = [x.copy() for x in one]
        for x in locked:
            x.setflags(write=False)
        spread = [np.repeat(x, 2)[::2] for x in one]
        integers = [x.astype(int) for x in one]
        singles = [x.astype(np.float32) for x in one]
        series = [pd.Series(x, index=["a", "b", "c"]) for x in one]
        for same in (one, locked, spread, integers, singles, series, map(list, one), map(tuple, integers)):
            found = function(model, *same)
            assert type(found) is np.ndarray and (found == many[k]).all()


def test_energy_of_one_state_and_of_many():
    q, qd, _ = random_states(np.random.default_rng(11), 5)
    assert energy(IR50P, q[0], qd[0]).total == pytest.approx(energy(IR50P, q, qd).total[0], rel=1e-15)


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: mass_matrix(IR50P, [0, 0]), ["q", "(2,)", "(3,)"]),
        (lambda: gravity(IR50P, [0, np.nan, 0]), ["q", "nan", "index 1"]),
        (lambda: forward_dynamics(IR50P, np.array([0, np.nan, 0]), np.zeros(3), np.zeros(3)), ["q", "nan"]),
        (lambda: forward_dynamics(IR50P, np.array([np.inf, 0, 0]), np.zeros(3), np.zeros(3)), ["q", "inf"]),
        (lambda: forward_dynamics(IR50P, np.zeros(3), np.zeros(3), np.array([0, 0, np.inf])), ["tau", "inf"]),
        (lambda: inverse_dynamics(IR50P, np.zeros((4, 3)), np.zeros((5, 3)), np.zeros(3)), ["q (4, 3)", "qd (5, 3)"]),
        (
            lambda: inverse_dynamics(IR50P, np.full(3, 1e200), np.full(3, 1e200), np.zeros(3)),
            ["not finite", "too large"],
        ),
        (lambda: inverse_dynamics(IR50P, np.zeros((4, 3)), np.zeros(3), np.full(3, np.nan)), ["qdd", "nan"]),
        (lambda: mass_matrix(np.zeros((3, 19)), np.zeros(3)), ["(3, 19)", "(3, 20)"]),
        (lambda: mass_matrix(np.full((3, 20), np.nan), np.zeros(3)), ["theta", "not finite"]),
        (lambda: mass_matrix(3.0, np.zeros(3)), ["float", "(3, 20)"]),
        (lambda: mass_matrix(IR50P, ["a", "b", "c"]), ["q", "numbers"]),
        (lambda: gravity(THESIS_C, np.zeros(3), g=-9.81), ["g = -9.81", ">= 0"]),
        (lambda: gravity(THESIS_C, np.zeros(3), g=np.nan), ["g = nan"]),
        (lambda: energy(IR50P.theta_pwm, np.zeros(3), np.zeros(3)), ["equal rows"]),
        (lambda: forward_dynamics(np.zeros((3, 20)), np.zeros(3), np.zeros(3), np.ones(3)), ["singular"]),
    ],
)
def test_bad_input_gets_a_sentence(call, words):
    with pytest.raises(InputError) as caught:
        call()
    for word in words:
        assert word in str(caught.value)


def test_one_row_of_theta_counts_for_all_joints():
    q = np.array([0.1, 0.2, 0.3])
    assert (mass_matrix(IR50P.theta[0], q) == mass_matrix(IR50P, q)).all()


def test_our_sine_and_cosine_are_right_to_the_last_bits():
    x = np.concatenate([np.random.default_rng(0).uniform(-50, 50, 2000), np.arange(-40, 41) * np.pi / 4, [0.0, 1e6]])
    found = np.array([closed_form.sincos(value) for value in x])
    np.testing.assert_allclose(found, np.stack([np.sin(x), np.cos(x)], axis=1), rtol=0, atol=3e-16)
