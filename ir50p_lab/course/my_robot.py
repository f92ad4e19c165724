"""my_robot: every function is the student's own if there is one; otherwise the course's stands in.

    from ir50p_lab.course import my_robot
    my_robot.rot_z(0.5)

A name is looked up each time: a function that was just written, in this notebook or another, is used from then on.
A class that is written in stages serves at its stage in the notebook that works on it, and elsewhere once it is whole.
`my_robot.whose("rot_z")` says whose it is: "yours", "on loan" or "the course's".
"""

from time import monotonic

from ir50p_lab import home
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.robot import student_package
from ir50p_lab.course.robot.catalogue import ORDER, at_work, is_function

_FRESH = 0.1  # s: for so long a function that was looked up is used without looking at its file again
_said = set()


def __getattr__(name):
    function, until, *where = student_package.lookup_cache.get(name, (None, 0.0))
    if monotonic() < until and where == [at_work(name), home.setting(home.VARIABLE)]:
        return function
    if not is_function(name):
        raise AttributeError(f"my_robot has no {name}; its functions are {', '.join(ORDER)}")
    stage = at_work(name)
    function = student_package.load(name) if student_package.is_there(stage) else task(stage).reference
    _say(name)
    student_package.lookup_cache[name] = function, monotonic() + _FRESH, stage, home.setting(home.VARIABLE)
    return function


def whose(name):
    """Return whose function is used: "yours", "on loan" or "the course's"."""
    return student_package.whose(at_work(name))


def done():
    """Return the names of the functions that are the student's own, in order."""
    return tuple(name for name in ORDER if whose(name) == "yours")


def progress():
    """Return a LabFigure of the robot with its parts, coloured by whose they are."""
    from ir50p_lab.course.robot.robot_view import owned  # matplotlib takes a while: not at import

    return owned({name: whose(name) for name in ORDER})


def _say(name):
    """Say once in a session, and again when it changes, whose function is in use."""
    if (name, whose(name)) not in _said:
        _said.add((name, whose(name)))
        more = {"on loan": " from the course", "the course's": ", until you write yours"}
        print(f"my_robot.{name}: {whose(name)}{more.get(whose(name), '')}")


def __dir__():
    return [*ORDER, "done", "progress", "whose"]
