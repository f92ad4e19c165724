"""Pictures of the contest: a practice run under sliders, and all attempts next to the tuning rules."""

import numpy as np

from ir50p_lab.controllers import PID
from ir50p_lab.course import lab_book
from ir50p_lab.course.draw.style import COLOURS, JOINTS, SETPOINT, new_figure, subplots
from ir50p_lab.course.draw.widgets import slider
from ir50p_lab.course.loops import contest_rules as contest
from ir50p_lab.errors import LabError

_SLIDERS = {"kp": (2000, 10), "ki": (3000, 10), "kd": (60, 0.5)}  # right end, step
_TOP = 100.0  # a score above it stands there: that of a drive that was cut is infinite
_MARKERS = dict(zip(contest.LIMITS, "osv^D", strict=True))


class Practice:
    """Angles and commands of a run on the first practice arm, in three columns; `show(run)` draws it.

    Args: arm: Arm. Attributes: figure; recording, that of the last run.
    """

    def __init__(self, arm):
        self.figure = new_figure(9.6, 4.2, rows=2, cols=3, sharex=True)
        given = contest.draw(arm, contest.PRACTICE[0])
        t = np.append(contest.TIMES, contest.END)
        self._q, self._u = [], []
        for joint, colour in enumerate(JOINTS):
            above, below = self.figure.axes[joint], self.figure.axes[3 + joint]
            target = np.append(given.poses[:, joint], given.poses[-1, joint])
            above.plot(t, target, drawstyle="steps-post", label="target", **SETPOINT)
            above.axvspan(0, contest.TIMES[1], color=COLOURS["light"], label="not judged")
            room = 0.35 + 0.3 * np.ptp(target)
            above.set(xlim=(0, contest.END), ylim=(target.min() - room, target.max() + room))
            above.set_title(f"joint {joint + 1}")
            below.set(ylim=(-275, 275), xlabel="time [s]")
            self._q += above.plot([], [], color=colour, label="true angle")
            self._u += below.plot([], [], color=colour, linewidth=0.6, antialiased=False)
        self.figure.axes[0].set_ylabel("angle [rad]")
        self.figure.axes[3].set_ylabel("command [PWM]")
        self.figure.axes[0].legend(fontsize=7, loc="best")

    def show(self, run):
        """Draw what `contest.drive` has returned."""
        _, self.recording, q = run
        for joint in range(3):
            self._q[joint].set_data(self.recording.t, q[:, joint])
            self._u[joint].set_data(self.recording.t, self.recording.u[:, joint])


def gain_sliders(gains):
    """Return nine sliders kp1 to kd3 for `live`; they begin at gains (3, 3), rows kp, ki, kd, columns joints."""
    made = {}
    for (part, (end, step)), row in zip(_SLIDERS.items(), gains, strict=True):
        for joint, gain in enumerate(row, start=1):
            start = min(step * round(gain / step), end)
            made[f"{part}{joint}"] = slider(0, end, step, start, label=f"K{part[1]}{joint}")
    return made


def sliders_of(controller, arm, practice):
    """Return (update, words): the callback of a panel's sliders, and a sentence that says whose controller they move.

    The picture is that of one arm, the score that of all practice arms.
    If the compiled twin sends the same commands as the student's class, the twin runs; else the student's Python.
    """
    compiled = contest.twin_of(controller, arm) is not None

    def update(**values):
        gains = {part: [values[f"{part}{joint}"] for joint in (1, 2, 3)] for part in ("kp", "ki", "kd")}
        pid = PID(**gains, limit_pwm=255) if compiled else controller
        if not compiled:
            for part, value in gains.items():
                setattr(controller, part, np.array(value, dtype=float))
        try:
            shown = contest.drive(pid, contest.PRACTICE[0], arm)
        except LabError as cut:
            return f"the bench cut the drive: {cut}"
        practice.show(shown)

        def scored():
            try:
                runs = [shown, *(contest.drive(pid, seed, arm) for seed in contest.PRACTICE[1:])]
            except LabError as cut:
                return f"the bench cut the drive: {cut}"
            found = contest.score_of(runs)
            term, joint = found.decides
            sets = (f"({', '.join(f'{x:g}' for x in row)})" for row in gains.values())
            said = f"score on all three practice arms {found.value:.2f}: {term} of joint {joint} decides"
            return f"{said}\nkp, ki, kd = {', '.join(sets)}"

        return scored

    if compiled:
        return (
            update,
            "the sliders set the gains; the compiled PID runs, it sent the same commands as the class in Python",
        )
    return (
        update,
        "the sliders set the gains; the class in Python runs: the compiled PID is another law (not a better one)",
    )


def history(rules=None):
    """Draw all attempts, the best so far as a line, and next to them lines for rules, {name: Score}.

    Returns: LabFigure.
    """
    attempts = lab_book.read()["contest"]
    figure, ax = subplots(9.0, 3.6)
    ax.axhspan(0.1, 1, color="#E5F3EC")
    ax.axhline(1.0, **SETPOINT, label="below: won")
    values = np.minimum([one["score"] for one in attempts], _TOP)
    number = np.arange(1, len(values) + 1)
    if len(values):
        ax.step(number, np.minimum.accumulate(values), where="post", color=COLOURS["dark"], label="the best so far")
    for name, marker in _MARKERS.items():
        mine = [k for k, one in enumerate(attempts) if one["decides"][0] == name and values[k] < _TOP]
        if mine:
            ax.plot(number[mine], values[mine], marker, ms=7, color=COLOURS["blue"], label=f"{name} decided")
    if (values == _TOP).any():
        ax.plot(number[values == _TOP], values[values == _TOP], "x", color=COLOURS["dark"], label="the drive was cut")
    for (name, found), colour in zip((rules or {}).items(), ("orange", "purple", "amber", "sky"), strict=False):
        ax.axhline(min(found.value, _TOP), color=COLOURS[colour], linestyle="-.", label=name)
    top = max([2.0, *values, *(min(found.value, _TOP) for found in (rules or {}).values())])
    ax.set(yscale="log", ylim=(0.4, 1.5 * top), xlim=(0.5, max(len(values), 5) + 0.5))
    ax.set(xlabel="attempt", ylabel="score", title="The worst term over its limit, attempt by attempt")
    ax.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure
