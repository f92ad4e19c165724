"""Notebook 13: runs of a bare arm, motions of waves, arms that lack a fault, and the contest of motions."""

from dataclasses import replace

import numpy as np

from ir50p_lab.bench import ArmInstance, SimulatedBench, rest_pose
from ir50p_lab.course import my_robot
from ir50p_lab.course.draw.style import COLOURS, new_figure
from ir50p_lab.course.fitting.own_model import columns, fit_rows
from ir50p_lab.course.fitting.views import kept_motion
from ir50p_lab.course.lab_book.results import arm_at_rest
from ir50p_lab.errors import UnreachableError
from ir50p_lab.signals import fourier, quintic

_UNSEEN, _JUDGES = (101, 102), (2, 3, 4)  # seeds of the contest's arms; kept motions that judge


def follow(arm, controller, reference, seconds):
    """Move from rest to the beginning of a reference, then follow it for so many seconds, which are recorded.

    Returns: Recording.
    """
    to_its_beginning = quintic(rest_pose(arm), np.array(reference(0.0)[0]), duration=4)
    with arm_at_rest(arm, "calibration") as bench:
        bench.follow(controller, to_its_beginning, 5, record=False)
        return bench.follow(controller, reference, seconds)


def simulated(arm, controller, reference, seconds, **bench):
    """Do the same on a simulated arm, from the beginning of the reference: a Recording, not kept on disk."""
    bench = SimulatedBench(arm, q0=reference(0.0)[0], record_to=False, **bench).open()
    return bench.follow(controller, reference, seconds)


def waves(arm, x):
    """Return a motion of 110 s, or None if it leaves the limits.

    x: a table (3, 11): middle poses, five a and five b (4.2).

    Joints keep 0.2 rad from their limits and below 0.8 of the speed of their motors; elbow and tip stay 0.1 m above the
    table.
    """
    room = {"arm": arm, "max_joint_speed": 0.8 * np.array(arm.actuators.no_load_speed), "table": 0.1, "margin": 0.2}
    try:
        return fourier(x[:, 1:6], x[:, 6:], period=10, periods=11, q0=x[:, 0], ends="adjust", **room)
    except UnreachableError:
        return None


def contest_score(arm, controller, motion):
    """Return the fit of the worst joint, in percent, on three unseen motions, for the worse of two arms.

    The model is made from 60 s of `motion`.
    """
    worst = []
    for seed in _UNSEEN:
        theta, _ = fit_rows(*columns(simulated(arm, controller, motion, 60, seed=seed)))
        for number in _JUDGES:
            Y, u, _ = columns(simulated(arm, controller, kept_motion(arm, number), 30, seed=seed))
            worst += [my_robot.fit_percent(u[:, j], Y[:, j] @ theta[j]) for j in range(3)]
    return min(worst)


def suspects(arm, controller):
    """Return recordings of simulated arms that have all faults, or lack one.

    Returns: {name: (Recording to learn from, Recording to judge by)}.
    """
    none, like_ours = (0, 0, 0), ArmInstance(spread=0)
    smooth = replace(arm, friction=replace(arm.friction, fs=arm.friction.fc))
    cases = {
        "all faults": (arm, like_ours),
        "no Stribeck": (smooth, like_ours),
        "no hysteresis": (arm, ArmInstance(spread=0, backlash=none, dead_zone=none, pot_bow=none)),
        "no noise": (arm, ArmInstance(spread=0, noise=0)),
    }
    motions = (kept_motion(arm, 0), 110), (kept_motion(arm, 1), 60)
    return {
        name: tuple(simulated(one, controller, motion, seconds, unit=unit) for motion, seconds in motions)
        for name, (one, unit) in cases.items()
    }


def validation_figure(u, predicted, span):
    """Draw measured and predicted pushes (n, 3) of the joints over a span of samples (Figure 4.11).

    Returns: LabFigure.
    """
    figure, here = new_figure(9.6, 5.0, rows=3, sharex=True), slice(*span)
    t = 0.01 * np.arange(len(u))[here]
    for joint, ax in enumerate(figure.axes):
        ax.plot(t, u[here, joint], ".", ms=2.5, color=COLOURS["grey"], label="measured")
        ax.plot(t, predicted[here, joint], color=COLOURS["blue"], lw=1.6, label="predicted")
        ax.set(ylim=(-275, 275), ylabel=f"joint {joint + 1} [PWM]")
    figure.axes[0].legend(fontsize=8, ncols=2, loc="lower left")
    figure.axes[2].set_xlabel("time [s]")
    return figure
