"""The lab's own file: how far the arm of a board may be driven, and which faults may be made there on purpose.

The file is IR50P_BENCH_FILE, else bench.toml in the project's folder. It has a table for each board, named by the id
that `connect()` prints:

    [board-0a1b2c]
    limit_pwm = [160, 200, 120]                        # PWM counts of the joints, or one number for all
    speed = 1.0                                        # rad/s of the joints, or three numbers
    workspace = [[0.1, -0.4, 0.0], [0.6, 0.4, 0.7]]    # m, lowest and highest x, y, z of the tip
    faults = ["cable", "process"]                      # of cable, process, motor, potentiometer

What a table leaves out is not capped, except by 255 counts and the arm's travel. Nothing is clipped to a cap: whatever
goes beyond it is refused, and the drive is cut.
"""

import math
import tomllib
from collections import namedtuple

import numpy as np

from ir50p_lab.bench.protocol import LIMIT_PWM
from ir50p_lab.errors import BenchError, InputError
from ir50p_lab.home import PROJECT, path_setting
from ir50p_lab.inputs import choice, vectors3
from ir50p_lab.modelling.chain import forward_kinematics
from ir50p_lab.signals.reference import per_joint

FAULTS = ("cable", "process", "motor", "potentiometer")
_FREE = 3 * (LIMIT_PWM,), 3 * (math.inf,), (3 * (-math.inf,), 3 * (math.inf,)), (), ""
_BLOCKS = 4  # of the guard, 0.2 s, over which the speed is measured
_BESIDE, _FASTER = 0.03, 0.2  # m, rad/s: noise, and what a good controller strays by


class Caps(namedtuple("Caps", "limit_pwm speed workspace faults source", defaults=_FREE)):
    """How far an arm may be driven.

    limit_pwm: (3,) PWM counts; speed: (3,) rad/s; workspace: two corners (3,) m, of the tip; faults: those of FAULTS
    that may be made on purpose; source: the table and the file that set this, "" without one.
    """

    def check(self, what, key, values, spare=0.0):
        """Raise InputError if one of three `values` exceeds the cap `key` by more than `spare`; `what` names them."""
        cap = np.array(getattr(self, key), dtype=float)
        low, high = cap if key == "workspace" else (-cap, cap)
        if self.source and (np.maximum(low - values, values - high) > spare + 1e-9).any():
            said = f"{what} is {np.round(values, 3).tolist()}; {self.source} allows {key} = {cap.tolist()}"
            raise InputError(f"{said}: stay within, or ask whoever keeps the bench")

    def check_cycle(self, run, q, rows):
        """Raise InputError if a reference (3, 3) asks for too much, or if the arm, now at q (3,), is driven too far."""
        if rows is not None:
            self.check("the tip of the reference, m,", "workspace", forward_kinematics(run.bench.arm, rows[0]))
            self.check("the speed of the reference, rad/s,", "speed", rows[1])
        if run.bench.command.any():  # else it is moved by hand
            self.check("the tip, m,", "workspace", forward_kinematics(run.bench.arm, q), _BESIDE)
            if run.guard is not None and run.guard.watch.now[1] > _BLOCKS:
                way = run.guard.watch.past[-1] - run.guard.watch.past[-1 - _BLOCKS]
                self.check("the measured speed, rad/s,", "speed", way[1:4] / way[0], _FASTER)

    def check_fault(self, fault):
        """Raise BenchError if this fault may not be made here on purpose, InputError for an unknown fault."""
        if choice("fault", fault, FAULTS) not in self.faults:
            said = f"fault = {fault!r}: {self.source or 'no table of bench.toml'} allows faults = {list(self.faults)}"
            raise BenchError(f"{said}; make it on the simulated arm, connect('simulated')")


def caps_of(bench_id):
    """Return the Caps of a real bench from the lab's own file.

    Raises InputError, which names the file and what is wrong in it.
    """
    named = path_setting("IR50P_BENCH_FILE")
    path = named or PROJECT / "bench.toml"
    try:
        tables = tomllib.loads(path.read_text("utf-8-sig") if named or path.exists() else "")
        for name, table in tables.items():
            if not (name.startswith("board-") and isinstance(table, dict)):
                raise InputError(f"{name!r:.60} is not a table of a board: write [board-0a1b2c], as connect() says it")
        known = {key: _checked(key, value) for key, value in tables.get(bench_id, {}).items()}
    except (OSError, ValueError, TypeError, RecursionError) as error:
        raise InputError(f"the lab's own file {path}, for {bench_id}: {error}. Mend it: docs/with_the_arm.md") from None
    return Caps(**known, source=f"[{bench_id}] of {path}" * (bench_id in tables))


def _checked(key, value):
    """The value of one key of a table, as `Caps` has it."""
    if choice("key", key, Caps._fields[:-1]) == "faults":
        return tuple(choice("fault", fault, FAULTS) for fault in value)
    if key == "workspace":
        corners = vectors3(key, value, unit="m")
        if corners.shape != (2, 3) or not (corners[0] < corners[1]).all():
            raise InputError(f"{key} = {value!r:.60}: give two corners in m, lowest and highest x, y, z of the tip")
        return corners
    three = per_joint(key, value, "> 0")
    Caps(source="the board").check(key, key, three)
    return three
