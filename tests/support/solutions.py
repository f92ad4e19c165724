"""The reference solutions of tests/solutions, one file a function, loaded into one namespace as a student's would be."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from ir50p_lab.course.checking.tasks import task

FOLDER = Path(__file__).parents[1] / "solutions"
ORDER = (
    "rot_z dh_matrix frames forward_kinematics inverse_kinematics reach jacobian damped_step mass_matrix "
    "gravity_torque velocity_torque rk4_step integrate quintic friction_torque motor_torque PID step_metrics fit_line "
    "low_pass least_squares regressor rls_step fit_percent computed_torque adaptive_step hue_mask circle_votes "
    "homography pixel_to_plane find_and_reach"
).split()


def source(name):
    """The text of one solution; of a stage on the way to one, the course's."""
    if "." in name:
        return task(name).solution_text
    return (FOLDER / f"{name}.py").read_text(encoding="utf-8")


def load():
    """All solutions, each with NumPy, math and those before it."""
    names = {"np": np, "math": math}
    for name in ORDER:
        exec(compile(source(name), f"{name}.py", "exec"), names)
    return SimpleNamespace(**{name: names[name] for name in ORDER})
