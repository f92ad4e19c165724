"""What the controllers that know the arm have in common: the model, its unit, gains that change without a bump."""

import numpy as np

from ir50p_lab.controllers import model_law as law
from ir50p_lab.controllers.gains import GainController, gains
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, number, switch
from ir50p_lab.modelling.arm import Arm
from ir50p_lab.modelling.dynamics import as_theta
from ir50p_lab.signals.reference import per_joint

LIMIT_PWM = 255.0
_FADE = 0.3  # s in which the jump that a change of gains would make fades in
_FRICTION = {"none": 0.0, "viscous": 0.0, "coulomb": 1.0, "stribeck": 2.0}


class ModelController(GainController):
    """A controller with a model of the arm inside; see its subclasses for the laws.

    Attributes: theta (3, 20) the model in `unit`; kp, ki, kd (3,); limit (3,).
    """

    kind = 2
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
        friction="coulomb",
        smooth=0.05,
        breakaway=None,
        qs=0.05,
        friction_sign="reference",
        velocity="error",
        filter_hz=10.0,
        position_filter_hz=None,
        delay=0.0,
        model_velocity="measured",
        period=0.01,
        anti_windup=True,
        g=None,
    ):
        theta, gravity, self.unit = model_in_unit(model, limit_pwm, limit, g)
        if self.unit == "PWM" and limit_pwm is None:
            limit_pwm = LIMIT_PWM
        p = self.parameters = np.zeros(law.N_PARAMETERS)
        self.state = np.zeros(law.N_STATES)
        bound = limit if self.unit == "N m" else limit_pwm
        self._write_limit_and_filters(bound, period, filter_hz, position_filter_hz)
        if number("delay", delay, ">= 0", unit="s") > 1:
            raise InputError(f"delay = {delay!r} s: give 0 to 1 s, from a sample to the moment its command acts")
        p[law.DELAY] = delay
        p[law.MODE], p[law.GRAVITY], p[law.FADE_RATE] = self.mode, gravity, 1 / _FADE
        p[law.RATE_OF_ANGLE] = choice("velocity", velocity, ("error", "angle")) == "angle"
        p[law.SIGN_OF_MEASURED] = choice("friction_sign", friction_sign, ("reference", "measured")) == "measured"
        p[law.REFERENCE_VELOCITY] = choice("model_velocity", model_velocity, ("measured", "reference")) == "reference"
        p[law.ANTI_WINDUP] = switch("anti_windup", anti_windup)
        self._friction(model, theta, friction, smooth, breakaway, qs)
        self._write_gains(kp, ki, kd)

    def _friction(self, model, theta, friction, smooth, breakaway, qs):
        p, theta = self.parameters, theta.copy()
        p[law.DRY] = _FRICTION[choice("friction", friction, tuple(_FRICTION))]
        if friction == "none":
            theta[:, 10:16] = 0.0
        p[law.THETA :] = theta.ravel()
        smooth = np.array(per_joint("smooth", smooth, unit="rad/s"))
        if (smooth < 0).any():
            raise InputError(f"smooth = {smooth.tolist()} rad/s: the width of the smoothed sign cannot be negative")
        p[law.SMOOTH : law.SMOOTH + 3] = smooth
        if friction != "stribeck":
            if breakaway is not None:
                raise InputError("breakaway is used by friction='stribeck' only: choose that, or leave breakaway out")
            p[law.QS : law.QS + 3] = 1.0
            return
        if isinstance(model, Arm):
            scale = model.actuators.gain if self.unit == "PWM" else np.ones(3)
            fs, qs = np.array(model.friction.fs) / scale, model.friction.qs
        elif breakaway is None:
            raise InputError(
                "friction='stribeck' needs breakaway=(fs1, fs2, fs3) in the model's unit: the 20 parameters hold the "
                "Coulomb part only; or give an Arm, which knows its breakaway"
            )
        else:
            fs = np.array(per_joint("breakaway", breakaway, unit=self.unit))
        fc = theta[range(3), (11, 13, 15)]
        if (fs < fc).any():
            raise InputError(
                f"breakaway {fs.tolist()} {self.unit} is below Coulomb friction {fc.tolist()}: give fs >= fc"
            )
        p[law.BREAKAWAY : law.BREAKAWAY + 3] = fs
        p[law.QS : law.QS + 3] = per_joint("qs", qs, unit="rad/s", positive=True)

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains in the middle of a run: the command does not jump, what would be the jump fades in.

        What is left out stays. Raises InputError for gains that are negative or not finite (none is changed then).
        """
        old = [self.kp, self.ki, self.kd]
        named = zip(("kp", "ki", "kd"), old, (kp, ki, kd), strict=True)
        self._write_gains(*(was if now is None else gains(name, now) for name, was, now in named))
        if self.state[law.STARTED]:
            s = self.state
            slope = s[law.SLOPE : law.SLOPE + 3]
            ahead = s[law.ERROR : law.ERROR + 3] + self.parameters[law.DELAY] * slope
            s[law.BUMP : law.BUMP + 3] += (old[0] - self.kp) * ahead + (old[2] - self.kd) * slope

    def header(self):
        """Lines for the head of a recording: gains, filters, friction, delay, and the model as 20 numbers a joint."""
        p = self.parameters
        lines = {
            "velocity": "angle" if p[law.RATE_OF_ANGLE] else "error",
            "dry_friction": ("none", "coulomb", "stribeck")[int(p[law.DRY])],
            "delay_s": f"{p[law.DELAY]:g}",
            "model_unit": self.unit,
        }
        lines |= {f"model_theta_{i + 1}": " ".join(f"{x:.6g}" for x in row) for i, row in enumerate(self.theta)}
        return {**super().header(), **lines}

    @property
    def theta(self):
        """The model inside, (3, 20), in `unit`."""
        return self.parameters[law.THETA :].reshape(3, 20).copy()


def model_in_unit(model, limit_pwm=None, limit=None, g=None):
    """(theta (3, 20), gravity, unit) of a model: an Arm, a theta, or an Estimate, which says its own unit.

    An Arm or a theta is in PWM counts if `limit_pwm` is given, else in N m.
    """
    if limit_pwm is not None and limit is not None:
        raise InputError("give limit_pwm (PWM counts) or limit (N m), not both: the command has one unit")
    if hasattr(model, "theta") and hasattr(model, "unit"):  # an Estimate
        if model.unit not in ("PWM", "N m"):
            raise InputError(f"the model's unit is {model.unit!r}: fit in 'PWM' or in 'N m'")
        wrong = ("limit", limit) if model.unit == "PWM" else ("limit_pwm", limit_pwm)
        if wrong[1] is not None:
            raise InputError(f"the model was fitted in {model.unit}, but {wrong[0]} = {wrong[1]} is in the other unit")
        theta, gravity = as_theta(model.theta, g)
        return theta, gravity, model.unit
    theta, gravity = as_theta(model, g)
    if limit_pwm is None:
        return theta, gravity, "N m"
    return (np.array(model.theta_pwm) if isinstance(model, Arm) else theta), gravity, "PWM"
