"""Computed torque (2.19), (4.6): the arm's own model inside the loop."""

import numpy as np

from ir50p_lab.controllers import law
from ir50p_lab.controllers.base import Controller, gains, unit_of
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.dynamics import as_theta
from ir50p_lab.signals.reference import per_joint

LIMIT_PWM = 255.0


class ComputedTorque(Controller):
    """Linearise the arm with its own model, then place the poles of what is left    (2.19), (4.6), e = q - q_ref.

        u = M(q) v + C(q, qd) qd + g(q) + F = Phi(q, qd, v) theta,    v = qdd_ref - kd de/dt - kp e - ki int e dt

    With the true model the error obeys e'' + kd e' + kp e = 0 on every joint (2.20): kd = 2 sqrt(kp) damps it
    critically, and sqrt(kp) rad/s is its speed. The thesis writes e = q_ref + q (2.7). The error here is q - q_ref;
    with e = q_ref - q, as in the PID, this law would be unstable.

    - The model is an Arm, a theta (3, 20) or (20,), or an `Estimate` from a recording. Each joint has its own row, so
      that motors of unequal gain and PWM counts need no further care.
    - The rate of the *error* is filtered, so that a joint that follows its reference sees no lag of the filter.
    - Friction is compensated as far as the model holds any. Dry friction takes the *reference's* direction, smoothed
      over +-smooth rad/s: measured velocity changes sign with every bit of noise, and the compensation would chatter.
    - `delay` is the time from a sample to the moment when its command acts, s; error and reference are led ahead by it.
    - The integral has anti-windup (it rests while its joint is limited), and the command has limits. `set_gains` acts
      at once.

    Args:
        model: Arm, theta or Estimate. It is in PWM counts if it is an Estimate in PWM, or if limit_pwm is given; else
            in N m.
        kp, kd, ki: (3,) or one number: 1/s^2, 1/s, 1/s^3, for any arm.
        limit_pwm: PWM counts, scalar or (3,), default 255 for an Estimate in PWM; or limit: N m, default none.
        smooth: width of the smoothed sign, rad/s, scalar or (3,). filter_hz: cut-off of the low pass on the rate of
            the error, Hz (inf: none). delay: s, 0 to 1. period: s. g: of a theta, m/s^2, default 9.81.

    Attributes: theta (3, 20), the model in `unit`; kp, ki, kd (3,); limit (3,).
    Raises InputError on bad arguments, ArmError for PWM without actuators.
    """

    tables = (("model_theta", law.THETA),)

    def __init__(
        self,
        model,
        kp,
        kd,
        ki=0.0,
        *,
        limit_pwm=None,
        limit=None,
        smooth=0.05,
        filter_hz=10.0,
        delay=0.0,
        period=0.01,
        g=None,
    ):
        theta, gravity, unit, limit = model_in_unit(model, limit_pwm, limit, g)
        super().__init__(unit, limit, period, filter_hz)
        if number("delay", delay, ">= 0", unit="s") > 1:
            raise InputError(f"delay = {delay!r} s: give 0 to 1 s, from a sample to the moment its command acts")
        p = self.parameters
        p[law.MODE], p[law.ANTI_WINDUP] = law.LINEARISE, True
        p[law.THETA :], p[law.GRAVITY], p[law.DELAY] = theta.ravel(), gravity, delay
        p[law.SMOOTH : law.THETA] = per_joint("smooth", smooth, ">= 0", unit="rad/s")
        self.set_gains(gains("kp", kp), gains("ki", ki), gains("kd", kd))

    def header(self):
        """Return what the head of a recording says: gains, filter, delay, and the model, 20 numbers per joint."""
        return {**super().header(), "delay_s": f"{self.parameters[law.DELAY]:g}", "model_unit": self.unit}

    @property
    def theta(self):
        """The model that the law uses, (3, 20), in `unit`."""
        return self.parameters[law.THETA :].reshape(3, 20).copy()


def model_in_unit(model, limit_pwm=None, limit=None, g=None):
    """Return (theta (3, 20), gravity, unit, limit) of a model: an Arm, a theta, or an Estimate, which has its own unit.

    An Arm or a theta is taken in PWM counts if `limit_pwm` is given, else in N m. In PWM counts the limit is 255 if
    none is given. Raises InputError if the limit is in another unit than the Estimate, ArmError for PWM without
    actuators.
    """
    unit, bound = unit_of(limit_pwm, limit)
    if hasattr(model, "theta") and hasattr(model, "unit"):  # an Estimate
        if model.unit not in ("PWM", "N m"):
            raise InputError(f"the model's unit is {model.unit!r}: fit in 'PWM' or in 'N m'")
        if bound is not None and unit != model.unit:
            name = "limit" if limit_pwm is None else "limit_pwm"
            raise InputError(f"the model was fitted in {model.unit}, but {name} = {bound} is in the other unit")
        unit, model = model.unit, model.theta
    theta, gravity = as_theta(model, g)
    if unit == "PWM" and isinstance(model, Arm):
        theta = np.array(model.theta_pwm)
    return theta, gravity, unit, LIMIT_PWM if unit == "PWM" and bound is None else bound
