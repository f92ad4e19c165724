"""What the controllers that know the arm have in common: the model, its unit, gains that change without a bump."""

import numpy as np

from ir50p_lab.controllers import law
from ir50p_lab.controllers.base import Controller, gains, unit_of
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, number
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.dynamics import as_theta
from ir50p_lab.signals.reference import per_joint

LIMIT_PWM = 255.0
_FADE = 0.3  # s in which the jump that a change of gains would make fades in


class ModelController(Controller):
    """A controller with a model of the arm inside; see its subclasses for the laws.

    Attributes: theta (3, 20) the model in `unit`; kp, ki, kd (3,); limit (3,).
    """

    tables = (("model_theta", law.THETA),)
    mode = law.LINEARISE

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
        friction_sign="reference",
        velocity="error",
        filter_hz=10.0,
        position_filter_hz=None,
        delay=0.0,
        model_velocity="measured",
        period=0.01,
        g=None,
    ):
        theta, gravity, unit, limit = model_in_unit(model, limit_pwm, limit, g)
        super().__init__(unit, limit, period, filter_hz, position_filter_hz)
        if number("delay", delay, ">= 0", unit="s") > 1:
            raise InputError(f"delay = {delay!r} s: give 0 to 1 s, from a sample to the moment its command acts")
        p = self.parameters
        p[law.MODE], p[law.ANTI_WINDUP], p[law.FADE_RATE] = self.mode, True, 1 / _FADE
        p[law.THETA :], p[law.GRAVITY], p[law.DELAY] = theta.ravel(), gravity, delay
        p[law.SMOOTH : law.THETA] = per_joint("smooth", smooth, ">= 0", unit="rad/s")
        p[law.RATE_OF_ANGLE] = choice("velocity", velocity, ("error", "angle")) == "angle"
        p[law.SIGN_OF_MEASURED] = choice("friction_sign", friction_sign, ("reference", "measured")) == "measured"
        p[law.REFERENCE_VELOCITY] = choice("model_velocity", model_velocity, ("measured", "reference")) == "reference"
        self.set_gains(gains("kp", kp), gains("ki", ki), gains("kd", kd))

    def header(self):
        """Lines for the head of a recording: gains, filters, delay, and the model as 20 numbers a joint."""
        velocity = "angle" if self.parameters[law.RATE_OF_ANGLE] else "error"
        delay = f"{self.parameters[law.DELAY]:g}"
        return {**super().header(), "velocity": velocity, "delay_s": delay, "model_unit": self.unit}

    @property
    def theta(self):
        """The model inside, (3, 20), in `unit`."""
        return self.parameters[law.THETA :].reshape(3, 20).copy()


def model_in_unit(model, limit_pwm=None, limit=None, g=None):
    """(theta (3, 20), gravity, unit, limit) of a model: an Arm, a theta, or an Estimate, which says its own unit.

    An Arm or a theta is in PWM counts if `limit_pwm` is given, else in N m. In PWM counts the limit is 255 if none is
    given.
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
