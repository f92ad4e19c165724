"""Adaptive control: computed torque's relative that learns the 20 parameters of each joint while it tracks."""

import numpy as np

from ir50p_lab.controllers import adaptive_law, law
from ir50p_lab.controllers.base import Controller
from ir50p_lab.controllers.model_based import model_in_unit
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers
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

    kind = 2
    sizes = adaptive_law.N_PARAMETERS, adaptive_law.N_STATES
    rows = ("Lambda", adaptive_law.LAMBDA), ("K", adaptive_law.K), ("dead_band", adaptive_law.DEAD_BAND)
    tables = ("Gamma", adaptive_law.GAMMA), ("first_theta", law.THETA)

    def __init__(
        self,
        model,
        Lambda,
        K,
        Gamma,
        *,
        lower=None,
        upper=np.inf,
        dead_band=0.0,
        limit_pwm=None,
        limit=None,
        smooth=0.05,
        filter_hz=10.0,
        period=0.01,
        g=None,
    ):
        theta, gravity, unit, limit = model_in_unit(model, limit_pwm, limit, g)
        super().__init__(unit, limit, period, filter_hz)
        p = self.parameters
        p[law.GRAVITY] = gravity
        for (name, place), value in zip(self.rows, (Lambda, K, dead_band), strict=True):
            p[place : place + 3] = per_joint(name, value, ">= 0")
        p[law.SMOOTH : law.THETA] = per_joint("smooth", smooth, ">= 0", unit="rad/s")
        Gamma = _table("Gamma", Gamma)
        if (Gamma < 0).any() or not np.isfinite(Gamma).all():
            raise InputError("Gamma holds numbers that are negative or not finite: it would learn away from the truth")
        floor = np.zeros(20)
        floor[list(_OFFSETS)] = -np.inf
        lower, upper = _table("lower", floor if lower is None else lower), _table("upper", upper)
        lower, upper = np.where(Gamma > 0, lower, -np.inf), np.where(Gamma > 0, upper, np.inf)
        outside = (theta < lower) | (theta > upper)
        if outside.any():
            i, k = np.argwhere(outside)[0]
            raise InputError(
                f"theta of joint {i + 1}, column {k} is {theta[i, k]:.4g}, outside its bounds {lower[i, k]:.4g} to "
                f"{upper[i, k]:.4g}: start within them (a fit with method='bounded' does), or widen them"
            )
        p[law.THETA : adaptive_law.DEAD_BAND] = theta.ravel()
        p[adaptive_law.GAMMA :] = np.concatenate([Gamma, lower, upper]).ravel()

    @property
    def theta(self):
        """The parameters believed now, (3, 20), in `unit`."""
        if self.state[law.STARTED]:
            return self.state[adaptive_law.THETA : adaptive_law.Y].reshape(3, 20).copy()
        return self.parameters[law.THETA : law.THETA + 60].reshape(3, 20).copy()

    def header(self):
        """Lines for the head of a recording: gains, and the parameters it starts with."""
        return {**super().header(), "model_unit": self.unit}


def _table(name, value):
    """Numbers for all parameters of all joints, (3, 20); infinite ones are allowed."""
    try:
        table = np.broadcast_to(numbers(name, value), (3, 20))
    except ValueError:
        raise InputError(f"{name}: give one number, 20 numbers, or 20 per joint, (3, 20)") from None
    if np.isnan(table).any():
        raise InputError(f"{name} holds NaN: give numbers")
    return table
