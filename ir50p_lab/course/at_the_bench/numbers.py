"""Numbers of notebooks 10 and 11: the lag of a filter, what stiction leaves."""

import math

from ir50p_lab.course.checking.number import Number
from ir50p_lab.modelling import IR50P

# bench-4: a first-order low pass in a loop at 100 Hz, a joint in steady motion.
_CUTOFF, _SPEED = 2.0, 0.5  # Hz, rad/s
_LAG = 1 / (200 * math.tan(0.01 * math.pi * _CUTOFF))  # s, bilinear at 100 Hz

# bench-5: what stiction can leave without an integral.
_KP = 289.0  # PWM counts per rad, Table 4.1
_FS, _FC, _K = IR50P.friction.fs[0], IR50P.friction.fc[0], IR50P.actuators.gain[0]  # N m, N m, N m per count

NUMBERS = (
    Number(
        "bench-4",
        "10_bench_measure",
        "how far, in rad, a first-order low pass of 2 Hz is behind a joint that turns at a steady 0.5 rad/s",
        _SPEED * _LAG,
        unit="rad",
        tolerance=2.6e-3,
        because="with half a sample or without",
        why="A PID behind this filter steers by where the joint was: that is why it swings.",
        mistakes={
            "That is the lag in seconds: how far does the joint turn in that time?": _LAG,
            "1/(2 Hz) is the period of the cut-off; the lag is 2 pi times shorter.": _SPEED / _CUTOFF,
            "That is one sample late; this filter averages over many.": _SPEED * 0.01,
        },
    ),
    Number(
        "bench-5",
        "11_bench_drive",
        "the largest error that breakaway can leave in joint 1 of the IR50P with Kp = 289 and no integral",
        _FS / (_K * _KP),
        unit="rad",
        tolerance=1e-3,
        why="Seven degrees, by friction alone: this is why lowering Kp1 leaves a large error.",
        mistakes={
            "That divides N m by PWM counts per rad: bring both to one unit with k.": _FS / _KP,
            "That is the Coulomb friction of a joint that moves; a joint at rest holds up to fs.": _FC / (_K * _KP),
            "Upside down: a larger Kp must leave a smaller error.": _K * _KP / _FS,
            "That is the breakaway in PWM counts; Kp says how many counts a radian gives.": _FS / _K,
        },
    ),
)
