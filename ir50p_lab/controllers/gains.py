"""Controllers with gains kp, ki, kd that may change in the middle of a run."""

from ir50p_lab.controllers import law
from ir50p_lab.controllers.base import Controller, gains, three


class GainController(Controller):
    """A controller whose `parameters` begin with kp, ki and kd, three numbers each."""

    rows = ("kp", law.KP), ("ki", law.KI), ("kd", law.KD)
    takes_up = law.BUMP  # place in the state of what a change of gains must not do to u at once
    kp = three(law.KP, "Proportional gains (3,).")
    ki = three(law.KI, "Integral gains (3,).")
    kd = three(law.KD, "Derivative gains (3,).")

    def set_gains(self, kp=None, ki=None, kd=None):
        """Change gains in the middle of a run: the command does not jump. See `PID` and `ComputedTorque` for how.

        What is left out stays. Raises InputError for gains that are negative or not finite (none is changed then).
        """
        p, s, given = self.parameters, self.state, {"kp": kp, "ki": ki, "kd": kd}
        wanted = {place: gains(name, given[name]) for name, place in self.rows if given[name] is not None}
        before = self.kp, self.kd
        for place, value in wanted.items():
            p[place : place + 3] = value
        if s[law.STARTED]:
            slope = s[law.SLOPE : law.SLOPE + 3]
            ahead = s[law.ERROR : law.ERROR + 3] + p[law.DELAY] * slope
            s[self.takes_up : self.takes_up + 3] += (before[0] - self.kp) * ahead + (before[1] - self.kd) * slope
