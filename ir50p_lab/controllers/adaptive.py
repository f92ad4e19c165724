"""Adaptive control: computed torque's relative that learns the 20 parameters of each joint while it tracks."""

import numpy as np

from ir50p_lab.controllers import adaptive_law as law
from ir50p_lab.controllers.base import Controller
from ir50p_lab.controllers.gains import gains, limits
from ir50p_lab.controllers.model_based import LIMIT_PWM, model_in_unit
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number, numbers
from ir50p_lab.signals.reference import per_joint

_OFFSETS = (16, 17, 18)


class AdaptiveControl(Controller):
    """Slotine and Li's adaptive control: tracks with the parameters it believes, and corrects them by what goes wrong.

        s = de/dt + Lambda e,  qd_r = qd_ref - Lambda e,  e = q - q_ref
        u = Y theta - K s,     Y theta = M(q) qdd_r + C(q, qd) qd_r + g(q) + F
        theta_i <- theta_i - T Gamma_i Y_i s_i        for each joint's own row i, within its bounds

    Why it converges: for V = 1/2 s' M s + 1/2 sum_i K_i (theta_i - true_i)' Gamma_i^-1 (theta_i - true_i), with C by
    Christoffel symbols (dM/dt - 2 C is skew), dV/dt = -s' K s <= 0. Then s, and with it e, goes to zero. K_i is joint
    i's torque per unit of u: the rows may be in PWM counts, and nobody needs to know the motors' gains. theta itself
    becomes right only as far as the motion excites it.

    That holds in continuous time for an arm of this form; on a bench noise, delay and stiction are left over. So
    learning rests where |s_i| is within `dead_band` (noise would walk the parameters away), and where the command is
    limited; and every parameter stays between `lower` and `upper`.

    Args:
        model: what is believed at first: Arm, theta or Estimate; unit and limit_pwm, limit, g as for `ComputedTorque`.
        Lambda: (3,) 1/s; K: (3,) unit of u per rad/s; Gamma: adaptation gains, scalar, (20,) or (3, 20), >= 0, the
            square of a parameter's size per (unit of u rad): 0 keeps a parameter as it is.
        lower, upper: bounds, scalar, (20,) or (3, 20); default: 0 and infinity, offsets Tf without bounds.
        dead_band: rad/s, scalar or (3,). smooth: rad/s, width of the smoothed sign of the reference's velocity for dry
            friction. filter_hz: low pass on the rate of the error, Hz. period: s.

    Attributes: theta (3, 20): what is believed now (after a run: what was learnt; `reset` goes back to the first).
    Raises InputError on bad arguments, ArmError for PWM without actuators.
    """

    kind = 3

    def __init__(
        self,
        model,
        Lambda,
        K,
        Gamma,
        *,
        lower=None,
        upper=None,
        dead_band=0.0,
        limit_pwm=None,
        limit=None,
        smooth=0.05,
        filter_hz=10.0,
        period=0.01,
        g=None,
    ):
        theta, gravity, self.unit = model_in_unit(model, limit_pwm, limit, g)
        if self.unit == "PWM" and limit_pwm is None:
            limit_pwm = LIMIT_PWM
        bound = limit if self.unit == "N m" else limit_pwm
        p = self.parameters = np.zeros(law.N_PARAMETERS)
        self.state = np.zeros(law.N_STATES)
        p[law.LAMBDA : law.LAMBDA + 3] = gains("Lambda", Lambda)
        p[law.K : law.K + 3] = gains("K", K)
        p[law.LIMIT : law.LIMIT + 3] = limits(bound)
        p[law.PERIOD] = number("period", period, "> 0", unit="s")
        p[law.FILTER_RATE] = 2 * np.pi * number("filter_hz", filter_hz, "> 0 or inf", unit="Hz")
        p[law.GRAVITY] = gravity
        for name, place, value in (("dead_band", law.DEAD_BAND, dead_band), ("smooth", law.SMOOTH, smooth)):
            value = np.array(per_joint(name, value, unit="rad/s"))
            if (value < 0).any():
                raise InputError(f"{name} = {value.tolist()} rad/s: cannot be negative")
            p[place : place + 3] = value
        Gamma = _table("Gamma", Gamma)
        if (Gamma < 0).any() or not np.isfinite(Gamma).all():
            raise InputError("Gamma holds numbers that are negative or not finite: it would learn away from the truth")
        floor = np.zeros(20)
        floor[list(_OFFSETS)] = -np.inf
        lower = _table("lower", floor if lower is None else lower)
        upper = _table("upper", np.inf if upper is None else upper)
        lower, upper = np.where(Gamma > 0, lower, -np.inf), np.where(Gamma > 0, upper, np.inf)
        outside = (theta < lower) | (theta > upper)
        if outside.any():
            i, k = np.argwhere(outside)[0]
            raise InputError(
                f"theta of joint {i + 1}, column {k} is {theta[i, k]:.4g}, outside its bounds {lower[i, k]:.4g} to "
                f"{upper[i, k]:.4g}: start within them (a fit with method='bounded' does), or widen them"
            )
        tables = (law.GAMMA, Gamma), (law.LOWER, lower), (law.UPPER, upper), (law.FIRST_THETA, theta)
        for place, table in tables:
            p[place : place + 60] = table.ravel()

    @property
    def theta(self):
        """The parameters believed now, (3, 20), in `unit`."""
        if self.state[law.STARTED]:
            return self.state[law.THETA : law.THETA + 60].reshape(3, 20).copy()
        return self.parameters[law.FIRST_THETA :].reshape(3, 20).copy()

    @property
    def limit(self):
        """Limits of the command (3,), in its unit; infinite where there is none."""
        return self.parameters[law.LIMIT : law.LIMIT + 3].copy()

    def header(self):
        """Lines for the head of a recording: gains, and the parameters it starts with."""
        p = self.parameters
        lines = {"Lambda": law.LAMBDA, "K": law.K, "dead_band": law.DEAD_BAND}
        lines = {name: " ".join(f"{x:g}" for x in p[place : place + 3]) for name, place in lines.items()}
        lines |= {"filter_hz": f"{p[law.FILTER_RATE] / (2 * np.pi):g}", "model_unit": self.unit}
        for name, place in (("Gamma", law.GAMMA), ("first_theta", law.FIRST_THETA)):
            rows = p[place : place + 60].reshape(3, 20)
            lines |= {f"{name}_{i + 1}": " ".join(f"{x:.6g}" for x in row) for i, row in enumerate(rows)}
        return {**super().header(), **lines}


def _table(name, value):
    """Numbers for all parameters of all joints, (3, 20); infinite ones are allowed."""
    try:
        table = np.broadcast_to(numbers(name, value), (3, 20))
    except ValueError:
        raise InputError(f"{name}: give one number, 20 numbers, or 20 per joint, (3, 20)") from None
    if np.isnan(table).any():
        raise InputError(f"{name} holds NaN: give numbers")
    return table
