"""Exercises of notebook 09: steady-state error, the PID law, sampling, damping, a tuning rule."""

import numpy as np
from scipy.optimize import fsolve

from ir50p_lab.course.exercises import Exercise, Function, Number, Slip
from ir50p_lab.modelling import THESIS_A, gravity

NOTEBOOK = "09_break_it_tune_it"

# pid-1: what a spring of stiffness kp leaves under the weight of the thesis' arm.
_SET_POINT = np.array([np.pi / 2, np.pi / 2, -np.pi / 3])
_KP = np.array([50.0, 100.0, 50.0])  # N m/rad


def _remaining(kp):
    return fsolve(lambda e: kp * e - gravity(THESIS_A, _SET_POINT - e), np.zeros(3), xtol=1e-12)


_ERROR = _remaining(_KP)


# pid-2: the textbook PID (2.1) on samples.
def _pid(e, kp, ki, kd, T):
    e = np.asarray(e, dtype=float)
    return kp * e[-1] + ki * T * np.sum(e) + kd * (e[-1] - e[-2]) / T


def _integral_without_period(e, kp, ki, kd, T):
    return kp * e[-1] + ki * np.sum(e) + kd * (e[-1] - e[-2]) / T


def _slope_without_period(e, kp, ki, kd, T):
    return kp * e[-1] + ki * T * np.sum(e) + kd * (e[-1] - e[-2])


def _slope_backwards(e, kp, ki, kd, T):
    return kp * e[-1] + ki * T * np.sum(e) - kd * (e[-1] - e[-2]) / T


def _first_error(e, kp, ki, kd, T):
    return kp * e[0] + ki * T * np.sum(e) + kd * (e[1] - e[0]) / T


_CASES = [
    (np.array([0.5, 0.42, 0.3, 0.21]), 20.0, 8.0, 1.5, 0.02),
    (np.array([-0.1, 0.05, 0.12]), 3.0, 0.7, 0.2, 0.05),
    (np.array([0.2, 0.2]), 100.0, 50.0, 10.0, 0.01),
]

# pid-3: a damper that acts with a held command: v[k + 1] = (1 - kd T/M) v[k].
_M3, _KD3 = 0.25, 40.0  # kg m^2, N m s/rad

# pid-4: critical damping with the brake of the motor.
_M4, _D4, _KP4 = 0.2, 1.5, 20.0  # kg m^2, N m s/rad, N m/rad
_CRITICAL = 2 * np.sqrt(_M4 * _KP4)

# pid-5: SIMC for a speed.
_K, _T, _L, _TAU = 0.01, 0.2, 0.03, 0.06  # rad/s per count, s, s, s
_KP5 = _T / (_K * (_TAU + _L))

EXERCISES = (
    Exercise(
        "pid-1",
        "the three errors q_d - q that remain with Kp = (50, 100, 50) N m/rad on THESIS_A at the thesis' set point",
        Number(_ERROR, unit="rad", tolerance=2e-4, because="the error bends the arm: solve, do not take g at q_d"),
        why="Half the Kp leaves more than twice the error: the arm that sags has other weights to carry.",
        slips=(
            Slip(
                gravity(THESIS_A, _SET_POINT) / _KP,
                "That takes the weight at the set point; the arm rests lower, where its weight is another.",
            ),
            Slip(_remaining(np.array([25.0, 200.0, 200.0])), "Those are the errors of the thesis' own gains."),
            Slip(
                gravity(THESIS_A, np.zeros(3)) / _KP,
                "That takes the weight at q = 0; the arm rests near its set point.",
            ),
            Slip(_SET_POINT - _ERROR, "Those are the angles reached; the error is set point minus angle."),
        ),
    ),
    Exercise(
        "pid-2",
        "the PID command as a function of (e, kp, ki, kd, T): errors e, oldest first, every T seconds",
        Function(_pid, cases=_CASES, unit="", tolerance=1e-9, because="only rounding may differ"),
        why="These are the three lines that run on every bench of this course, a hundred times a second.",
        slips=(
            Slip(
                _integral_without_period,
                "The integral is a sum of areas e T; without T it depends on the sampling rate.",
            ),
            Slip(_slope_without_period, "The slope is the last difference over T; without T it is only a difference."),
            Slip(_slope_backwards, "Your D pushes along with the motion: look at the order of the two errors."),
            Slip(_first_error, "P and D look at the newest errors, which stand at the end of the array."),
        ),
    ),
    Exercise(
        "pid-3",
        "the longest stable period of M qdd = -Kd qd, held, for M = 0.25 kg m^2 and Kd = 40 N m s/rad",
        Number(2 * _M3 / _KD3, unit="s", tolerance=1e-4, because="a tenth of a millisecond is what you would type"),
        why="A stiffer damper needs a faster computer: the product Kd T has a limit, set by the inertia.",
        slips=(
            Slip(_M3 / _KD3, "At that period the speed is brought to zero in one sample: the best, not the longest."),
            Slip(2 * _KD3 / _M3, "Upside down: that is a frequency, in 1/s."),
            Slip(2000 * _M3 / _KD3, "That is in milliseconds; the question asks for seconds."),
            Slip(
                np.pi * _M3 / _KD3,
                "No circle is involved: look for the period at which the factor of one sample reaches -1.",
            ),
        ),
    ),
    Exercise(
        "pid-4",
        "the Kd of critical damping for M = 0.2 kg m^2, D = 1.5 N m s/rad and Kp = 20 N m/rad",
        Number(_CRITICAL - _D4, unit="N m s/rad", tolerance=5e-3, because="two decimals are what you would type"),
        why="The motor brakes for free; with a strong brake Kd may be left out altogether.",
        slips=(
            Slip(_CRITICAL, "The motor brakes already: its share has to be taken off."),
            Slip(_CRITICAL + _D4, "The motor's brake helps: it is taken off, not added."),
            Slip(_CRITICAL / 2 - _D4, "Critical is where both poles meet: b^2 = 4 M Kp for the damping b = D + Kd."),
            Slip(2 * np.sqrt(_KP4) - _D4, "The inertia is missing: (2 sqrt(Kp) holds for M = 1)."),
        ),
    ),
    Exercise(
        "pid-5",
        "(Kp, Ki) of the SIMC rule for PI with K = 0.01, T = 0.2 s, L = 0.03 s and tau_c = 0.06 s",
        Number(
            [_KP5, _KP5 / min(_T, 4 * (_TAU + _L))],
            tolerance=0.5,
            because="whole counts are what you would type",
        ),
        why="For a process this quick the integral time is its own time constant: the zero cancels the slow pole.",
        slips=(
            Slip([_KP5, _KP5 / (4 * (_TAU + _L))], "Ti is the smaller of the two: look at the minimum again."),
            Slip([_KP5, _KP5 * _T], "Ki is Kp over Ti: the integral works faster for a shorter Ti."),
            Slip([_T / (_K * _TAU)] * 2 / np.array([1, _T]), "The dead time is missing beside tau_c."),
            Slip([_KP5, _T], "The second number is Ki = Kp/Ti, not Ti."),
        ),
    ),
)
