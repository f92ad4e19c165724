"""The student's results as files: what was measured, when, on which bench; and the newest that counts for a bench."""

import json
from collections import namedtuple
from dataclasses import replace
from datetime import datetime

from ir50p_lab.errors import InputError
from ir50p_lab.home import home, replace_text

_FIELDS = "name kind made chosen arm bench bench_id unit seed simulated withdrawn file"


class Result(namedtuple("Result", _FIELDS)):
    """One result: a description NAME.json in `results/` of the student's folder, and the file that it names.

    name: such as 'model-2'; kind: 'calibration', 'model' or 'camera'; made, chosen: ISO times, chosen is the later one
    if an older result was taken again; arm, bench: names; bench_id: of the bench it was measured on; unit, seed: of a
    simulated arm, else ''; simulated: bool; withdrawn: bool; file: name of the file with the numbers.
    """

    @property
    def path(self):
        """The file with the numbers: Path."""
        return folder() / self.file

    def __str__(self):
        return f"{self.name} of {self.made[:16].replace('T', ' ')}, measured on {self.bench}"


def folder():
    """Where results lie: Path; it may not exist yet."""
    return home() / "results"


def every():
    """All Results, the one chosen last at the end. Raises InputError for a file that describes no result."""
    found = []
    for path in {*folder().glob("*-*.json")} - {*folder().glob("bench-test-*.json")}:  # reports of `bench_test`
        try:
            found.append(Result(**json.loads(path.read_text(encoding="utf-8"))))
        except (OSError, ValueError, TypeError, RecursionError) as error:
            raise InputError(f"{path} describes no result ({error!r:.80}): delete it, or move it elsewhere") from None
    return sorted(found, key=lambda one: one.chosen)


def newest(kind, bench_id, arm):
    """The Result of this kind for the arm on the bench with this id that was chosen last; None if there is none."""
    fits = [one for one in every() if (one.kind, one.bench_id, one.arm) == (kind, bench_id, arm) and not one.withdrawn]
    return fits[-1] if fits else None


def add(kind, suffix, write, **about):
    """Keep a result. write: function (path) that writes the numbers; about: the other fields of Result. Returns it.

    Raises InputError if it cannot be written.
    """
    number = 1 + max((int(one.name.rpartition("-")[2]) for one in every() if one.kind == kind), default=0)
    name, now = f"{kind}-{number}", datetime.now().astimezone().isoformat()
    result = Result(name=name, kind=kind, made=now, chosen=now, withdrawn=False, file=f"{name}{suffix}", **about)
    try:
        folder().mkdir(parents=True, exist_ok=True)
        write(result.path)
        _describe(result)
    except OSError as error:
        raise InputError(f"cannot keep {name} in {folder()}: {error.strerror}; set IR50P_HOME to a folder") from None
    return result


def change(name, *, withdrawn):
    """Withdraw a result, or let it count from now on, whatever is newer. Raises InputError for an unknown name."""
    known = {one.name: one for one in every()}
    if name not in known:
        raise InputError(f"there is no result {name!r}: {', '.join(known) or 'none at all'}")
    chosen = known[name].chosen if withdrawn else datetime.now().astimezone().isoformat()
    _describe(known[name]._replace(withdrawn=withdrawn, chosen=chosen))


def _describe(result):
    replace_text(folder() / f"{result.name}.json", json.dumps(result._asdict(), indent=1) + "\n")


def own_calibration(bench):
    """The JointCalibration measured on an open bench that counts, or None; its source says which it is."""
    from ir50p_lab.bench.calibration import JointCalibration

    found = newest("calibration", bench.bench_id, bench.arm.name) if bench.bench_id else None
    if found is None:
        return None
    calibration = JointCalibration.load(found.path)
    return replace(calibration, source=f"yours, {found.name} ({calibration.source})")
