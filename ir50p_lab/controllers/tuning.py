"""PID gains from a first-order plus dead time model (2.21), by the rules of the literature.

All gains are of the parallel form C(s) = kp + ki/s + kd s. The derivative is meant without filter: one with a time
constant of Td/10 or less changes little. No rule knows of friction, backlash, saturation or the sampling of the
controller; a controller held for a period h delays by another h/2, which has to be added to L.
"""

import math
from dataclasses import dataclass

from ir50p_lab.inputs import choice, number


@dataclass(frozen=True)
class PIDGains:
    """Gains of C(s) = kp + ki/s + kd s = kp (1 + 1/(Ti s) + Td s).

    kp: u/y, proportional; ki = kp/Ti: u/y per s, integral; kd = kp Td: u/y s, derivative. With a negative gain K of the
    plant all gains are negative.
    """

    kp: float
    ki: float
    kd: float

    @classmethod
    def of(cls, kp, Ti, Td, *, series=False):
        """From kp, Ti (s, inf: no integral) and Td (s); series: of kp (1 + 1/(Ti s))(1 + Td s), multiplied out."""
        return cls(kp * (1 + Td / Ti) if series else kp, kp / Ti, kp * Td)


def ziegler_nichols(model, *, kind="PID"):
    """Ziegler and Nichols' rule for the step response (reaction curve).

    With a = K L/T:  P: kp = 1/a;  PI: kp = 0.9/a, Ti = L/0.3;  PID: kp = 1.2/a, Ti = 2 L, Td = L/2

    Made for a quarter of decay from swing to swing after a load disturbance: lively, with little margin. Meant for
    L/T of about 0.1 to 1.

    Source: Ziegler and Nichols, Optimum settings for automatic controllers, Trans. ASME 64 (1942), 759-768.
    Args: model: FOPDT; kind: "P", "PI" or "PID". Returns: PIDGains.
    Raises: InputError if L is 0 (the gain would be infinite) or `kind` is unknown.
    """
    K, T, L = model.K, model.T, number("L", model.L, "> 0", unit="s", hint="add half a sampling period, or take simc")
    choice("kind", kind, ("P", "PI", "PID"))
    factor, Ti, Td = {"P": (1.0, math.inf, 0.0), "PI": (0.9, L / 0.3, 0.0), "PID": (1.2, 2 * L, L / 2)}[kind]
    return PIDGains.of(factor * T / (K * L), Ti, Td)


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
    K, T, L, tau_c = _with_tau_c(model, tau_c)
    Td = {"PI": 0.0, "PID": L / 3}[choice("kind", kind, ("PI", "PID"))]
    return PIDGains.of(T / (K * (tau_c + L)), min(T, 4 * (tau_c + L)), Td, series=True)


def simc_integrating(velocity_model, *, tau_c=None, kind="PID"):
    """SIMC for the position of a joint whose velocity is a FOPDT: the plant K e^(-L s)/(s (T s + 1)).

    In series form kp' = 1/(K (tau_c + L)), Ti' = 4 (tau_c + L), Td' = T, multiplied out to the parallel form.
    PD leaves the integral out: enough for the set point without gravity and friction.

    Source: as `simc`, integrating process with lag.
    Args: velocity_model: FOPDT from u to velocity (rad/s); tau_c: s, > 0, default L; kind: "PD" or "PID".
    Returns: PIDGains for the position. Raises: InputError as `simc`.
    """
    K, T, L, tau_c = _with_tau_c(velocity_model, tau_c)
    Ti = {"PD": math.inf, "PID": 4 * (tau_c + L)}[choice("kind", kind, ("PD", "PID"))]
    return PIDGains.of(1 / (K * (tau_c + L)), Ti, T, series=True)


def amigo(model, *, kind="PID"):
    """Astrom and Hagglund's AMIGO rule: most integral action for a sensitivity of about 1.4.

    PI:  kp = [0.15 + (0.35 - L T/(L + T)^2) T/L]/K,  Ti = 0.35 L + 13 L T^2/(T^2 + 12 L T + 7 L^2)
    PID: kp = [0.2 + 0.45 T/L]/K,  Ti = L (0.4 L + 0.8 T)/(L + 0.1 T),  Td = 0.5 L T/(0.3 L + T)

    Fitted to 134 plants with smooth step responses, so it leaves room for what a FOPDT model misses. Where
    L/(L + T) < 0.3 the model says too little for a PID controller: the rule is cautious there.

    Source: Astrom and Hagglund, Revisiting the Ziegler-Nichols step response method for PID control, J. Process
    Control 14 (2004), 635-650; Advanced PID Control (ISA, 2006), chapter 7.
    Args: model: FOPDT; kind: "PI" or "PID". Returns: PIDGains.
    Raises: InputError if L is 0 (the gain would be infinite) or `kind` is unknown.
    """
    K, T, L = model.K, model.T, number("L", model.L, "> 0", unit="s", hint="add half a sampling period, or take simc")
    if choice("kind", kind, ("PI", "PID")) == "PI":
        kp = (0.15 + (0.35 - L * T / (L + T) ** 2) * T / L) / K
        return PIDGains.of(kp, 0.35 * L + 13 * L * T**2 / (T**2 + 12 * L * T + 7 * L**2), 0.0)
    return PIDGains.of((0.2 + 0.45 * T / L) / K, L * (0.4 * L + 0.8 * T) / (L + 0.1 * T), 0.5 * L * T / (0.3 * L + T))


def _with_tau_c(model, tau_c):
    tau_c = model.L if tau_c is None else tau_c
    return model.K, model.T, model.L, number("tau_c", tau_c, "> 0", unit="s", hint="of the closed loop")
