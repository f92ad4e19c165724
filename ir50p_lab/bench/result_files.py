"""The student's result files, read back: what was measured, when, on which bench, and which is the newest for a bench.

`course.lab_book.results` writes them.
"""

import json
from collections import namedtuple
from dataclasses import replace

from ir50p_lab.errors import InputError
from ir50p_lab.home import home

_FIELDS = "name kind made chosen arm bench bench_id unit seed simulated withdrawn file"


class Result(namedtuple("Result", _FIELDS)):
    """One result: a description NAME.json in `results/` of the student's folder, and the file that it names.

    name: such as 'model-2'; kind: 'calibration', 'model' or 'camera'; made, chosen: ISO times, chosen is the later one
    if an older result was taken again; arm, bench: names; bench_id: of the bench on which it was measured; unit, seed:
    those of a simulated arm, else ''; simulated: bool; withdrawn: bool; file: name of the file with the numbers.
    """

    @property
    def path(self):
        """The file with the numbers: Path."""
        return folder() / self.file

    def __str__(self):
        return f"{self.name} of {self.made[:16].replace('T', ' ')}, measured on {self.bench}"


def folder():
    """Return the Path of the folder where results are kept; it may not exist yet."""
    return home() / "results"


def every():
    """Return all Results, the one chosen last at the end. Raises InputError for a file that describes no result."""
    found = []
    for path in {*folder().glob("*-*.json")} - {*folder().glob("bench-test-*.json")}:  # reports of `bench_test`
        try:
            found.append(Result(**json.loads(path.read_text(encoding="utf-8"))))
        except (OSError, ValueError, TypeError, RecursionError) as error:
            raise InputError(f"{path} describes no result ({error!r:.80}): delete it, or move it elsewhere") from None
    return sorted(found, key=lambda one: one.chosen)


def newest(kind, bench_id, arm):
    """Return the Result of this kind, for this arm and bench id, that was chosen last; None if there is none."""
    fits = [one for one in every() if (one.kind, one.bench_id, one.arm) == (kind, bench_id, arm) and not one.withdrawn]
    return fits[-1] if fits else None


def own_calibration(bench):
    """Return the newest JointCalibration measured on this open bench, or None; its source says which it is."""
    from ir50p_lab.bench.calibration import JointCalibration

    found = newest("calibration", bench.bench_id, bench.arm.name) if bench.bench_id else None
    if found is None:
        return None
    calibration = JointCalibration.load(found.path)
    return replace(calibration, source=f"yours, {found.name} ({calibration.source})")
