"""Notebook 12: an arm with a gripper that nobody has weighed, driven by the loop of 08; what its pushes look like."""

import numpy as np

from ir50p_lab.bench import SimulatedBench, rest_pose
from ir50p_lab.controllers import PID
from ir50p_lab.course import my_robot
from ir50p_lab.course.draw.style import COLOURS, subplots
from ir50p_lab.course.fitting.views import kept_motion
from ir50p_lab.course.lab_book.results import arm_at_rest
from ir50p_lab.signals import fourier


def with_gripper(arm):
    """Return the arm with a gripper.

    A simulated one weighs 0.3 kg, which the student does not know; on a real arm it is screwed on.
    """
    return arm.with_payload(0.3)


def go(gripped, controller, reference, seconds):
    """Run the loop of 08, from the rest pose, on the arm that answers, with its gripper. Returns: Recording."""
    from tqdm.auto import tqdm

    with arm_at_rest(gripped, "calibration") as bench:
        controller.reset()
        samples = bench.run(seconds=seconds, reference=reference)
        for sample in tqdm(samples, total=round(100 * seconds), leave=False, disable=seconds < 30):
            bench.drive(controller.step(sample.t, sample.q, sample.reference))
    return bench.recording


def motions(arm):
    """Return two motions of many waves, slow enough for an arm with a gripper, as pairs (reference, seconds).

    Each takes four seconds to the first pose and waits for one; then come the waves.
    """
    made = []
    for number, periods in ((1, 5), (2, 2)):
        kept = kept_motion(arm, number)
        waves = fourier(kept.a, kept.b, period=22, periods=periods, q0=kept.q0)
        made.append((_from_rest(arm, waves), 5 + 22 * periods))
    return made


def _from_rest(arm, waves):
    rest, begin = rest_pose(arm), np.array(waves.q_start)
    return lambda t: my_robot.quintic(rest, begin, 4, t) if t < 5 else waves(t - 5)


def bare_run(arm, controller):
    """Return the first minute of the first motion without the gripper, simulated: a Recording."""
    with SimulatedBench(arm, q0=rest_pose(arm), record_to=False) as bench:
        return bench.follow(controller, motions(arm)[0][0], 60)


def gripper_run(arm):
    """Return 110 s of the first motion with the gripper on, on the simulated arm: a Recording."""
    motion, seconds = motions(arm)[0]
    with SimulatedBench(with_gripper(arm), q0=rest_pose(arm), record_to=False) as bench:
        return bench.follow(PID(1000, 1000, 40, limit_pwm=255), motion, seconds).between(5, seconds)


def true_theta(arm, recording):
    """Return theta (3, 20) of an arm's simulated copy, its friction as drawn; None if the recording is real."""
    return copy_theta(arm) if recording.simulated else None


def copy_theta(arm):
    """Return the true theta (3, 20) of the simulated copy of an arm, in its own counts."""
    gain = SimulatedBench(arm, record_to=False).plant.unit.motor_gain
    return arm.theta_pwm / np.broadcast_to(gain, 3)[:, None]


def loop_figure(q, u):
    """Draw the push (n,) counts of the elbow over its angle (n,) rad. Returns: LabFigure."""
    figure, ax = subplots(6.4, 3.4)
    ax.plot(q, u, ".", ms=2, color=COLOURS["blue"])
    ax.set(xlabel="angle of the elbow [rad]", ylabel="push [PWM counts]", title="Above: upwards; below: downwards")
    return figure
