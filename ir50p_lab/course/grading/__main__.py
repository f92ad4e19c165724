"""Check what a class has handed in, the ZIPs of 'pack' or folders: a table (CSV) and a page (HTML)."""

import argparse
import csv
import os
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from tqdm.auto import tqdm

from ir50p_lab.course.grading import sandbox
from ir50p_lab.course.grading.page import page
from ir50p_lab.course.grading.submissions import submissions
from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.errors import LabError


def judged(handed_in, seconds=sandbox.SECONDS):
    """Return [{function: (state, sentence)}] of submissions, checked several at a time, with a bar of progress."""
    judge = partial(sandbox.verdicts, before=sandbox.bubblewrap(), seconds=seconds)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(judge, [one.functions for one in handed_in])
        return list(tqdm(found, total=len(handed_in), desc="checked"))


def write_table(path, handed_in, found):
    """Write one row for each submission to the file `path`."""
    with path.open("w", encoding="utf-8-sig", newline="") as file:
        table = csv.writer(file)
        said = ("predictions (self-reported)", "reasons (self-reported)")
        table.writerow(["student", "partners (self-reported)", *sandbox.STATES, *said, *ORDER, "trouble"])
        for one, verdicts in zip(handed_in, found, strict=True):
            states = [verdicts.get(name, ("open", ""))[0] for name in ORDER]
            counts = Counter(states)
            reasons = sum(bool(entry["why"]) for entry in one.predictions.values())
            row = [one.name, " and ".join(one.partners), *(counts[state] for state in sandbox.STATES)]
            row += [len(one.predictions), reasons, *states, one.trouble]
            table.writerow(map(_plain, row))


def _plain(value):
    """A cell that a spreadsheet does not take for a formula."""
    return f"'{value}" if str(value).startswith(("=", "+", "-", "@")) else value


def main(arguments=None):
    """Check a class."""
    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab grade", description=__doc__)
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="folder with the hand-ins")
    parser.add_argument("--to", type=Path, default=Path("."), metavar="FOLDER", help="where table and page go")
    options = parser.parse_args(arguments)
    try:
        handed_in = submissions(options.folder)
    except LabError as problem:
        sys.exit(str(problem))
    print(sandbox.isolation())
    found = judged(handed_in)
    options.to.mkdir(parents=True, exist_ok=True)
    write_table(options.to / "class.csv", handed_in, found)
    (options.to / "class.html").write_text(page(handed_in, found), encoding="utf-8")
    for one in handed_in:
        if one.trouble:
            print(f"{one.name}: {one.trouble}")
    print(f"{len(handed_in)} hand-ins: {options.to / 'class.csv'} and {options.to / 'class.html'}")


if __name__ == "__main__":
    main()
