"""PID gains from a first-order plus dead time model (2.21), by the rules of the literature.

All gains are of the parallel form C(s) = kp + ki/s + kd s. The derivative is meant without filter: one with a time
constant of Td/10 or less changes little. No rule knows of friction, backlash, saturation or the sampling of the
controller; a controller held for a period h delays by another h/2, which is to be added to L.
"""

import math
from dataclasses import dataclass

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, number


@dataclass(frozen=True)
class PIDGains:
    """Gains of C(s) = kp + ki/s + kd s = kp (1 + 1/(Ti s) + Td s), and where they come from.

    ========= ================================================= ==========
    field     meaning                                           unit
    ========= ================================================= ==========
    kp        proportional                                      u/y
    ki        integral, kp/Ti                                   u/y per s
    kd        derivative, kp Td                                 u/y s
    rule      name of the rule and kind of controller
    warnings  tuple of str: where the rule is used outside its range
    ========= ================================================= ==========

    With a negative gain K of the plant all gains are negative.
    """

    kp: float
    ki: float
    kd: float
    rule: str
    warnings: tuple = ()

    @property
    def Ti(self):
        """Integral time kp/ki, s; inf without integral action."""
        return self.kp / self.ki if self.ki else math.inf

    @property
    def Td(self):
        """Derivative time kd/kp, s."""
        return self.kd / self.kp if self.kp else 0.0


def ziegler_nichols(model, *, kind="PID"):
    """Ziegler and Nichols' rule for the step response (reaction curve).

    With a = K L/T:  P: kp = 1/a;  PI: kp = 0.9/a, Ti = L/0.3;  PID: kp = 1.2/a, Ti = 2 L, Td = L/2

    Made for a quarter of decay from swing to swing after a load disturbance: lively, with little margin. Meant for
    L/T of about 0.1 to 1.

    Source: Ziegler and Nichols, Optimum settings for automatic controllers, Trans. ASME 64 (1942), 759-768.
    Args: model: FOPDT; kind: "P", "PI" or "PID". Returns: PIDGains.
    Raises: InputError if L is 0 (the gain would be infinite) or `kind` is unknown.
    """
    K, T, L = _model(model, "Ziegler and Nichols' rule", dead_time=True)
    factor, Ti, Td = _pick(kind, {"P": (1.0, math.inf, 0.0), "PI": (0.9, L / 0.3, 0.0), "PID": (1.2, 2 * L, L / 2)})
    notes = _uncertain(model)
    if not 0.1 <= L / T <= 1:
        notes += (f"L/T = {L / T:.3g} is outside 0.1 to 1, for which the rule was made: prefer simc or amigo",)
    return _standard(factor * T / (K * L), Ti, Td, f"Ziegler-Nichols step response, {kind}", notes)


def simc(model, *, tau_c=None, kind="PI"):
    """Skogestad's SIMC rule: ask for a closed loop with time constant tau_c.

    PI: kp = T/(K (tau_c + L)), Ti = min(T, 4 (tau_c + L))
    PID: the same in series with (1 + s L/3), "improved SIMC"; multiplied out to the parallel form

    With tau_c = L (default) and T <= 8 L the PI loop is e^(-L s)/(2 L s), whatever K and T: gain margin pi = 3.14,
    phase margin 90 - 28.6 = 61.4 degrees. For slower plants Ti = 8 L keeps disturbances short, with margins falling
    to 2.96 and 46.9 degrees. A larger tau_c is gentler; PID with tau_c = L/2 is as sensitive as PI with L (1.66, 1.59).

    Source: Skogestad, Simple analytic rules for model reduction and PID controller tuning, J. Process Control 13
    (2003), 291-309; PID: Grimholt and Skogestad, J. Process Control 70 (2018), 36-46.
    Args: model: FOPDT; tau_c: s, > 0, default L; kind: "PI" or "PID". Returns: PIDGains.
    Raises: InputError if tau_c is not > 0 (with L = 0 it must be given) or `kind` is unknown.
    """
    K, T, L = _model(model, "SIMC")
    tau_c = _tau_c(tau_c, L)
    Td = _pick(kind, {"PI": 0.0, "PID": L / 3})
    notes = _uncertain(model) if tau_c < 10 * L else ()
    return _series(T / (K * (tau_c + L)), min(T, 4 * (tau_c + L)), Td, f"SIMC, {kind}, tau_c = {tau_c:.4g} s", notes)


def simc_integrating(velocity_model, *, tau_c=None, kind="PID"):
    """SIMC for the position of a joint whose velocity is a FOPDT: the plant K e^(-L s)/(s (T s + 1)).

    In series form kp' = 1/(K (tau_c + L)), Ti' = 4 (tau_c + L), Td' = T, multiplied out to the parallel form.
    PD leaves the integral out: enough for the set point without gravity and friction.

    Source: as `simc`, integrating process with lag.
    Args: velocity_model: FOPDT from u to velocity (rad/s); tau_c: s, > 0, default L; kind: "PD" or "PID".
    Returns: PIDGains for the position. Raises: InputError as `simc`.
    """
    K, T, L = _model(velocity_model, "SIMC")
    tau_c = _tau_c(tau_c, L)
    Ti = _pick(kind, {"PD": math.inf, "PID": 4 * (tau_c + L)})
    rule = f"SIMC for an integrating plant, {kind}, tau_c = {tau_c:.4g} s"
    return _series(1 / (K * (tau_c + L)), Ti, T, rule, _uncertain(velocity_model) if tau_c < 10 * L else ())


def amigo(model, *, kind="PID"):
    """Astrom and Hagglund's AMIGO rule: most integral action for a sensitivity of about 1.4.

    PI:  kp = [0.15 + (0.35 - L T/(L + T)^2) T/L]/K,  Ti = 0.35 L + 13 L T^2/(T^2 + 12 L T + 7 L^2)
    PID: kp = [0.2 + 0.45 T/L]/K,  Ti = L (0.4 L + 0.8 T)/(L + 0.1 T),  Td = 0.5 L T/(0.3 L + T)

    Fitted to 134 plants with smooth step responses, so it leaves room for what a FOPDT model misses. Where
    L/(L + T) < 0.3 the model says too little for a PID controller: the rule is cautious there, and says so.

    Source: Astrom and Hagglund, Revisiting the Ziegler-Nichols step response method for PID control, J. Process
    Control 14 (2004), 635-650; Advanced PID Control (ISA, 2006), chapter 7.
    Args: model: FOPDT; kind: "PI" or "PID". Returns: PIDGains.
    Raises: InputError if L is 0 (the gain would be infinite) or `kind` is unknown.
    """
    K, T, L = _model(model, "AMIGO", dead_time=True)
    kp, Ti, Td = _pick(
        kind,
        {
            "PI": (
                (0.15 + (0.35 - L * T / (L + T) ** 2) * T / L) / K,
                0.35 * L + 13 * L * T**2 / (T**2 + 12 * L * T + 7 * L**2),
                0.0,
            ),
            "PID": (
                (0.2 + 0.45 * T / L) / K,
                L * (0.4 * L + 0.8 * T) / (L + 0.1 * T),
                0.5 * L * T / (0.3 * L + T),
            ),
        },
    )
    notes = _uncertain(model)
    if kind == "PID" and L / (L + T) < 0.3:
        notes += (f"L/(L + T) = {L / (L + T):.2g} is below 0.3: a model of second order would allow a quicker loop",)
    return _standard(kp, Ti, Td, f"AMIGO, {kind}", notes)


def _standard(kp, Ti, Td, rule, warnings=()):
    return PIDGains(kp=kp, ki=kp / Ti, kd=kp * Td, rule=rule, warnings=warnings)


def _series(kp, Ti, Td, rule, warnings):
    """kp (1 + 1/(Ti s))(1 + Td s), multiplied out."""
    return PIDGains(kp=kp * (1 + Td / Ti), ki=kp / Ti, kd=kp * Td, rule=rule, warnings=warnings)


def _model(model, rule, *, dead_time=False):
    """(K, T, L) of a FOPDT, which has checked them; with `dead_time` L must be > 0."""
    if not all(hasattr(model, name) for name in "KTL"):
        raise InputError(f"expected a FOPDT model (fit_fopdt, or FOPDT(K=, T=, L=)), got {model!r:.80}")
    K, T, L = model.K, model.T, model.L
    if dead_time and L == 0:
        raise InputError(
            f"L = 0: {rule} lives on the dead time and would give an infinite gain. Use simc with the closed-loop time "
            "constant you want (tau_c=), or add what the loop itself delays: half a sampling period at least"
        )
    return K, T, L


def _tau_c(tau_c, L):
    if tau_c is None and L == 0:
        raise InputError(
            "L = 0, so there is no natural tau_c: give the closed-loop time constant you want, tau_c= in s"
        )
    return L if tau_c is None else number("tau_c", tau_c, "> 0", unit="s")


def _pick(kind, choices):
    return choices[choice("kind", kind, tuple(choices))]


def _uncertain(model):
    """Say so where the dead time on which the gains rest is hardly known."""
    stderr = getattr(model, "L_stderr", math.nan)
    if stderr > 0.25 * model.L:
        return (f"L = {model.L:.3g} s has a standard error of {stderr:.2g} s: gains that rest on it are as uncertain",)
    return ()
