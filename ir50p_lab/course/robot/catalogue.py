"""The functions of `my_robot` in the order in which they are written, and where each is asked for."""

_TABLE = """
00 kinematics    rot_z
01 kinematics    dh_matrix frames forward_kinematics
02 kinematics    inverse_kinematics reach
03 kinematics    jacobian damped_step
04 dynamics      mass_matrix
05 dynamics      gravity_torque velocity_torque
06 motion        rk4_step integrate quintic
07 motion        friction_torque motor_torque
08 loops         PID
09 loops         step_metrics
10 at_the_bench  fit_line low_pass
12 fitting       least_squares regressor rls_step
13 fitting       fit_percent
14 torque        computed_torque
15 torque        adaptive_step
16 images        hue_mask circle_votes
17 camera        homography pixel_to_plane
18 reaching      find_and_reach
"""  # every function: the notebook that asks for it, and the room in which it stands
_ROWS = [line.split() for line in _TABLE.strip().splitlines()]
NOTEBOOKS = {number: tuple(names) for number, _, *names in _ROWS}
ROOMS = {name: room for _, room, *names in _ROWS for name in names}
ORDER = tuple(ROOMS)
STAGES = {"PID": ("PID.p", "PID.pi", "PID.limits")}  # checked on the way; "PID" itself is the last
IN_NOTEBOOK = {  # functions that stay in their notebook, and the room in which the course's stand
    **dict.fromkeys(("along", "pace", "push"), "kinematics"),
    **dict.fromkeys(("centres", "heaviness", "shoulder_holds", "lump_torque", "torque", "acceleration"), "dynamics"),
    **dict.fromkeys(("falling", "halve", "slide", "motor_factors", "counts_for"), "motion"),
    "rule": "loops",
    **dict.fromkeys(("circle", "motor_law", "once_round"), "at_the_bench"),
    **dict.fromkeys(("carry", "cancel", "model", "pushes", "into", "planned"), "torque"),
    "nearest": "reaching",
    "best_circle": "images",
    **dict.fromkeys(("both_ways", "acted", "fit_joint", "most_counts", "when_it_acts", "camera_at"), "unknown"),
}
_at = {}  # stage of each function that this session works on


def function_of(name):
    """Return the function to which a stage belongs, "PID" for "PID.pi"; any other name is its own."""
    return name.partition(".")[0]


def notebook_of(name):
    """Return the number of the notebook that asks for a function, such as "02"."""
    return next(number for number, names in NOTEBOOKS.items() if function_of(name) in names)


def is_function(name):
    """Return True if a name is a function of `my_robot`, or a stage of one."""
    return name in ORDER or name in STAGES.get(function_of(name), ())


def stays(name):
    """Return True if a name is that of a function that stays in its notebook."""
    return name in IN_NOTEBOOK


def work_at(name):
    """Take up a function at a stage: this session uses that stage from now on, and the whole of all others."""
    _at[function_of(name)] = name


def at_work(name):
    """Return the stage of a function on which this session works, or the function itself."""
    return _at.get(name, name)
