"""What is not ideal about an arm on the bench: one table, and a reason for each number. Nothing here was measured."""

from dataclasses import dataclass, fields, replace

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.home import setting
from ir50p_lab.inputs import number, vector3, whole


@dataclass(frozen=True, kw_only=True)
class ArmInstance:
    """One copy of an arm, with everything that its drawing does not say.

    Friction, breakaway, motor gains, back-EMF and the limit of the supply belong to the Arm (`arm.friction`,
    `arm.actuators`); this table holds what comes on top. `drawn(seed)` gives one copy of a series; with spread=0 it is
    the nominal one.
    """

    # --- drive
    # Torque per count and dry friction, relative to the arm's own values; a drawn unit has its own.
    motor_gain: tuple = (1.0, 1.0, 1.0)
    friction: tuple = (1.0, 1.0, 1.0)
    # PWM counts. Assumed: pulses shorter than the 0.6 us in which a bridge turns on are swallowed whole; one count is
    # 0.2 us at 20 kHz. Longer pulses are shifted, not shortened, so the counts above act in full.
    dead_zone: tuple = (3.0, 3.0, 3.0)
    # rad between the flanks of the gear. Assumed: the +-0.5 mm repeatability of the ROB3i manual is play at 0.5 m.
    backlash: tuple = (0.002, 0.002, 0.002)
    # PWM counts. Assumed: pot and bearings behind the gear hold the link within the play against this much gravity.
    link_drag: float = 2.0
    # Periods from a sample to the moment its command acts. Assumed: serial line and computer as in thesis 4.1.2.
    delay: int = 2

    # --- potentiometers and converter, in counts of the 10-bit converter
    # Gain relative to the nominal calibration, and shift; a drawn unit has its own.
    pot_slope: tuple = (1.0, 1.0, 1.0)
    pot_shift: tuple = (0.0, 0.0, 0.0)
    # Largest deviation from a straight line, in the middle of the travel. Assumed: a good wire-wound one, 0.2 %.
    pot_bow: tuple = (1.5, -1.5, 1.5)
    # rms before rounding. Assumed: the thesis calls its signals very noisy; 1 count is 5 to 8 mrad here.
    noise: float = 1.0

    # --- surroundings
    # Height of the table, m. Assumed: the base stands on it.
    table: float = 0.0

    # --- how much copies differ: 1 as below, 0 not at all
    spread: float = 1.0
    # Half widths of the potentiometers, mounted by hand. Assumed; likewise 3 % of the motors, 5 % of the greased gears.
    slope_spread: float = 0.01
    shift_spread: float = 3.0
    bow_spread: float = 0.5

    def __post_init__(self):
        for field in fields(self):
            name, value = f"unit {field.name}", getattr(self, field.name)
            if field.type is tuple:
                object.__setattr__(self, field.name, tuple(vector3(name, value, unit="its unit").tolist()))
            else:
                number(name, value)
        whole("unit delay", self.delay, 0, 100)

    def drawn(self, seed):
        """Return copy number `seed` of the series: its own values, evenly distributed, and spread 0."""
        even = np.random.default_rng([int(seed), 0]).uniform(-self.spread, self.spread, (5, 3))
        return replace(
            self,
            motor_gain=self.motor_gain * (1 + 0.03 * even[0]),
            friction=self.friction * (1 + 0.05 * even[1]),
            pot_slope=self.pot_slope * (1 + self.slope_spread * even[2]),
            pot_shift=self.pot_shift + self.shift_spread * even[3],
            pot_bow=self.pot_bow + self.bow_spread * even[4],
            spread=0.0,
        )


UNIT = ArmInstance()


def chosen_copy(seed):
    """Return the number of the copy that the environment makes of `seed`, and a seed for its noise or None.

    IR50P_UNIT (a whole number, default 0) is the copy that `seed=0` means, and the others are counted from it: a course
    that compares two copies compares two neighbours. IR50P_SEED (a whole number; unset: none) gives the same copy other
    noise. Raises InputError if one of them is not a whole number from 0.
    """
    return int(seed) + (_whole("IR50P_UNIT") or 0), _whole("IR50P_SEED")


def _whole(variable):
    text = setting(variable)
    if text and not text.isdecimal():
        raise InputError(f"{variable} = {text!r}: give a whole number from 0, or leave it unset")
    return int(text) if text else None
