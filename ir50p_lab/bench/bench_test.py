"""`python3 -m ir50p_lab bench-test`: the first power-on, joint by joint, with small drives; writes what it found.

Steps: noise at rest; each potentiometer turned by hand from end to end; each joint pushed by a drive that rises until
it moves, first away from the nearer end, then back; the board's watchdog. A joint whose potentiometer is not right is
not driven. The person at the bench is asked before each step; behind the simulated arm stands a simulated person.
"""

import argparse
import contextlib
import datetime
import json
from collections import namedtuple

import numpy as np

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.errors import BenchError, InputError, RunawayError
from ir50p_lab.home import home, replace_text

STEP_PWM, STEP_CYCLES = 3, 5  # the drive rises by 3 counts every five samples
STEPS = 50  # to 150 counts at most
MOVED = 8.0  # counts a joint must move to have moved: 40 to 65 mrad
STEADY = 3.0  # counts rms at rest
JUMP = 40.0  # counts from one sample to the next: no hand turns so fast, only a gap in the track does
TRAVEL = 100.0  # counts that a joint turned from end to end must change at least
SILENCE = 0.3  # s without a command; the board cuts after 0.1 s, the run goes on until 0.5 s
UP = ("counter-clockwise seen from above", "up", "up")


class Finding(namedtuple("Finding", "step joint passed text values")):
    """What a step found. joint: 1 to 3, 0: all; passed: bool; text: a sentence; values: numbers by name."""


class Person:
    """Whoever stands at the bench: is told what to do next, and presses Enter.

    plant: a SimulatedArm, whose joints a simulated person turns and which it lays down. turn: s that takes.
    """

    def __init__(self, plant=None):
        self._plant, self.turn = plant, 20.0 if plant is None else 2.0

    def ask(self, text):
        """Wait until the person has done what `text` says."""
        if self._plant is None:
            input(f"{text}. Then press Enter. ")
        else:
            print(f"{text}: done by the simulated person")

    def at(self, joint, share):
        """Simulated, at the share 0..1 of the time: `joint` (0 to 2) to its upper end, its lower end, and back."""
        if self._plant is not None:
            q, arm = rest_pose(self._plant.arm).copy(), self._plant.arm
            low, high = np.clip((arm.q_min[joint], arm.q_max[joint]), -np.pi, np.pi)
            q[joint] = np.interp(share, [0, 0.25, 0.75, 1], [q[joint], high, low, q[joint]])
            with contextlib.suppress(InputError):  # the table stops the hand, too
                self._plant.place(q)

    def lay_down(self):
        """Wait until the arm lies where it stays without drive."""
        self.ask("Lay the arm down so that it stays by itself, something soft under it")
        if self._plant is not None:
            self._plant.place(rest_pose(self._plant.arm))


def bench_test(bench, person, *, joints=(1, 2, 3), say=print):
    """Test these joints of an open bench; its drive is cut at the end. Returns the Findings, in order.

    A step returns a sentence and its numbers, or ends in a BenchError: what is wrong, a broken wire, a runaway...
    """
    findings = []

    def found(step, joint, action, *arguments):
        try:
            finding = Finding(step, joint, True, *action(*arguments))
        except BenchError as error:
            finding = Finding(step, joint, False, str(error), {})
        findings.append(finding)
        say(f"{'ok    ' if finding.passed else 'WRONG '} {step}: {finding.text}")
        return finding

    try:
        person.ask("Motor supply off")
        person.lay_down()
        found("noise", 0, _noise, bench)
        sound, driven = {}, {}
        for joint in joints:
            person.ask(
                f"During the next {person.turn:.0f} s turn joint {joint} by hand: {UP[joint - 1]} to its end, slowly "
                "to the other end, and back. Nothing else may move"
            )
            sound[joint] = found("potentiometer", joint, _potentiometer, bench, person, joint - 1).passed
        person.lay_down()
        person.ask("Motor supply on, limit at 1 A, a hand on the emergency stop")
        for joint in joints:
            driven[joint] = found("drive", joint, _drive, bench, joint - 1, sound[joint])
        if 1 in driven and driven[1].passed and not bench.simulated:  # a simulated arm has no board
            found("watchdog", 1, _watchdog, bench, driven[1].values)
    finally:
        bench.cut()
    return findings


def _require(right, text):
    if not right:
        raise BenchError(text)


def _rest(bench, seconds=1.0):
    """Counts (n, 3) of a run without drive."""
    counts = [sample.counts for sample in bench.run(seconds, record=False)]
    return np.array(counts, dtype=float)


def _noise(bench):
    counts = _rest(bench)
    rms = counts.std(axis=0)
    worst, text = rms.argmax(), f"{rms.round(2).tolist()} counts rms at rest"
    remedy = f"; joint {worst + 1} is not steady: look at the grounds and the 100 nF, and that nothing moves"
    _require(rms[worst] <= STEADY, text + remedy)
    return text, {"noise_counts": rms.round(3).tolist(), "counts_at_rest": counts.mean(axis=0).round(2).tolist()}


def _potentiometer(bench, person, joint):
    counts = []
    bench.guarded = False  # a hand may turn a joint faster than its motor
    try:
        for sample in bench.run(person.turn, record=False):
            counts.append(sample.counts)
            person.at(joint, sample.t / person.turn)
    finally:
        bench.guarded = True
    counts = np.array(counts, dtype=float)
    own, span, name = counts[:, joint], np.ptp(counts, axis=0), f"joint {joint + 1}"
    low, high, other = own.min(), own.max(), span.argmax()
    middle = own[len(own) // 10 : -len(own) // 7]  # it may have begun, and may end, at one of the ends
    reads, shaft = f"{name} reads {low:.0f} to {high:.0f}", "turn its potentiometer's shaft"
    for right, wrong in (
        (span[other] >= TRAVEL, f"no number changed much: is the potentiometer coupled to {name}, with 5 V?"),
        (other == joint, f"{name} moved the number of joint {other + 1}: swap the wires at A{joint} and A{other}"),
        (np.abs(np.diff(own)).max() <= JUMP, f"{name} jumped: a gap of the track is within the travel; {shaft}"),
        (low >= 20 and high <= 1003, f"{reads}, 20 to 1003 are free: {shaft}"),
        (middle.argmax() < middle.argmin(), f"{name} falls going {UP[joint]}: swap the two ends of its potentiometer"),
    ):
        _require(right, wrong)
    return f"{reads} counts, rising when it moves {UP[joint]}", {"low_counts": low, "high_counts": high}


def _drive(bench, joint, sound):
    """Push the joint away from its nearer end, then back.

    Swapped motor wires press a joint that lies at an end against it: then only the other push frees it.
    """
    name = f"joint {joint + 1}"
    _require(sound, f"{name} was not driven: its potentiometer first")
    first = 1 if _rest(bench)[-10:, joint].mean() < 512 else -1
    values = {}
    for sign in (first, -first):
        pwm, moved = _push(bench, joint, sign)
        if pwm is None:
            continue
        other = np.abs(moved).argmax()
        _require(other == joint, f"the drive of {name} moved joint {other + 1}: their two bridges are swapped")
        wrong = f"PWM {pwm:+d} moved {name} by {moved[joint]:+.0f} counts: swap its two motor wires"
        _require(moved[joint] * sign > 0, wrong)
        values["breakaway_up_pwm" if sign > 0 else "breakaway_down_pwm"] = pwm
    stuck = "did not move either way: has its motor no supply (current limit, ENABLE at 5 V, fuse), or is it blocked?"
    _require(values, f"{name} {stuck}")
    shown = " and ".join(f"{pwm:+d}" for pwm in values.values())
    return f"{name} breaks away at {shown} PWM counts, as commanded", values


def _push(bench, joint, sign):
    """Raise the drive of a joint until something moves; at an end of its travel also against the stop.

    Returns: PWM counts (None: nothing moved, up to the highest or until the guard took it for stuck), change (3,)
    counts.
    """
    before = _rest(bench, 0.6)[-10:].mean(axis=0)
    recent, pwm = [], None
    travel, bench._travel = bench._travel, ((-np.inf, np.inf),) * 3
    try:
        for k, sample in enumerate(bench.run((STEPS + 1) * STEP_CYCLES * bench.period, record=False)):
            recent = [*recent[-4:], sample.counts]
            moved = np.mean(recent, axis=0) - before
            if np.abs(moved).max() > MOVED:
                return pwm, moved
            pwm = min(k // STEP_CYCLES + 1, STEPS) * STEP_PWM * sign
            bench.drive([pwm if j == joint else 0 for j in range(3)])
    except RunawayError:  # what moves is seen here before the guard sees it: this joint stood still
        pass
    finally:
        bench._travel = travel
        bench.cut()
    return None, None


def _watchdog(bench, values):
    """Keep joint 1 moving, then say nothing: the board must brake by itself."""
    breakaway = values.get("breakaway_up_pwm") or values["breakaway_down_pwm"]
    pwm = breakaway + 20 * np.sign(breakaway)
    trips, places = bench.statistics.watchdog_trips, []
    for sample in bench.run(1.2, record=False):
        places.append((sample.t, sample.counts[0]))
        if sample.t < 0.5:
            bench.drive([pwm, 0, 0])
        elif len(places) > 2 and places[-2][0] < 0.5:
            bench._clock.sleep(SILENCE)
            bench.cut()  # else the next frame repeats the command
    tripped = bench.statistics.watchdog_trips - trips
    after = [counts for t, counts in places if t > 0.5 + SILENCE]
    still = np.ptp(after) < MOVED
    text = f"after {SILENCE:g} s without a command the board had cut the drive {tripped} times"
    text += ", and joint 1 stood" if still else ", but joint 1 went on: switch off, and load the sketch again"
    _require(tripped == 1 and still, text)
    return text, {}


def write_report(bench, findings):
    """Write what was found into the student's folder results/; returns its path."""
    date = datetime.datetime.now().astimezone()
    report = bench.head() | {
        "what": "bench-test",
        "date": date.isoformat(timespec="seconds"),
        "simulated": bench.simulated,
        "passed": all(finding.passed for finding in findings),
        "findings": [finding._asdict() for finding in findings],
    }
    path = home() / "results" / f"bench-test-{bench.bench_id}-{date:%Y%m%d-%H%M%S}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_text(path, json.dumps(report, indent=1, ensure_ascii=False) + "\n")
    return path


def main(arguments=None):
    """The command. Returns 0 if everything was right, else 1."""
    from ir50p_lab.bench.connect import connect

    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab bench-test", description=__doc__.splitlines()[0])
    parser.add_argument("port", nargs="?", help="port of the board, or 'simulated' (default: look for a board)")
    parser.add_argument("--joint", type=int, choices=(1, 2, 3), help="test this joint alone")
    options = parser.parse_args(arguments)
    joints = (options.joint,) if options.joint else (1, 2, 3)
    bench = connect(options.port, record_to=False)
    try:
        if bench.kind == "replay":
            raise InputError("a recording has no motors to test: give the port of a board, or 'simulated'")
        if not bench.simulated:
            print(f"Firmware {bench.firmware}, bench {bench.give_id()}")
        person = Person(bench.plant if bench.simulated else None)
        findings = bench_test(bench, person, joints=joints)
        path = write_report(bench, findings)
    finally:
        bench.abort()
    wrong = sum(not finding.passed for finding in findings)
    verdict = f"{wrong} steps failed: begin with the first" if wrong else "Everything is right"
    print(f"{verdict}. Written to {path}")
    return min(wrong, 1)


if __name__ == "__main__":
    raise SystemExit(main())
