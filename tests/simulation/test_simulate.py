"""Simulation: energy, other integrators, sticking, stops, table, drive, bad input."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from arms import mujoco_model
from control import step_info
from refusals import refused
from scipy.integrate import solve_ivp

from ir50p_lab.controllers import PID, ContinuousPID
from ir50p_lab.errors import ArmError, InputError
from ir50p_lab.modelling import (
    IR50P,
    THESIS_A,
    THESIS_C,
    THESIS_RODS,
    Friction,
    forward_dynamics,
    forward_kinematics,
    gravity,
)
from ir50p_lab.simulation import simulate

SET_POINT = (np.pi / 2, np.pi / 2, -np.pi / 3)
SMOOTH = IR50P.without_friction()
START = {"q0": (0.3, 0.5, -0.7), "qd0": (0.4, -0.6, 0.8)}


@pytest.mark.parametrize(
    "arm, bound", [(SMOOTH, 1e-9), (THESIS_A, 1e-5), (THESIS_RODS, 1e-5)], ids=["IR50P with rotors", "A", "rods"]
)
def test_free_motion_keeps_its_energy(arm, bound):
    run = simulate(arm, q0=START["q0"], qd0=START["qd0"], duration=10, step=0.001)
    drift = np.abs(run.energy.total - run.energy.total[0]).max() / run.energy.kinetic.max()
    assert run.energy.kinetic.max() > 1  # it does swing
    assert drift < bound


def test_equals_scipy_and_mujoco():
    run = simulate(SMOOTH, duration=2, **START)
    rate = lambda t, x: np.r_[x[3:], forward_dynamics(SMOOTH, x[:3], x[3:], np.zeros(3))]  # noqa: E731
    exact = solve_ivp(rate, (0, 2), np.r_[START["q0"], START["qd0"]], rtol=1e-12, atol=1e-12, t_eval=run.t)
    np.testing.assert_allclose(run.q, exact.y[:3].T, atol=1e-9)
    model = mujoco_model(SMOOTH)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = START["q0"], START["qd0"]
    mujoco.mj_step(model, data, 2000)
    np.testing.assert_allclose(run.q[-1], data.qpos, atol=1e-8)


def test_a_held_pd_command_equals_mujocos():
    """A command every 10 ms, ten Runge-Kutta steps between."""
    model = mujoco_model(SMOOTH)
    data, last = mujoco.MjData(model), np.zeros(3)
    for _ in range(100):
        velocity, last = (data.qpos - last) / 0.01, data.qpos.copy()
        data.qfrc_applied[:] = np.clip(50 * (SET_POINT - data.qpos) - 5 * velocity, -20, 20)
        mujoco.mj_step(model, data, 10)
    run = simulate(SMOOTH, PID(kp=50, kd=5, limit=20, filter_hz=np.inf), SET_POINT, duration=1)
    np.testing.assert_allclose(run.q[-1], data.qpos, atol=1e-6)


@pytest.mark.parametrize(
    "arm, rises, settles, errors",
    [
        (THESIS_A, (0.06, 0, 0), (0.90, 0.78, 0.83), (0, 0.02350, 0.02177)),
        (THESIS_RODS, (0, 0, 0), (1.30, 0.75, 0.84), (0, 0.02350, 0.02177)),
    ],
    ids=["A", "rods"],
)
def test_tables_2_1_to_2_3_in_continuous_time(arm, rises, settles, errors):
    """Source: the corrected equations with the gains of Tables 2.1-2.3, integrated by LSODA (tolerances as printed)."""
    run = simulate(arm, ContinuousPID(kp=(25, 200, 200), kd=(10, 40, 40)), SET_POINT)
    steps = [step_info(q, T=run.t, T_num=len(run.t)) for q in run.q.T]
    np.testing.assert_allclose([step["Overshoot"] for step in steps], rises, atol=0.005)
    np.testing.assert_allclose([step["SettlingTime"] for step in steps], settles, atol=0.011)
    np.testing.assert_allclose(SET_POINT - run.q[-1], errors, atol=5e-6)
    np.testing.assert_allclose(np.abs(run.u).max(axis=0), np.abs(SET_POINT) * (25, 200, 200), rtol=1e-12)
    np.testing.assert_allclose(run.error[-1], gravity(arm, run.q[-1]) / (25, 200, 200), atol=1e-8)


def test_the_continuous_pid_knows_the_velocity_of_its_reference():
    """Joint 1 alone, M11 constant: with e = 0 and the right velocity at the start, only D = 0 could lag behind."""
    upright = {"q0": (0, np.pi / 2, 0), "qd0": (0.5, 0, 0)}
    weightless = replace(THESIS_A, g=0.0)
    ramp = lambda t: (np.array([0.5 * t, np.pi / 2, 0]), np.array([0.5, 0, 0]), np.zeros(3))  # noqa: E731
    run = simulate(weightless, ContinuousPID(kp=25, kd=10), ramp, duration=0.5, **upright)
    assert np.abs(run.error).max() < 1e-9 and np.abs(run.u).max() < 1e-6


def test_the_continuous_integral_rests_while_the_command_is_limited():
    """Held back at its limit for 2 s by a heavy load, the command must leave the limit once the error changes sign."""
    heavy = replace(THESIS_A, g=0.0, Ixx=(200.0, 0, 0), Iyy=(200.0, 0, 0), Izz=(200.0, 0, 0))
    pid = ContinuousPID(kp=(50, 0, 0), ki=(200, 0, 0), kd=(0, 0, 0), limit=20)
    run = simulate(heavy, pid, (0.2, 0, 0), q0=(0, np.pi / 2, 0), duration=6)
    past = run.error[:, 0] < -0.02
    assert past.any() and (run.u[np.argmax(past) : np.argmax(past) + 50, 0] < 20).all()
    assert (run.u[: np.argmax(run.error[:, 0] < 0.1), 0] == 20).mean() > 0.5


def test_the_same_gains_held_for_10_ms_are_unstable():
    refused("unstable", simulate, THESIS_A, PID(kp=(25, 200, 200), kd=(10, 40, 40), filter_hz=1e6), SET_POINT)


def test_a_step_of_ones_own_runs_and_may_write_into_what_it_gets():
    """Not the compiled law of the class it is made from, whether in a class or put into an object."""

    class Half(PID):
        def step(self, t, measured, reference):
            u = 0.5 * super().step(t, measured, reference)
            reference[0] -= measured
            return u

    gains = {"kp": (50, 50, 50), "kd": (5, 5, 5)}
    own, half = PID(**gains), simulate(SMOOTH, Half(**gains), SET_POINT, duration=1)
    plain = own.step
    own.step = lambda *sample: 0.5 * plain(*sample)
    np.testing.assert_array_equal(simulate(SMOOTH, own, SET_POINT, duration=1).u, half.u)
    np.testing.assert_allclose(half.u[0], 0.5 * simulate(SMOOTH, PID(**gains), SET_POINT, duration=1).u[0])
    np.testing.assert_allclose(half.error[0], SET_POINT)


def test_python_controllers_are_reset_too():
    class Counting(Stepped):
        resets = 0

        def reset(self):
            self.controller.reset()
            self.resets += 1

    controller = Counting(PID(kp=(50, 50, 50), kd=(5, 5, 5)))
    first, second = (simulate(SMOOTH, controller, SET_POINT, duration=0.5) for _ in range(2))
    assert controller.resets == 2
    assert (first.q == second.q).all() and np.abs(first.q[-1]).max() > 0.01


def test_a_theta_takes_the_gravity_it_is_given():
    moon = replace(SMOOTH, g=1.62)
    here, by_theta = simulate(moon, duration=1, **START), simulate(moon.theta, g=1.62, duration=1, **START)
    np.testing.assert_allclose(by_theta.q, here.q, atol=1e-12)
    np.testing.assert_allclose(by_theta.energy.total, here.energy.total, atol=1e-12)
    floating = simulate(moon.theta_pwm, g=0, duration=1)
    assert (floating.q == 0).all()
    falling = simulate(moon.theta_pwm, duration=1)  # 9.81 unless told
    np.testing.assert_allclose(falling.q, simulate(SMOOTH, unit="PWM", duration=1).q, atol=1e-12)
    assert np.abs(falling.q).max() > 0.1
    refused(r"g = 0: an Arm carries its own gravity \(1\.62", simulate, moon, g=0)


def test_the_reference_may_be_a_function_an_object_or_three_angles():
    pid = PID(kp=(50, 50, 50), kd=(5, 5, 5))
    by_function = simulate(SMOOTH, pid, lambda t: (np.array(SET_POINT), np.zeros(3), np.zeros(3)), duration=1)
    assert (by_function.q == simulate(SMOOTH, pid, SET_POINT, duration=1).q).all()
    assert (simulate(SMOOTH, pid, q0=(0.1, 0.2, 0.3), duration=1).reference[:, 0] == (0.1, 0.2, 0.3)).all()


# --- dry friction -----------------------------------------------------------------------------------------


class Constant:
    """A drive that does not react."""

    def __init__(self, u):
        self.u = np.asarray(u, dtype=float)

    def step(self, t, q, reference):
        return self.u


def test_sliding_joint_stops_where_the_textbook_says():
    # joint 1 alone, M11 constant at rest pose: Coulomb friction takes v^2 M / (2 fc) of way and v M / fc of time
    arm = type(IR50P)(
        l=(0.3, 0.2, 0.3), m=(1, 0, 0), lc=(0.1, 0, 0), Ixx=(0.3, 0.1, 0.1), Iyy=(0.3, 0.1, 0.1), Izz=(0.3, 0.1, 0.1),
        friction=Friction(fc=(0.5, 0.5, 0.5)),
    )  # fmt: skip
    M11 = arm.theta[0, 0]
    run = simulate(arm, qd0=(1.0, 0, 0), duration=1.5, step=1e-4)
    assert run.q[-1, 0] == pytest.approx(M11 / (2 * 0.5), rel=1e-3)
    assert run.t[np.argmax(run.qd[:, 0] == 0)] == pytest.approx(M11 / 0.5, abs=0.011)


def test_friction_only_takes_energy():
    run = simulate(IR50P, q0=(0, 1.2, 0.3), qd0=(1, 0, 0), duration=5, stops=True)
    # the constant offset Tf is a force like gravity: its potential belongs to the balance
    total = run.energy.total + run.q @ np.array(IR50P.friction.Tf)
    assert (np.diff(total) < 1e-4).all() and total[-1] < total[0] - 1


def test_without_drive_the_arm_sinks_onto_its_stop_or_the_table():
    run = simulate(IR50P, q0=(0, 0.3, 0.2), duration=10, stops=True, table=0.0)
    heights = forward_kinematics(IR50P, run.q)[:, 2]
    assert heights.min() > -1e-4 and heights[-1] < 1e-4
    assert (run.q >= np.array(IR50P.q_min) - 1e-9).all() and (run.q <= np.array(IR50P.q_max) + 1e-9).all()
    assert np.abs(run.qd[-1]).max() < 1e-6
    free = simulate(IR50P, q0=(0, 0.3, 0.2), duration=10)
    assert forward_kinematics(IR50P, free.q)[:, 2].min() < -0.05  # without the table it would go through


def test_an_arm_driven_against_its_stop_stays_there():
    run = simulate(IR50P, PID(kp=(289, 225, 270), limit_pwm=255), (3.0, 0, 0), stops=True)
    assert run.q[:, 0].max() == pytest.approx(IR50P.q_max[0], abs=1e-9)


# --- drive in PWM -----------------------------------------------------------------------------------------


def test_pwm_drive_reaches_the_no_load_speed_and_saturates():
    arm = type(IR50P)(**{**vars_of(IR50P), "g": 0.0, "friction": Friction()})
    run = simulate(arm, Constant([1000, 0, 0]), q0=(0, np.pi / 2, 0), unit="PWM", duration=3)
    assert run.unit == "PWM" and (run.u[:, 0] == 255).all()
    assert run.qd[-1, 0] == pytest.approx(arm.actuators.no_load_speed[0], rel=1e-4)


def vars_of(arm):
    return {n: getattr(arm, n) for n in ("l", "m", "lc", "Ixx", "Iyy", "Izz", "actuators")}


def test_theta_in_pwm_and_the_arm_driven_in_pwm_agree():
    pid = PID(kp=(289, 225, 270), kd=(40, 30, 30), limit_pwm=255)
    a, b = simulate(SMOOTH, pid, SET_POINT, duration=2), simulate(SMOOTH.theta_pwm, pid, SET_POINT, duration=2)
    np.testing.assert_allclose(a.q, b.q, atol=1e-12)
    with pytest.raises(InputError, match=r"own row per joint|equal rows"):
        _ = b.energy


@pytest.mark.parametrize(
    "change, words",
    [
        ({"duration": -1}, ["duration = -1"]),
        ({"duration": 0.001}, ["0.001", "half a period"]),
        ({"step": 0.003}, ["0.01", "whole number", "0.003"]),
        ({"q0": (0, np.nan, 0)}, ["q0", "nan"]),
        ({"unit": "V"}, ["'V'", "'PWM'"]),
        ({"reference": (0, 0)}, ["reference", "(2,)"]),
        ({"reference": lambda t: (np.zeros(2), np.zeros(2), np.zeros(2))}, ["(1001, 3, 2)"]),
    ],
)
def test_bad_input_gets_a_sentence(change, words):
    arguments = {"controller": PID(kp=(1, 1, 1)), "reference": SET_POINT, **change}
    refused(words, simulate, SMOOTH, arguments.pop("controller"), arguments.pop("reference"), **arguments)


def test_more_refusals():
    refused("need an Arm", simulate, THESIS_C, stops=True)
    refused("smooth motion", simulate, IR50P, ContinuousPID(kp=(1, 1, 1)))
    refused(r"command at t = 0 s.*nan", simulate, SMOOTH, Constant([0, np.nan, 0]))
    refused("shape", simulate, SMOOTH, Constant([0, 0]))
    refused("no actuators", simulate, THESIS_A, PID(kp=(1, 1, 1), limit_pwm=255), SET_POINT, error=ArmError)
    with pytest.raises(ArmError, match="negative"):
        theta = SMOOTH.theta.copy()
        theta[:, 10] = -1
        simulate(theta)


class Stepped:
    """A compiled controller behind Python's protocol, so that the loop runs in Python."""

    def __init__(self, controller):
        self.controller, self.unit = controller, controller.unit
        controller.reset()

    def step(self, t, q, reference):
        return self.controller.step(t, q, reference)


@pytest.mark.parametrize(
    "options", [{"limit_pwm": 255}, {"limit_pwm": 60, "derivative_on": "error"}, {"limit": 5, "filter_hz": 3}]
)
def test_the_compiled_twin_gives_the_same_numbers(options):
    def pid():
        return PID(kp=(50, 60, 70), ki=(20, 10, 30), kd=(4, 5, 3), **options)

    compiled = simulate(IR50P, pid(), SET_POINT, duration=2, stops=True)
    stepped = simulate(IR50P, Stepped(pid()), SET_POINT, duration=2, stops=True)
    for name in ("q", "qd", "u"):
        assert (getattr(compiled, name) == getattr(stepped, name)).all()


def test_a_joint_breaks_loose_by_its_own_friction_while_another_turns():
    """Joint 1 turning fast must not take the breakaway of joint 2 down to its Coulomb torque."""
    arm = replace(IR50P, g=0.0, friction=Friction(fc=(0, 0.1, 0.1), fs=(0, 2.0, 2.0), qs=(0.05, 0.05, 0.05)))
    run = simulate(arm, Constant((0, 1.0, 0)), q0=(0, np.pi / 2, 0), qd0=(1.0, 0, 0), duration=0.3)
    assert np.abs(run.qd[:, 0]).min() > 0.1 and (run.qd[:, 1] == 0).all()


def test_pwm_drive_with_the_friction_of_the_arm_equals_the_torque_drive():
    """Breakaway in PWM counts: a push of 0.9 fs holds still, 1.1 fs moves, whatever the unit of the command."""
    for share, moves in ((0.9, False), (1.1, True)):
        q0 = np.array([0.0, 0.4, -0.3])
        push = gravity(IR50P, q0) + np.array(IR50P.friction.Tf) + share * np.array(IR50P.friction.fs)
        run = simulate(IR50P, Constant(push / IR50P.actuators.gain), q0=q0, unit="PWM", duration=0.5)
        assert (np.abs(run.q[-1] - q0) > 1e-3).all() if moves else (run.q == q0).all()
