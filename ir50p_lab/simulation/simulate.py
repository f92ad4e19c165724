"""Simulate an arm under a controller: the one entry for notebooks, tests and sweeps."""

import warnings

import numpy as np

from ir50p_lab.controllers.base import Controller, is_compiled
from ir50p_lab.controllers.pid import PID
from ir50p_lab.errors import InputError, UnstableLoopWarning
from ir50p_lab.inputs import number, vector3
from ir50p_lab.modelling.kernel import warn_of_degrees
from ir50p_lab.signals.steps import hold
from ir50p_lab.simulation.plant import make_plant
from ir50p_lab.simulation.simulation_result import SimulationResult
from ir50p_lab.simulation.stability import looks_unstable


def simulate(
    arm,
    controller=None,
    reference=None,
    *,
    duration=10.0,
    period=0.01,
    step=0.001,
    q0=(0.0, 0.0, 0.0),
    qd0=(0.0, 0.0, 0.0),
    unit=None,
    stops=False,
    table=None,
    g=None,
):
    """Simulate `arm` under `controller` for `duration` seconds.

    Time goes in fixed steps: Runge-Kutta (order 4) for motion without dry friction, and a step that can stick (Moreau)
    with dry friction, end stops or a table. The controller sees q every `period`, and its command is held in
    between (zero-order hold). A continuous controller (`ContinuousPID`) acts inside each step instead.

    Args:
        arm: Arm or theta (3, 20).
        controller: any object with `step(t, measured, reference) -> u`; its `reset()` is called first if it has one.
            A compiled one (`PID`) runs compiled throughout. Or a `ContinuousPID`; or None: no drive, u = 0.
        reference: `target(t) -> (q, qd, qdd)` as in `signals` (its `sample` is used if it has one), an array
            (3,) of angles to hold, or None: hold q0.
        duration, period, step: s; period must be a whole number of steps, duration is rounded to whole periods.
        q0, qd0: (3,) angles and velocities at the start, rad and rad/s.
        unit: unit of the command, 'N m' or 'PWM'; default: the controller's own, else 'N m'.
        stops: whether there are end stops at the arm's joint limits; table: height of a table for the tip, m, or None
            (see `make_plant`).
        g: gravity for a theta, m/s^2, default 9.81; an Arm carries its own and refuses this.

    Returns: SimulationResult, sampled every `period`.
    Raises: InputError on bad input, or if the run leaves all bounds (an unstable loop: it says when).
    Warns: UnstableLoopWarning if the run stays finite but looks unstable (`looks_unstable` says how it looks; the
    result keeps the sentence as `unstable`). A run without a controller is not judged.

    >>> from ir50p_lab.controllers import PID
    >>> from ir50p_lab.modelling import IR50P
    >>> from ir50p_lab.simulation import simulate
    >>> run = simulate(IR50P, PID(kp=600, kd=40, limit_pwm=255), [0.5, 0.8, -1.2], duration=3)
    >>> run.q.shape, run.unit
    ((301, 3), 'PWM')
    """
    steps, t = _times(duration, period, step)
    q0, qd0 = vector3("q0", q0), vector3("qd0", qd0, unit="rad/s")
    unit = unit or getattr(controller, "unit", "N m")
    plant = make_plant(arm, unit=unit, stops=stops, table=table, g=g)
    target = _target(reference, q0)
    r = sampled(target, t)
    warn_of_degrees(arm, np.vstack([q0, r[:, 0]]))
    x = np.concatenate([q0, qd0])
    q, qd, u = np.empty((3, len(t), 3))
    if getattr(controller, "continuous", False):
        from ir50p_lab.simulation.loops import continuous_loop

        if plant.dry:
            raise InputError(
                "a continuous controller needs smooth motion: use arm.without_friction() and no end stops or table, "
                "or the sampled PID"
            )
        fine = sampled(target, np.linspace(0, t[-1], 2 * steps * (len(t) - 1) + 1))
        x = np.concatenate([x, np.zeros(3)])
        continuous_loop(plant.theta, plant.numbers, controller.parameters, fine, x, step, steps, q, qd, u)
    elif controller is None or is_compiled(controller):
        from ir50p_lab.simulation.loops import sampled_loop

        law = PID(kp=0) if controller is None else controller
        law.reset()
        sampled_loop(plant.theta, plant.numbers, law.parameters, law.state, t, r, x, 0, step, steps, q, qd, u)
    else:
        if hasattr(controller, "reset"):
            controller.reset()
        _python_loop(plant, controller, t, r, x, step, steps, q, qd, u)
    _refuse_runaway(t, q)
    unstable = ""
    if controller is not None:
        limit = np.fmin(plant.limit, _own_limit(controller))
        unstable = looks_unstable(t, r, q, u, limit, follows=reference is not None)
    if unstable:
        message = f"the loop looks unstable with these gains and this period: {unstable}"
        warnings.warn(message, UnstableLoopWarning, stacklevel=2)
    return SimulationResult(t=t, q=q, qd=qd, u=u, unit=unit, reference=r, arm=arm, g=g, unstable=unstable)


def _own_limit(controller):
    """Limit of the command inside the package's controllers; of others nothing is known."""
    ours = isinstance(controller, Controller) or getattr(controller, "continuous", False)
    return getattr(controller, "limit", np.inf) if ours else np.inf


def _python_loop(plant, controller, t, r, x, step, steps, q, qd, u):
    """The same loop for a controller that is not compiled."""
    from ir50p_lab.simulation.integrators import advance

    for k in range(len(t)):
        q[k], qd[k] = x[:3], x[3:]
        command = controller.step(t[k], q[k].copy(), r[k].copy())
        command = vector3(f"the controller's command at t = {t[k]:.6g} s", command, unit="u")
        u[k] = np.clip(command, -plant.limit, plant.limit)
        if k + 1 < len(t):
            advance(plant.theta, plant.numbers, x, u[k], step, steps)


def _times(duration, period, step):
    for name, value in (("duration", duration), ("period", period), ("step", step)):
        number(name, value, "> 0", unit="s")
    steps = round(period / step)
    if steps < 1 or abs(steps * step - period) > 1e-9 * period:
        raise InputError(f"period = {period} s is not a whole number of steps of {step} s; change one of them")
    samples = round(duration / period)
    if samples < 1:
        raise InputError(f"duration = {duration} s is shorter than half a period of {period} s")
    return steps, np.arange(samples + 1) * period


def _target(reference, q0):
    if reference is None:
        return hold(q0)
    if callable(reference) or hasattr(reference, "sample"):
        return reference
    return hold(vector3("reference", reference))


def sampled(target, t):
    """Return a reference, or any function t -> (q, qd, qdd), at the times t (n,) as (n, 3, 3). Raises InputError."""
    if hasattr(target, "sample"):
        r = target.sample(t)
    else:
        r = np.array([np.stack(target(time)) for time in t])
    r = np.ascontiguousarray(r, dtype=float)
    if r.shape != (len(t), 3, 3) or not np.isfinite(r).all():
        raise InputError(f"the reference gives shape {r.shape} or numbers that are not finite; need ({len(t)}, 3, 3)")
    return r


def _refuse_runaway(t, q):
    lost = ~np.isfinite(q).all(axis=1)
    if lost.any():
        raise InputError(
            f"the run left all bounds at t = {t[np.argmax(lost)]:.4g} s: the loop is unstable with these gains and "
            "this period, or the step is too long; lower the gains, the period or the step"
        )
