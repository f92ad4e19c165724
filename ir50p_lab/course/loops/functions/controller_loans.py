"""The controller of 08 as it is lent, stage by stage."""

P = """class PID:
    unit = "PWM"

    def __init__(self, kp):
        self.kp = kp

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        return self.kp * error"""

PI = """class PID:
    unit = "PWM"

    def __init__(self, kp, ki=0, period=0.01):
        self.kp, self.ki, self.period = kp, ki, period
        self.reset()

    def reset(self):
        self.integral = np.zeros(3)

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        self.integral = self.integral + self.ki * error * self.period
        return self.kp * error + self.integral"""

LIMITS = """class PID:
    unit = "PWM"

    def __init__(self, kp, ki=0, limit_pwm=255, period=0.01):
        self.kp, self.ki, self.limit, self.period = kp, ki, limit_pwm, period
        self.reset()

    def reset(self):
        self.integral = np.zeros(3)

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        grown = self.integral + self.ki * error * self.period
        push = self.kp * error + grown
        winds_up = (np.abs(push) > self.limit) & (push * error > 0)
        self.integral = np.where(winds_up, self.integral, grown)
        return np.clip(self.kp * error + self.integral, -self.limit, self.limit)"""

PID = """class PID:
    unit = "PWM"

    def __init__(self, kp, ki=0, kd=0, limit_pwm=255, period=0.01, filter_hz=10):
        self.kp, self.ki, self.kd, self.limit, self.period = kp, ki, kd, limit_pwm, period
        self.share = 1 - np.exp(-2 * np.pi * filter_hz * period)
        self.reset()

    def reset(self):
        self.integral = np.zeros(3)
        self.speed = np.zeros(3)
        self.last = None

    def step(self, t, q, reference):
        q_wanted, qd_wanted, qdd_wanted = reference
        error = q_wanted - q
        if self.last is not None:
            self.speed = self.speed + self.share * ((q - self.last) / self.period - self.speed)
        self.last = q
        push = self.kp * error + self.kd * (qd_wanted - self.speed)
        grown = self.integral + self.ki * error * self.period
        winds_up = (np.abs(push + grown) > self.limit) & ((push + grown) * error > 0)
        self.integral = np.where(winds_up, self.integral, grown)
        return np.clip(push + self.integral, -self.limit, self.limit)"""
