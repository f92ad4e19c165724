"""The independent-joint PID as it runs on a computer: sampled, filtered, limited, without windup or bumps (2.3)."""

import numpy as np

from ir50p_lab.controllers import pid_law as law
from ir50p_lab.controllers.gains import GainController
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
        self.parameters = np.zeros(law.N_PARAMETERS)
        self.state = np.zeros(law.N_STATES)
        bound = limit if limit_pwm is None else limit_pwm
        self._write_limit_and_filters(bound, period, filter_hz, position_filter_hz)
        self.parameters[law.ON_ERROR] = derivative_on == "error"
        self.parameters[law.ANTI_WINDUP] = switch("anti_windup", anti_windup)
        self._write_gains(kp, ki, kd)

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains in the middle of a run; the integral takes up the difference, so that u does not jump."""
        old = self.parameters.copy()
        places = ((law.KP, kp), (law.KI, ki), (law.KD, kd))
        self._write_gains(*(old[place : place + 3] if new is None else new for place, new in places))
        if self.state[law.STARTED]:
            change, s = old[: law.LIMIT] - self.parameters[: law.LIMIT], self.state
            s[law.INTEGRAL : law.INTEGRAL + 3] += (
                change[law.KP : law.KI] * s[law.ERROR : law.ERROR + 3] + change[law.KD :] * s[law.SLOPE : law.SLOPE + 3]
            )
