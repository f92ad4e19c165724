"""What notebook 11 draws and breaks: the circle of the tip, and faults that are made on purpose."""

import time
from dataclasses import replace

import numpy as np

from ir50p_lab.bench import UNIT, SimulatedBench, connect
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course import my_robot
from ir50p_lab.course.draw.style import JOINTS, SETPOINT, origin, subplots
from ir50p_lab.course.lab_book.results import arm_at_rest, arm_that_answers
from ir50p_lab.errors import BenchError, BoardLostError
from ir50p_lab.modelling.named_arms import load_arm


def go(controller, reference, seconds):
    """Run the loop of notebook 08 on a real arm with the student's calibration. Returns: Recording."""
    with arm_at_rest(load_arm(), "calibration") as bench:
        return bench.follow(controller, reference, seconds)


_STARTS = 0.5 + 1.2 * np.arange(8)  # s, of the pushes


def eight_pushes(bench):
    """Push the waist eight times with 200 counts, 0.4 s each, to and fro, whatever the angles. Returns: Recording."""
    for sample in bench.run(seconds=10.1, note="first motion"):
        since = sample.t - _STARTS
        now = np.flatnonzero((since > -0.001) & (since < 0.399))  # which push, if any
        bench.drive([200 * (-1) ** now[0] if now.size else 0, 0, 0])
    return bench.recording


def mean_push(first_motion):
    """Return how the waist moves when pushed: s since the push (50,), mean turn after `eight_pushes` (50,) rad."""
    rows = np.searchsorted(first_motion.t, _STARTS - 0.001)
    waist, push = first_motion.q[:, 0], first_motion.u[:, 0]
    moves = [np.sign(push[k]) * (waist[k - 10 : k + 40] - np.mean(waist[k - 40 : k])) for k in rows]
    return 0.01 * np.arange(-10, 40), np.mean(moves, axis=0)


def three_parts(centre, tip, wanted):
    """Return how far tips (n, 3) m are off a level circle, (n, 3) mm: outwards, behind, upwards."""
    out = (wanted - centre) / np.linalg.norm(wanted - centre, axis=1, keepdims=True)
    left = np.cross([0, 0, 1], out)
    sense = np.sign(np.sum(left[:-1] * np.diff(wanted, axis=0)))  # which way round it goes
    off = 1000 * (tip - wanted)
    return np.column_stack([np.sum(off * out, axis=1), -sense * np.sum(off * left, axis=1), off[:, 2]])


class Filtered:
    """A controller behind the student's low pass of notebook 10, which filters the potentiometers sample by sample."""

    def __init__(self, controller, cutoff_hz):
        self.controller = controller
        self._share = my_robot.low_pass(np.array([0.0, 1.0]), cutoff_hz, 100)[1]  # of a jump, after one sample

    def reset(self):
        """Forget the run before."""
        self._seen = None
        self.controller.reset()

    def step(self, t, q, reference):
        """Return the controller's pushes for filtered angles."""
        self._seen = q if self._seen is None else self._seen + self._share * (q - self._seen)
        return self.controller.step(t, self._seen, reference)


def circle_figure(centre, radius, recording, wanted, **tips):
    """Draw the path of the tip from above, its height, and how far behind it is. Returns: LabFigure.

    Args: wanted: (n, 3) m, places of the tip at the end of the recording's t; tips: label -> (n, 3) m.
    """
    figure, above, height, behind = subplots(9.6, 3.6, cols=3, note=origin(recording))
    turned = np.linspace(0, 2 * np.pi, 200)
    above.plot(centre[0] + radius * np.cos(turned), centre[1] + radius * np.sin(turned), label="wanted", **SETPOINT)
    height.axhline(centre[2], **SETPOINT)
    behind.axhline(0, **SETPOINT)
    for (label, tip), colour in zip(tips.items(), JOINTS, strict=False):
        t = recording.t[-len(tip) :]
        above.plot(*tip[:, :2].T, color=colour, lw=1.2, label=label)
        height.plot(t, tip[:, 2], color=colour, lw=1.2)
        behind.plot(t, three_parts(centre, tip, wanted)[:, 1], color=colour, lw=1.2)
    above.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", title="From above")
    height.set(xlabel="time [s]", ylabel="height [m]", title="How high")
    behind.set(xlabel="time [s]", ylabel="behind [mm]", title="How far behind")
    above.legend(fontsize=8)
    return figure


def run_simulated(arm, controller, reference, seconds, *, late=0.02, **options):
    """Run the loop of the lesson on a simulated arm, as fast as it can; nothing is kept on disk.

    late: s from sample to action, in whole samples; options: of SimulatedBench.
    Returns: the SimulatedBench, with recording and truth; it starts from the rest pose.
    """
    # no guard: of an arm that is calculated one may ask for too much
    unit = replace(UNIT, delay=int(late / 0.01))
    bench = SimulatedBench(arm, **{"unit": unit, "q0": rest_pose(arm), "record_to": False} | options).open()
    bench.guarded = False
    controller.reset()
    for sample in bench.run(seconds, reference):
        bench.drive(controller.step(sample.t, sample.q, sample.reference))
    return bench


def bench_for_faults(fault, **options):
    """Return an open bench on which `fault` may be made: simulated, unless the lab's own file allows it here."""
    bench = arm_that_answers(**options)
    try:
        bench.caps.check_fault(fault)
    except BenchError as error:
        bench.abort()
        print(f"Broken on the simulated arm: {error}")
        bench = connect("simulated", **options)
    return bench


def cause_fault(fault, bench):
    """Make a fault at joint 1 of a simulated arm, or stop this process for 0.7 s; a real arm needs a hand."""
    plant = getattr(bench, "plant", None)
    if fault == "process":
        time.sleep(0.7)
    elif plant is None:
        print(f"Now, by hand: {fault}")
    elif fault == "motor":
        advance = plant.advance
        plant.advance = lambda pwm, seconds: advance(np.array([-1, 1, 1]) * pwm, seconds)
    elif fault == "potentiometer":
        counts = plant.counts
        plant.counts = lambda: np.array([1023.0, *counts()[1:]])
    else:
        bench.measure = lambda cycle, drive: _cable_pulled(bench)


def _cable_pulled(bench):
    """A pulled cable: the board hears nothing more, and cuts the drive by itself after 0.1 s."""
    bench.plant.advance(bench.command, 0.1)
    raise BoardLostError(
        "the board is gone: it brakes by itself 0.1 s after the last command, then gravity has the arm"
    )


def after_fault(bench, fault_at=1.0):
    """Return s from the fault to the end of the run, degrees the waist turned meanwhile, mm the tip has sunk since.

    For a simulated arm they are the truth; for a real one they are measured, and how far it sank is not known (nan).
    """
    known = getattr(bench, "truth", bench.recording)
    waist = known.q[known.t >= fault_at - 1e-9, 0]
    fallen = np.nan
    if hasattr(bench, "plant"):
        fallen = 1000 * (my_robot.forward_kinematics(known.q[-1], bench.arm.l) - bench.plant.tip_true)[2]
    return known.t[-1] - fault_at, float(np.degrees(np.abs(waist - waist[0]).max())), fallen
