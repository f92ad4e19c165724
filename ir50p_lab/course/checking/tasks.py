"""The Task of a function, found by its name in the room of its subject."""

import importlib
from functools import cache

from ir50p_lab.course.robot.catalogue import IN_NOTEBOOK, ROOMS, function_of


@cache
def task(name):
    """Return the Task of a function of `my_robot`, or of a stage of one."""
    function = function_of(name)
    module = importlib.import_module(f"ir50p_lab.course.{ROOMS[function]}.functions.{function}")
    return module.STAGES[name] if "." in name else module.TASK


def of_notebook(name):
    """Return the Task of a function that stays in its notebook."""
    return importlib.import_module(f"ir50p_lab.course.{IN_NOTEBOOK[name]}.notebook_functions").TASKS[name]
