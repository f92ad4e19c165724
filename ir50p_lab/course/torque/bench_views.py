"""Notebook 15: laws that rest on the student's own model, on the simulated bench and on the arm that answers."""

from types import SimpleNamespace

import numpy as np

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.course import my_robot
from ir50p_lab.course.fitting.gripper_views import copy_theta  # noqa: F401 - of the face
from ir50p_lab.course.lab_book.results import arm_at_rest, load_result, newest_result
from ir50p_lab.course.torque.views import training_run
from ir50p_lab.identification import identify

_SHARE = 1 - np.exp(-2 * np.pi * 10 * 0.01)  # of the 10 Hz filter of 08, every 10 ms
_LIMIT = 255  # counts


class Rate:
    """How fast the error changes, behind the 10 Hz filter of 08."""

    def __init__(self):
        self.last, self.rate = None, np.zeros(3)

    def of(self, error):
        """Return the rate (3,) after one more error (3,), 10 ms later."""
        if self.last is not None:
            self.rate = self.rate + _SHARE * ((error - self.last) / 0.01 - self.rate)
        self.last = error
        return self.rate


class OnBench:
    """The student's `computed_torque` every 10 ms, in counts.

    Args: model(q, qd, qdd, direction) returns counts (3,); into(q, qd, reference) returns the place, speed and
    direction that the model gets, three vectors; speed: of the loop, rad/s, one number or (3,), by default those of
    Tables 4.5-4.7.
    """

    unit = "PWM"

    def __init__(self, model, into, speed=(5, 3, 7)):
        self.model, self.into, self.speed = model, into, np.array(speed, dtype=float)
        self.reset()

    def reset(self):
        """Forget the past."""
        self._rate = Rate()

    def step(self, t, q, reference):
        """Return the counts (3,) for one sample."""
        qd = reference[1] + self._rate.of(q - reference[0])
        place, speed, direction = self.into(q, qd, reference)

        def model(q, qd, qdd):
            return self.model(place, speed, qdd, direction)

        u = my_robot.computed_torque(q, qd, reference, model, self.speed**2, 2 * self.speed)
        return np.clip(u, -_LIMIT, _LIMIT)


class Learning:
    """Adaptive control: u = Y theta - 60 s, with s = de/dt + 4 e; theta learns by the student's `adaptive_step`.

    Y is the student's `regressor` for the motion that would bring s to zero. A joint at its limit does not learn.
    Args: theta (3, 20) counts, where it begins; gain (3, 20). Attributes: theta; beliefs: a theta for each sample.
    """

    unit = "PWM"

    def __init__(self, theta, gain):
        self.start, self.gain = theta, gain
        self.reset()

    def reset(self):
        """Forget what was learnt."""
        self.theta, self.beliefs, self._rate = self.start.copy(), [], Rate()

    def step(self, t, q, reference):
        """Return the counts (3,) for one sample."""
        e = q - reference[0]
        rate = self._rate.of(e)
        s = rate + 4 * e
        Y = my_robot.regressor(q, reference[1] - 4 * e, reference[2] - 4 * rate, np.sign(reference[1]))
        u = np.sum(Y * self.theta, axis=1) - 60 * s
        self.theta = my_robot.adaptive_step(self.theta, Y, s * (np.abs(u) < _LIMIT), self.gain, 0.01)
        self.beliefs.append(self.theta)
        return np.clip(u, -_LIMIT, _LIMIT)


def driven_on_bench(arm, controller, reference, seconds, *, copy_of=None):
    """Run on the simulated bench, from where the reference begins: a Recording, and what the arm truly did.

    copy_of: Arm whose simulated copy is driven, such as one with a load; None: arm.
    """
    bench = SimulatedBench(copy_of or arm, q0=reference(0)[0], record_to=False).open()
    record = bench.follow(controller, reference, seconds)
    return record, SimpleNamespace(t=record.t, q=bench.truth.q, reference=record.reference)


def model_for(arm, bench=None):
    """Return theta (3, 20) in counts for a bench, and whose it is: the student's of 13, else the course's.

    bench: an open bench; None: the simulated one. The course's is identified from 110 simulated seconds.
    """
    bench = bench or SimulatedBench(arm, record_to=False)
    whose = "the course's" if newest_result("model", bench) is None else "yours"
    return load_result("model", bench, lambda: identify(training_run(arm), l2=arm.l[1])).theta, whose


def go(arm, controller_of, reference, seconds):
    """Run the loop of 08 on the arm that answers, from the rest pose and back: its Recording, and whose model drove it.

    controller_of: function of a theta (3, 20), the one that was measured on that arm.
    """
    with arm_at_rest(arm, "calibration", "model") as bench:
        theta, whose = model_for(arm, bench)
        return bench.follow(controller_of(theta), reference, seconds), whose


def table_of_gains(theta, columns):
    """Return the gains (3, 20) of what may learn: 60 for the offsets, else 0.2 (1 + |theta|); 0 for the rest."""
    gain = np.zeros((3, 20))
    gain[:, columns] = 0.2 * (1 + np.abs(theta[:, columns]))
    gain[:, [k for k in columns if k in (16, 17, 18)]] = 60
    return gain
