"""Laws beside which computed torque is judged: with what is planned in its model, and a PD with a model's push."""

import numpy as np

from ir50p_lab.controllers import PID
from ir50p_lab.identification import regressor


def push(theta, q, qd, qdd):
    """Counts (3,) of a motion by a theta (3, 20); dry friction smoothed over 0.05 rad/s."""
    return np.einsum("ij,ij->i", np.squeeze(regressor(q, qd, qdd, sign=0.05)), theta)


class PlannedSpeed:
    """Computed torque whose model is given the measured place, and the speed and direction of the reference."""

    unit = "PWM"

    def __init__(self, theta, kp, kd):
        self.theta, self.kp, self.kd = theta, np.array(kp), np.array(kd)
        self.reset()

    def reset(self):
        self.last, self.rate = None, np.zeros(3)

    def step(self, t, q, reference):
        error = q - reference[0]
        if self.last is not None:
            self.rate = self.rate + (1 - np.exp(-0.2 * np.pi)) * ((error - self.last) / 0.01 - self.rate)  # 10 Hz
        self.last = error
        wanted = reference[2] - self.kd * self.rate - self.kp * error
        return np.clip(push(self.theta, q, reference[1], wanted), -255, 255)


class PushAndPD:
    """A PD, and a model's push beside it: of the whole reference, or of the weight alone where the arm is."""

    unit = "PWM"

    def __init__(self, theta, kp, kd, *, weight_alone=False):
        self.theta, self.weight_alone = theta, weight_alone
        self.pid = PID(kp, kd=kd, limit_pwm=1e6, derivative_on="error")
        self.reset = self.pid.reset

    def step(self, t, q, reference):
        rows = (q, np.zeros(3), np.zeros(3)) if self.weight_alone else reference
        return np.clip(self.pid.step(t, q, reference) + push(self.theta, *rows), -255, 255)
