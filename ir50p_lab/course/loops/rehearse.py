"""Before a controller of the student's goes to a real arm, it drives the simulated one, where everybody can see it."""

import warnings

import numpy as np

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.errors import InputError, LabError, UnstableLoopWarning
from ir50p_lab.modelling.named_arms import load_arm
from ir50p_lab.simulation import simulate

_SECONDS = 10.0


class RehearsalError(LabError):
    """The controller leaves the joint limits within ten seconds on the simulated arm: it does not go to a real one."""


def rehearse(controller, reference, *, arm=None, show=True, **view):
    """Run ten seconds on the simulated arm, from its rest pose, and show them; then return the same controller.

        with connect() as bench:
            bench.start(rehearse(pid, target), target)

    Args: controller: any object with `step`; reference: as for `simulate`. arm: Arm (default: that of the course).
    show: False shows nothing; view: options of LiveArm, such as `ball`.
    Returns: the controller, reset if that is possible. Raises RehearsalError, naming joint, time and angle, if a joint
    would leave its limits.
    """
    arm = load_arm() if arm is None else arm
    start, unit = rest_pose(arm), getattr(controller, "unit", "PWM")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnstableLoopWarning)  # one that swings within the limits is shown
        try:
            run = simulate(arm, controller, reference, duration=_SECONDS, q0=start, unit=unit)
        except InputError as error:
            raise RehearsalError(f"not for an arm: {error}") from None
    low, high = np.minimum(arm.q_min, start), np.maximum(arm.q_max, start)
    outside = (run.q < low - 0.01) | (run.q > high + 0.01)
    if show:
        from IPython.display import display

        from ir50p_lab.course.live_arm import LiveArm

        display(LiveArm(arm, badge="rehearsal, simulated", **view).play(run))
    if outside.any():
        k, joint = np.argwhere(outside)[0]
        raise RehearsalError(
            f"after {run.t[k]:.2f} s joint {joint + 1} would stand at {run.q[k, joint]:.2f} rad, outside "
            f"{low[joint]:.2f} to {high[joint]:.2f} rad: change gains or reference before it goes to an arm"
        )
    if hasattr(controller, "reset"):
        controller.reset()
    return controller
