"""Exercises of notebook 10: volts of a command, calibration, largest cut-off, lag of a filter, error by stiction."""

import numpy as np

from ir50p_lab.course.exercises import Exercise, Number
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import low_pass_lag

NOTEBOOK = "10_bench"

# bench-1: the breakaway of joint 1 of the IR50P, in counts, at 12 V.
_BREAK = 36.0  # PWM counts
_SUPPLY = 12.0  # V

# bench-2: two points of a potentiometer.
_Q, _COUNTS = (-0.5, 1.1), (412.5, 715.1)  # rad, counts
_SLOPE = (_COUNTS[1] - _COUNTS[0]) / (_Q[1] - _Q[0])

# bench-3: a loop that samples every 4 ms.
_PERIOD = 0.004  # s

# bench-4: a first-order low pass in a loop at 100 Hz, a joint in steady motion.
_CUTOFF, _SPEED = 2.0, 0.5  # Hz, rad/s
_LAG = low_pass_lag(_CUTOFF, 100.0)  # s

# bench-5: what stiction can leave without an integral.
_KP = 289.0  # PWM counts per rad, Table 4.1
_FS, _FC, _K = IR50P.friction.fs[0], IR50P.friction.fc[0], IR50P.actuators.gain[0]  # N m, N m, N m per count

EXERCISES = (
    Exercise(
        "bench-1",
        "the mean voltage at the motor for 36 PWM counts by sign and magnitude, supply 12 V",
        Number(_SUPPLY * _BREAK / 255, unit="V", tolerance=0.006),
        why="A seventh of the supply before anything moves: that is what friction costs a slow joint.",
        slips={
            "That is the thesis' map, which gives half the supply at standstill.": _SUPPLY * (_BREAK + 255) / 2 / 255,
            "That is for 24 V; this supply has 12 V.": 24.0 * _BREAK / 255,
            "5 V is the board's logic; the bridge switches the motors' supply.": 5.0 * _BREAK / 255,
            "1023 is the end of the converter's scale; PWM ends at 255.": _SUPPLY * _BREAK / 1023,
        },
    ),
    Exercise(
        "bench-2",
        "the slope of a potentiometer that reads 412.5 counts at -0.5 rad and 715.1 counts at 1.1 rad",
        Number(_SLOPE, unit="counts/rad", tolerance=0.06),
        why="Two points always fit; only a third one can show that the line is wrong.",
        slips={
            "Upside down: that is in rad per count.": 1 / _SLOPE,
            "That is in counts per degree; the angles are in rad.": np.radians(_SLOPE),
            "That line goes through 0 counts at 0 rad; this potentiometer does not: use both points.": (
                _COUNTS[1] / _Q[1]
            ),
            "The first angle is negative: look at the difference of the two angles again.": (
                (_COUNTS[1] - _COUNTS[0]) / (_Q[1] + _Q[0])
            ),
        },
    ),
    Exercise(
        "bench-3",
        "the bound for the cut-off of a low pass in a loop that samples every 4 ms",
        Number(0.5 / _PERIOD, unit="Hz", tolerance=0.5),
        why="Above it there is nothing left to filter: fast noise has become slow noise when it was sampled.",
        slips={
            "That is the sampling rate; two samples are needed for each period of a signal.": 1 / _PERIOD,
            "That is the inequality as the thesis prints it, the wrong way round.": 2 / _PERIOD,
            "That is in rad/s; the question asks for Hz.": np.pi / _PERIOD,
            "That is for the 10 ms of the thesis; this loop is faster.": 0.5 / 0.01,
        },
    ),
    Exercise(
        "bench-4",
        "how far, in rad, a first-order low pass of 2 Hz is behind a joint that turns at a steady 0.5 rad/s",
        Number(_SPEED * _LAG, unit="rad", tolerance=5e-4),
        why="A PID behind this filter steers by where the joint was: that is why it swings.",
        slips={
            "That is the lag in seconds: how far does the joint turn in that time?": _LAG,
            "1/(2 Hz) is the period of the cut-off; the lag is 2 pi times shorter.": _SPEED / _CUTOFF,
            "That is one sample late; this filter averages over many.": _SPEED * 0.01,
        },
    ),
    Exercise(
        "bench-5",
        "the largest error that breakaway can leave in joint 1 of the IR50P with Kp = 289 and no integral",
        Number(_FS / (_K * _KP), unit="rad", tolerance=1e-3),
        why="Seven degrees, by friction alone: this is why lowering Kp1 leaves a large error.",
        slips={
            "That divides N m by PWM counts per rad: bring both to one unit with K.": _FS / _KP,
            "That is the Coulomb friction of a joint that moves; a joint at rest holds up to fs.": _FC / (_K * _KP),
            "Upside down: a larger Kp must leave a smaller error.": _K * _KP / _FS,
            "That is the breakaway in PWM counts; Kp says how many counts a radian gives.": _FS / _K,
        },
    ),
)
