"""The independent-joint PID as it runs on a computer: sampled, filtered and limited, without windup or bumps (2.3)."""

from ir50p_lab.controllers import law
from ir50p_lab.controllers.base import Controller, gains, unit_of
from ir50p_lab.inputs import choice


class PID(Controller):
    """Three independent PIDs, one per joint, sampled every `period` seconds.

        u = kp e + I + kd (qd_ref - v),  e = q_ref - q,  I <- I + ki e T       (2.1)-(2.3), with e = q_ref - q (2.4)

    - Derivative on the measurement: v is the difference quotient of q behind a first-order low pass, so that a jump
      of the set point gives no kick; a moving reference brings its own velocity. derivative_on="error" is the textbook
      form (2.3), which shows the kick.
    - Anti-windup: the integral rests while the command is limited and the error would drive it further.
    - Limits: |u| <= limit, and `step` returns the command after limits.
    - Bumpless: `set_gains` changes gains in the middle of a run without a jump of u; the integral takes up the
      difference.
    - A late cycle is integrated over its true length.
    - position_filter_hz filters the measured q itself, before everything else, as the thesis does (4.1.3): less noise
      in u, but a lag of 1/(2 pi position_filter_hz) s that makes the loop swing. It is off unless you ask for it.

    Args:
        kp, ki, kd: (3,), command per rad, per rad s, and per rad/s.
        limit_pwm: limit of the command in PWM counts (the command is then in PWM), scalar or (3,); or
        limit: limit in N m, scalar or (3,). Give one of them; with neither the command is in N m and not limited.
        period: sampling period, s. filter_hz: cut-off of the velocity filter, Hz (inf: none).
        position_filter_hz: cut-off of a first-order low pass on q, Hz (None: q as it is measured).
        derivative_on: "measurement" or "error". anti_windup: False shows what windup does.

    Raises InputError on gains that are negative or not finite, or a period or filter that is not positive.

    >>> from ir50p_lab.controllers import PID
    >>> pid = PID(kp=(289, 225, 270), limit_pwm=255)
    >>> pid.step(0.0, [0, 0, 0], ([0.1, 0, 0], [0, 0, 0], [0, 0, 0])).round(1) + 0.0
    array([28.9,  0. ,  0. ])
    """

    takes_up = law.INTEGRAL

    def __init__(
        self,
        kp,
        ki=0.0,
        kd=0.0,
        *,
        limit_pwm=None,
        limit=None,
        period=0.01,
        filter_hz=10.0,
        position_filter_hz=None,
        derivative_on="measurement",
        anti_windup=True,
    ):
        super().__init__(*unit_of(limit_pwm, limit), period, filter_hz, position_filter_hz)
        on = choice("derivative_on", derivative_on, ("measurement", "error"))
        self.parameters[law.RATE_OF_ANGLE] = on == "measurement"
        self.parameters[law.ANTI_WINDUP] = choice("anti_windup", anti_windup, (True, False))
        self.set_gains(gains("kp", kp), gains("ki", ki), gains("kd", kd))
