"""The judge of 19: `python3 -m ir50p_lab judge FILE`. It holds arms, balls and cameras; a hand-in asks through a pipe.

A hand-in runs in a process of its own, inside bubblewrap if the system has it, and speaks in lines of JSON.
"""

import argparse
import json
import os
import secrets
import shutil
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from tqdm.auto import tqdm

from ir50p_lab.course.grading import sandbox
from ir50p_lab.course.unknown.hand_in import hand_in, lent
from ir50p_lab.course.unknown.race_day import Raced, RaceDay
from ir50p_lab.course.unknown.world import World
from ir50p_lab.errors import InputError, LabError
from ir50p_lab.inputs import whole

SECONDS = 300  # for one arm, by the clock
_LONGEST = 1 << 16  # letters of a line that a hand-in may say


def judged(hand_in_of, arms=3, *, seeds=None, seconds=SECONDS):
    """Race a hand-in on arms that nobody has seen, several at a time, with a bar. Returns: RaceDay.

    hand_in_of: unknown_arm, a function of the notebook, or the path of a file; the functions, `my_robot`, may lie in
    its folder or next to that. arms: how many; seeds: of the arms, by default secret ones. seconds: for each arm, by
    the clock.
    Raises InputError for what is not a hand-in.
    """
    path = hand_in(hand_in_of) if callable(hand_in_of) else Path(hand_in_of)
    if not path.is_file() or path.suffix != ".py":
        raise InputError(f"'{path}' is not a Python file: give the one that holds `unknown_arm` (unpack a ZIP first)")
    seeds = seeds or [secrets.randbits(128) for _ in range(whole("arms", arms, 1, 1000))]
    with TemporaryDirectory() as room, ThreadPoolExecutor(os.cpu_count()) as pool:
        folder = _moved_in(path, Path(room))
        races = pool.map(partial(_race, folder, sandbox.bubblewrap(room), seconds), seeds)
        found = lent(path.read_text(encoding="utf-8", errors="replace"), folder)
        return RaceDay(tuple(tqdm(races, total=len(seeds), desc="arms")), found)


def _moved_in(path, room):
    """A folder that anybody may read, with the hand-in and the functions of who made it."""
    room.chmod(0o755)
    shutil.copyfile(path, room / "unknown_arm.py")
    robot = next((one / "my_robot" for one in path.resolve().parents[:2] if (one / "my_robot").is_dir()), None)
    if robot is not None:
        shutil.copytree(robot, room / "my_robot", ignore=shutil.ignore_patterns("old", "__pycache__"))
    return room


def _race(folder, words, seconds, seed):
    world = World(seed)
    child = sandbox.started(words, "racer", folder, text=True, cwd=folder)
    late = threading.Timer(seconds, sandbox.end, [child])
    late.start()
    try:
        void = _answered(world, child)
    except (OSError, ValueError, AttributeError):  # it is gone, or what came is no question
        void = sandbox.ENDED
    late.cancel()
    sandbox.end(child)
    child.communicate()  # closes its pipes
    return Raced(world, "" if world.complete else void or ("" if world.raced else "it never asked for the race"))


def _answered(world, child):
    """Answer what a hand-in asks until it ends; return why it did not end well, or ""."""
    while True:
        question = json.loads(child.stdout.readline(_LONGEST))
        if question.get("op") == "end":
            return ""
        if question.get("op") == "error":
            return str(question.get("says"))[:300]
        try:
            said = world.answer(question)
        except LabError as problem:
            said = {"error": str(problem)}
        child.stdin.write(json.dumps(said) + "\n")
        child.stdin.flush()


def main(arguments=None):
    """Judge a file."""
    says = "Race a hand-in of notebook 19 on arms that nobody has seen."
    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab judge", description=says)
    parser.add_argument("file", type=Path, metavar="FILE", help="results/unknown_arm.py of the student's folder")
    parser.add_argument("--arms", type=int, default=20, metavar="N", help="how many (20)")
    options = parser.parse_args(arguments)
    print(sandbox.isolation())
    try:
        print(judged(options.file, options.arms))
    except LabError as problem:
        sys.exit(str(problem))


if __name__ == "__main__":
    main()
