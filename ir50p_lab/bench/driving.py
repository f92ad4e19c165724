"""From the command of a controller to the pins of the bridge, and when to stop driving a joint (4.2.1, Figure 4.7)."""

import math

import numpy as np

from ir50p_lab.controllers.base import check_controller
from ir50p_lab.errors import InputError
from ir50p_lab.inputs import choice, numbers

LIMIT_PWM = 255


def sign_and_magnitude(u):
    """Direction and duty of a command: direction = sign(u), duty = min(|u|, 255) in whole counts  (4.2.1 corrected)

    Args: u: PWM counts, any shape. Returns: direction (-1, 0 or 1) and duty (0..255), integers of the same shape.
    Raises InputError if a number is not finite.
    """
    u = numbers("u", u, unit="PWM counts")
    if not np.isfinite(u).all():
        raise InputError(f"u = {u.tolist()}: every number must be finite (PWM counts)")
    duty = np.minimum(np.rint(np.abs(u)), LIMIT_PWM).astype(int)
    return np.sign(u).astype(int) * (duty > 0), duty


def bridge_inputs(u):
    """Levels of an L6203 for a command: share of time that IN1 is high (0..1), and IN2 (0 or 1).

    The motor gets the supply times (IN1 - IN2). Forward: IN2 = 0 and duty d on IN1; reverse: IN2 = 1 and 1 - d on IN1,
    so that in the rest of each period both are high: in either direction the pauses brake.
    Args: u: PWM counts, any shape. Raises InputError if a number is not finite.
    """
    direction, duty = sign_and_magnitude(u)
    share, reverse = duty / LIMIT_PWM, (direction < 0).astype(int)
    return np.where(reverse, 1 - share, share), reverse


def thesis_map(u):
    """The thesis' map of the command onto the range of analogWrite: (u + 255)/2, so [-255, 255] -> [0, 255] (4.2.1).

    Wrong for a bridge driven by sign and magnitude: u = 0 becomes 127.5, half the supply (`mean_voltage`). It is right
    for locked anti-phase wiring only, where 127.5 is standstill. Here for the check of the thesis, not for driving.
    u in whole counts, as analogWrite takes them. Raises InputError if a number is not finite.
    """
    direction, duty = sign_and_magnitude(u)
    return (direction * duty + LIMIT_PWM) / 2


def mean_voltage(duty, direction=1, *, supply=12.0, wiring="sign-magnitude"):
    """Mean voltage at the motor for a duty of 0..255 counts, V.

    wiring: 'sign-magnitude': duty switches between supply and short, `direction` (-1, 0, 1) gives the sign:
    V duty/255. 'locked anti-phase': duty switches between +supply and -supply: V (2 duty/255 - 1), direction unused.
    Raises InputError for a duty outside 0..255 or another wiring.
    """
    duty = numbers("duty", duty, unit="PWM counts")
    if not ((duty >= 0) & (duty <= LIMIT_PWM)).all():
        raise InputError(f"duty = {duty.tolist()}: analogWrite takes 0 to {LIMIT_PWM} PWM counts, finite")
    if choice("wiring", wiring, ("sign-magnitude", "locked anti-phase")) == "sign-magnitude":
        return supply * np.asarray(direction) * duty / LIMIT_PWM
    return supply * (2 * duty / LIMIT_PWM - 1)


class StopCriterion:
    """Stops driving a joint that has arrived, around any controller; each joint on its own (Figure 4.7 corrected).

    A joint stops when its |e| is below `inner`, and goes on when |e| exceeds `outer`
    (hysteresis: noise at one bound would switch it on and off). e is the error behind a first-order low pass. While its
    reference moves a joint is always driven. The thesis stops where e < 0.01, with its sign: every joint above its set
    point counts as arrived, however far away it is (signed=True shows it).

    What stopping does is physics: with hold="latch" the joint keeps its present command (smoothed), which still
    carries its weight, and friction holds it there (a joint that still creeps may creep on to `outer`). With
    hold="off" the command is 0, as in the thesis: joint 1 stays (gravity does not turn it), joint 2 drops, because
    its weight is several times its stiction, until |e| > outer catches it again; then it is lifted and dropped for
    ever.

    While a joint is stopped the controller inside sees it on its set point, at rest: its integral waits.

    Args:
        controller: object with step(t, measured, reference) -> u (3,). hold: 'latch' or 'off'.
        signed: the thesis' criterion, e < inner with the sign and without hysteresis; to see what it does.

    Attributes: stopped: (3,) bool; unit, controller: of the controller inside. To be set: inner, outer: rad, one number
    or (3,), 0 < inner < outer; smooth: time constant of the low pass for e and u, s, 0: none.
    Raises InputError on other values.
    """

    inner, outer, smooth = 0.01, 0.02, 0.05

    def __init__(self, controller, *, hold="latch", signed=False):
        check_controller(controller)
        self.controller, self.unit = controller, getattr(controller, "unit", "N m")
        self.hold, self.signed = choice("hold", hold, ("latch", "off")), signed
        self.reset()

    def reset(self):
        """Forget the past, of the controller inside too."""
        if hasattr(self.controller, "reset"):
            self.controller.reset()
        self.stopped = np.zeros(3, dtype=bool)
        self._t, self._e, self._u = -math.inf, np.zeros(3), np.zeros(3)

    def step(self, t, measured, reference):
        """The command for one sample, (3,); see `Controller.step`."""
        rows = np.array(reference, dtype=float)
        blend = 1.0 - math.exp(-max(0.0, t - self._t) / max(self.smooth, 1e-9))
        self._t = t
        self._e += blend * (rows[0] - measured - self._e)
        far, moving = np.abs(self._e), rows[1] != 0
        self.stopped = ((far < self.inner) | (self.stopped & (far <= self.outer))) & ~moving
        if self.signed:
            self.stopped = self._e < self.inner
        rows[0, self.stopped], rows[1:, self.stopped] = np.asarray(measured)[self.stopped], 0.0
        u = np.array(self.controller.step(t, measured, rows), dtype=float)
        going = ~self.stopped
        self._u[going] += blend * (u[going] - self._u[going])
        u[self.stopped] = self._u[self.stopped] if self.hold == "latch" else 0.0
        return u
