"""The independent-joint PID as it runs on a computer: sampled, filtered, limited, without windup or bumps (2.3)."""

import numpy as np

from ir50p_lab.controllers.gains import GainController, positive
from ir50p_lab.controllers.pid_law import (
    ANTI_WINDUP,
    ERROR,
    FILTER_RATE,
    INTEGRAL,
    KD,
    KI,
    KP,
    LIMIT,
    N_PARAMETERS,
    N_STATES,
    ON_ERROR,
    PERIOD,
    POSITION_RATE,
    SLOPE,
    STARTED,
)
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, switch


class PID(GainController):
    """Three independent PIDs, one per joint, sampled every `period` seconds.

        u = kp e + I + kd (qd_ref - v),  e = q_ref - q,  I <- I + ki e T       (2.1)-(2.3), with e = q_ref - q (2.4)

    - derivative on the measurement: v is the difference quotient of q behind a first-order low pass, so that a jump
      of the set point gives no kick; a moving reference brings its own velocity. derivative_on="error" is the textbook
      form (2.3), to see the kick;
    - anti-windup: the integral rests while the command is limited and the error would push it further;
    - limits: |u| <= limit, and the applied value is what `step` returns;
    - bumpless: `set_gains` changes gains in the middle of a run without a jump of u;
    - a late cycle is integrated over its true length;
    - position_filter_hz filters the measured q itself, before everything else, as the thesis does (4.1.3): less noise
      in u, and a lag of 1/(2 pi position_filter_hz) s that makes the loop swing. Off unless asked for.

    Args:
        kp, ki, kd: (3,), command per rad, per rad s, and per rad/s.
        limit_pwm: limit of the command in PWM counts (the command is then in PWM), scalar or (3,); or
        limit: limit in N m, scalar or (3,). Give one; with neither the command is in N m and not limited.
        period: sampling period, s. filter_hz: cut-off of the velocity filter, Hz (inf: none).
        position_filter_hz: cut-off of a first-order low pass on q, Hz (None: q as it is measured).
        derivative_on: "measurement" or "error". anti_windup: False shows what windup does.

    Raises InputError on gains that are negative or not finite, or a period or filter that is not positive.
    """

    kind = 1

    def __init__(
        self,
        kp,
        ki=(0.0, 0.0, 0.0),
        kd=(0.0, 0.0, 0.0),
        *,
        limit_pwm=None,
        limit=None,
        period=0.01,
        filter_hz=10.0,
        position_filter_hz=None,
        derivative_on="measurement",
        anti_windup=True,
    ):
        if limit_pwm is not None and limit is not None:
            raise InputError("give limit_pwm (PWM counts) or limit (N m), not both: the command has one unit")
        choice("derivative_on", derivative_on, ("measurement", "error"))
        self.unit = "N m" if limit_pwm is None else "PWM"
        bound = limit if limit_pwm is None else limit_pwm
        self.parameters = np.zeros(N_PARAMETERS)
        self.state = np.zeros(N_STATES)
        self.parameters[LIMIT : LIMIT + 3] = np.inf if bound is None else positive("limit", bound, joints=True)
        self.parameters[PERIOD] = positive("period", period)
        self.parameters[FILTER_RATE] = 2 * np.pi * positive("filter_hz", filter_hz, infinite=True)
        if position_filter_hz is not None:
            rate = 2 * np.pi * positive("position_filter_hz", position_filter_hz, infinite=True)
            self.parameters[POSITION_RATE] = 0.0 if np.isinf(rate) else rate  # 0 and inf: no filter
        self.parameters[ON_ERROR] = derivative_on == "error"
        self.parameters[ANTI_WINDUP] = switch("anti_windup", anti_windup)
        self._write_gains(kp, ki, kd)

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains in the middle of a run; the integral takes up the difference, so that u does not jump."""
        old = self.parameters.copy()
        new = [old[place : place + 3] if g is None else g for place, g in ((KP, kp), (KI, ki), (KD, kd))]
        self._write_gains(*new)
        if self.state[STARTED]:
            change = old[:LIMIT] - self.parameters[:LIMIT]
            self.state[INTEGRAL : INTEGRAL + 3] += (
                change[KP:KI] * self.state[ERROR : ERROR + 3] + change[KD:] * self.state[SLOPE : SLOPE + 3]
            )

    def header(self):
        """Lines for the head of a recording: the gains, joints 1 to 3, and the filters."""
        lines = {name: " ".join(f"{x:g}" for x in getattr(self, name)) for name in ("kp", "ki", "kd")}
        filters = {"filter_hz": FILTER_RATE, "position_filter_hz": POSITION_RATE}
        rates = {name: self.parameters[place] / (2 * np.pi) for name, place in filters.items()}
        return {**super().header(), **lines, **{name: f"{hz or np.inf:g}" for name, hz in rates.items()}}
