"""The functions of `my_robot` in the order in which they are written, and where each is asked for."""

import importlib
from functools import cache
from pathlib import Path

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
_SUBJECTS = {  # the room of each notebook, where its functions stand
    "kinematics": ("00", "01", "02", "03"),
    "dynamics": ("04", "05"),
    "motion": ("06", "07"),
    "loops": ("08", "09"),
    "at_the_bench": ("10",),
    "fitting": ("12", "13"),
    "torque": ("14", "15"),
    "images": ("16",),
    "camera": ("17",),
    "reaching": ("18",),
}
_at = {}  # stage of each function that this session works on


def function_of(name):
    """The function that a stage belongs to: "PID" of "PID.pi"; any other name is its own."""
    return name.partition(".")[0]


def notebook_of(name):
    """Number of the notebook that asks for a function, "02"."""
    return next(number for number, names in NOTEBOOKS.items() if function_of(name) in names)


def is_function(name):
    """Tell whether a name is a function of `my_robot`, or a stage of one."""
    return name in ORDER or name in STAGES.get(function_of(name), ())


def subject_of(name):
    """Room of a function, "kinematics": its Task stands there in `functions/NAME.py`, its slips in `NAME.txt`."""
    return next(room for room, notebooks in _SUBJECTS.items() if notebook_of(name) in notebooks)


@cache
def is_written(name):
    """Tell whether a function can be checked today."""
    course = Path(__file__).parents[1]
    return (course / subject_of(name) / "functions" / f"{function_of(name)}.py").exists()


def written():
    """Names of the functions that can be checked today."""
    return tuple(filter(is_written, ORDER))


@cache
def task(name):
    """The Task of a function of `my_robot`, or of a stage of one. Raises InputError where it is still to come."""
    if not is_written(name):
        raise InputError(f"{name} is asked for in notebook {notebook_of(name)}, which is still to come")
    room = f"ir50p_lab.course.{subject_of(name)}.functions"
    module = importlib.import_module(f"{room}.{function_of(name)}")
    return module.STAGES[name] if "." in name else module.TASK


def work_on(name):
    """Take up a function at a stage: this session uses that stage from now on, all others the whole. Returns its Task.

    Raises InputError where it is still to come.
    """
    found = task(name)
    _at[function_of(name)] = name
    return found


def at_work(name):
    """The stage of a function that this session works on, or the function itself."""
    return _at.get(name, name)


def forget():
    """Work on nothing, as in a session that has just begun."""
    _at.clear()
