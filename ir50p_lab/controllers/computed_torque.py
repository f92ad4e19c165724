"""Computed torque (2.19), (4.6), and its smaller relatives: feed-forward with a PD, gravity compensation with a PD."""

from ir50p_lab.controllers import law
from ir50p_lab.controllers.model_based import ModelController


class ComputedTorque(ModelController):
    """Linearise the arm with its own model, then place the poles of what is left    (2.19), (4.6), e = q - q_ref.

        u = M(q) v + C(q, qd) qd + g(q) + F = Phi(q, qd, v) theta,    v = qdd_ref - kd de/dt - kp e - ki int e dt

    With the true model the error obeys e'' + kd e' + kp e = 0 on every joint (2.20): kd = 2 sqrt(kp) is critically
    damped, sqrt(kp) rad/s its speed. The thesis writes e = q_ref + q (2.7); with e = q_ref - q, as for the PID, this
    law would be unstable: the error is q - q_ref here.

    - the model: an Arm, a theta (3, 20) or (20,), or an `Estimate` of a recording; a row per joint, so that motors
      of unequal gain and PWM counts need no further care;
    - velocity="error" filters the rate of the *error*, so that a joint that follows sees no lag of the filter;
      "angle" filters the velocity itself, which lags behind every motion;
    - friction is compensated as far as the model holds any, dry friction for the *reference's* direction, smoothed over
      +-smooth rad/s: measured velocity changes sign with every bit of noise, and the compensation would chatter
      (friction_sign="measured" shows it);
    - delay: s from a sample to the moment its command acts; error and reference are led ahead by as much;
    - integral with anti-windup (it rests while its joint is limited), limits, `set_gains` without a jump of u: what
      would be the jump fades in.

    Args:
        model: Arm, theta or Estimate. In PWM counts if it is an Estimate in PWM, or if limit_pwm is given; else N m.
        kp, kd, ki: (3,) or one number: 1/s^2, 1/s, 1/s^3, whatever the arm.
        limit_pwm: PWM counts, scalar or (3,), default 255 for an Estimate in PWM; or limit: N m, default none.
        smooth: rad/s, width of the smoothed sign, scalar or (3,). friction_sign: 'reference' or 'measured'.
        velocity: 'error' or 'angle'. filter_hz: cut-off of its low pass, Hz (inf: none). position_filter_hz: cut-off
            of a first-order low pass on q, as the thesis has (4.1.3), Hz (None: off).
        delay: s, 0 to 1. model_velocity: velocity in C and viscous friction, 'measured' (2.19) or 'reference'.
        period: s. g: of a theta, m/s^2, default 9.81.

    Raises InputError on bad arguments, ArmError for PWM without actuators.
    """

    mode = law.LINEARISE


class FeedForward(ModelController):
    """The model for the planned motion only, and a PD for the rest; the model sees nothing that is measured.

        u = M(q_ref) qdd_ref + C(q_ref, qd_ref) qd_ref + g(q_ref) + F(qd_ref) - kp e - kd de/dt - ki int e dt

    No measured number goes through the model, so noise and delay do not either, and it could be computed beforehand;
    but the error is not linear: its dynamics change with the pose. Arguments as for `ComputedTorque`, but kp, kd, ki
    are in the unit of u per rad, rad/s, rad s, as for a `PID`.
    """

    mode = law.FEED_FORWARD


class GravityPD(ModelController):
    """PD control with gravity taken away: rests on any set point, without integral, if g is right.

        u = g(q) + Tf - kp e - kd de/dt - ki int e dt,    e = q - q_ref

    Stable for all positive gains with the energy as Lyapunov function (set points; an ideal arm). Arguments as for
    `ComputedTorque` (friction is not used), but kp, kd, ki are in the unit of u per rad, rad/s, rad s.
    """

    mode = law.GRAVITY_ONLY
