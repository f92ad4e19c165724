"""The functions of `my_robot` in the order in which they are written, and where each is asked for."""

import importlib
from functools import cache

from ir50p_lab.errors import InputError

# DESIGN 6: every function, by the notebook that asks for it
NOTEBOOKS = {
    "00": ("rot_z",),
    "01": ("dh_matrix", "frames", "forward_kinematics"),
    "02": ("inverse_kinematics", "reach"),
    "03": ("jacobian", "damped_step"),
    "04": ("mass_matrix",),
    "05": ("velocity_torque", "gravity_torque"),
    "06": ("rk4_step", "integrate", "quintic"),
    "07": ("friction_torque", "motor_torque"),
    "08": ("PID",),
    "09": ("step_metrics",),
    "10": ("fit_line", "low_pass"),
    "12": ("regressor", "least_squares", "rls_step"),
    "13": ("fit_percent",),
    "14": ("computed_torque",),
    "15": ("adaptive_step",),
    "16": ("hue_mask", "circle_votes"),
    "17": ("homography", "pixel_to_plane"),
    "18": ("find_and_reach",),
}
ORDER = tuple(name for names in NOTEBOOKS.values() for name in names)
STAGES = {"PID": ("PID.p", "PID.pi", "PID.limits")}  # checked on the way; "PID" itself is the last
_MODULES = {  # what is written
    "00": "kinematics.functions.pose",
    "01": "kinematics.functions.pose",
    "02": "kinematics.functions.inverse",
    "03": "kinematics.functions.velocity",
    "08": "loops.functions.controller",
    "09": "loops.functions.tuning",
}


def function_of(name):
    """The function that a stage belongs to: "PID" of "PID.pi"; any other name is its own."""
    return name.partition(".")[0]


def notebook_of(name):
    """Number of the notebook that asks for a function, "02"."""
    return next(number for number, names in NOTEBOOKS.items() if function_of(name) in names)


def is_function(name):
    """Tell whether a name is a function of `my_robot`, or a stage of one."""
    return name in ORDER or name in STAGES.get(function_of(name), ())


def written():
    """Names of the functions that can be checked today."""
    return tuple(name for name in ORDER if notebook_of(name) in _MODULES)


@cache
def task(name):
    """The Task of a function of `my_robot`. Raises InputError where its notebook is still to come."""
    number = notebook_of(name)
    if number not in _MODULES:
        raise InputError(f"{name} is asked for in notebook {number}, which is still to come")
    module = importlib.import_module(f"ir50p_lab.course.{_MODULES[number]}")
    return next(one for one in module.TASKS if one.name == name)
