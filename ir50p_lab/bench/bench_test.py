"""`python3 -m ir50p_lab bench-test`: the first power-on, joint by joint, with small drives; writes what it found.

The steps: noise at rest; each potentiometer turned by hand from end to end; each joint driven by a command that rises
until it moves, first away from the nearer end, then back; the board's watchdog. A joint whose potentiometer is not
right is not driven. The person at the bench is asked before each step. A simulated arm has no board, and no hand turns
it, so these two steps are left out.
"""

import argparse
import datetime
import json
from collections import namedtuple

import numpy as np

from ir50p_lab.bench.connect import connect
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.result_files import folder
from ir50p_lab.errors import BenchError, InputError, RunawayError
from ir50p_lab.home import replace_text
from ir50p_lab.modelling.named_arms import load_arm

JOINTS = (1, 2, 3)
STEP_PWM, STEP_CYCLES = 3, 5  # the drive rises by 3 counts every five samples
STEPS = 50  # number of steps of the command, up to 150 counts
MOVED = 8.0  # counts: a change by more (40 to 65 mrad) is a motion of the joint
STEADY = 3.0  # counts rms: a potentiometer at rest that scatters by more fails
TURN = 20.0  # time for turning a joint by hand from end to end, s
JUMP = 40.0  # counts: a larger change between two samples is a gap in the track, for no hand turns so fast
TRAVEL = 100.0  # counts: a joint turned from end to end that changes by less is not coupled to its potentiometer
SILENCE = 0.3  # pause in the commands, s: the board cuts the drive after 0.1 s, the run would end after 0.5 s
UP = ("counter-clockwise seen from above", "up", "up")
_LAY_DOWN = "Lay the arm down so that it stays by itself, something soft under it"


class Finding(namedtuple("Finding", "step joint passed text")):
    """What a step found. joint: 1 to 3, or 0 for all; passed: bool; text: a sentence."""


def bench_test(bench):
    """Test the joints of an open bench, whose drive is cut at the end. Prints and returns the Findings in order.

    A step that fails becomes a Finding, too: a broken wire, a runaway... (its BenchError as text, passed False).
    """
    findings, sound, breakaway = [], {}, {}

    def found(step, joint, action, *arguments):
        try:
            finding = Finding(step, joint, True, action(bench, *arguments))
        except BenchError as error:
            finding = Finding(step, joint, False, str(error))
        findings.append(finding)
        print(f"{'ok    ' if finding.passed else 'WRONG '} {step}: {finding.text}")
        return finding.passed

    try:
        _ask("Motor supply off")
        _ask(_LAY_DOWN)
        found("noise", 0, _noise)
        for joint in () if bench.simulated else JOINTS:
            motion = f"{UP[joint - 1]} to its end, slowly to the other end, and back"
            _ask(f"During the next {TURN:.0f} s turn joint {joint} by hand: {motion}. Nothing else may move")
            sound[joint] = found("potentiometer", joint, _potentiometer, joint - 1)
        _ask(_LAY_DOWN)
        _ask("Motor supply on, limit at 1 A, a hand on the emergency stop")
        for joint in JOINTS:
            found("drive", joint, _drive, joint - 1, sound.get(joint, bench.simulated), breakaway)
        if 0 in breakaway and not bench.simulated:
            found("watchdog", 1, _watchdog, breakaway[0])
    finally:
        bench.cut()
    return findings


def _ask(text):
    """Wait until the person at the bench has done what `text` says."""
    input(f"{text}. Then press Enter. ")


def _require(right, text):
    if not right:
        raise BenchError(text)


def _rest(bench, seconds=1.0):
    """Counts (n, 3) of a run without drive."""
    counts = [sample.counts for sample in bench.run(seconds, record=False)]
    return np.array(counts, dtype=float)


def _noise(bench):
    rms = _rest(bench).std(axis=0)
    worst, text = rms.argmax(), f"{rms.round(2).tolist()} counts rms at rest"
    remedy = f"; joint {worst + 1} is not steady: look at the grounds and the 100 nF, and that nothing moves"
    _require(rms[worst] <= STEADY, text + remedy)
    return text


def _potentiometer(bench, joint):
    bench.guarded = False  # a hand may turn a joint faster than its motor
    try:
        counts = _rest(bench, TURN)
    finally:
        bench.guarded = True
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
    return f"{reads} counts, rising when it moves {UP[joint]}"


def _drive(bench, joint, sound, breakaway):
    """Push the joint away from its nearer end, then back; breakaway[joint]: the PWM counts at which it moved.

    Swapped motor wires press a joint that lies at an end against it: then only the other push frees it.
    """
    name = f"joint {joint + 1}"
    _require(sound, f"{name} was not driven: its potentiometer first")
    first = 1 if _rest(bench)[-10:, joint].mean() < 512 else -1
    moved_at = []
    for sign in (first, -first):
        pwm, moved = _push(bench, joint, sign)
        if pwm is None:
            continue
        other = np.abs(moved).argmax()
        _require(other == joint, f"the drive of {name} moved joint {other + 1}: their two bridges are swapped")
        wrong = f"PWM {pwm:+d} moved {name} by {moved[joint]:+.0f} counts: swap its two motor wires"
        _require(moved[joint] * sign > 0, wrong)
        moved_at.append(pwm)
    stuck = "moved in no direction: does its motor lack supply (current limit, ENABLE at 5 V, fuse), or is it blocked?"
    _require(moved_at, f"{name} {stuck}")
    breakaway[joint] = moved_at
    return f"{name} breaks away at {' and '.join(f'{pwm:+d}' for pwm in moved_at)} PWM counts, as commanded"


def _push(bench, joint, sign):
    """Raise the drive of a joint until something moves; at an end of its travel also against the stop.

    Returns: PWM counts (None: nothing moved, up to the highest or until the guard took it for stuck), change (3,)
    counts.
    """
    before = _rest(bench, 0.6)[-10:].mean(axis=0)
    recent, pwm = [], None
    travel, bench._travel = bench._travel, ((-np.inf, np.inf),) * 3
    table, bench.table = bench.table, -np.inf  # the potentiometers of the others may be wrong yet
    try:
        for k, sample in enumerate(bench.run((STEPS + 1) * STEP_CYCLES * bench.period, record=False)):
            recent = [*recent[-4:], sample.counts]
            moved = np.mean(recent, axis=0) - before
            if np.abs(moved).max() > MOVED:
                return pwm, moved
            pwm = min(min(k // STEP_CYCLES + 1, STEPS) * STEP_PWM, bench.caps.limit_pwm[joint]) * sign
            bench.drive([pwm if j == joint else 0 for j in range(3)])
    except RunawayError:  # what moves is seen here before the guard sees it: this joint stood still
        pass
    finally:
        bench._travel, bench.table = travel, table
        bench.cut()
    return None, None


def _watchdog(bench, breakaway):
    """Keep joint 1 moving, then say nothing: the board must brake by itself."""
    most = bench.caps.limit_pwm[0]
    pwm = np.clip(max(breakaway) + 20 if max(breakaway) > 0 else min(breakaway) - 20, -most, most)
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
    return text


def write_report(bench, findings):
    """Write what was found into the folder results/ of the student; return the path."""
    date = datetime.datetime.now().astimezone()
    report = {"date": date.isoformat(timespec="seconds"), "findings": [finding._asdict() for finding in findings]}
    path = folder() / f"bench-test-{bench.bench_id}-{date:%Y%m%d-%H%M%S}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_text(path, json.dumps(bench.head() | report, indent=1, ensure_ascii=False) + "\n")
    return path


def main(arguments=None):
    """Run the command. Returns 0 if everything was right, else 1."""
    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab bench-test", description=__doc__.splitlines()[0])
    parser.add_argument("port", nargs="?", help="port of the board, or 'simulated' (default: look for a board)")
    bench = connect(parser.parse_args(arguments).port, record_to=False, q0=rest_pose(load_arm()))
    bench.caps = bench.caps._replace(workspace=((-9, -9, -9), (9, 9, 9)))  # it lies anywhere yet
    try:
        if bench.kind == "replay":
            raise InputError("a recording has no motors to test: give the port of a board, or 'simulated'")
        if not bench.simulated:
            print(f"Firmware {bench.firmware}, bench {bench.give_id()}")
        findings = bench_test(bench)
        path = write_report(bench, findings)
    finally:
        bench.abort()
    wrong = sum(not finding.passed for finding in findings)
    outcome = f"{wrong} steps failed: begin with the first" if wrong else "Everything is right"
    print(f"{outcome}. Written to {path}")
    return min(wrong, 1)


if __name__ == "__main__":
    raise SystemExit(main())
