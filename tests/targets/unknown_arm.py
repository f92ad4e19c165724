"""Three balls on an arm that nobody has seen (19): median, and arms with all three, of 20 (quick: 3).

Each strategy is a change in the reference hand-in, by tests/solutions.
"""

import contextlib
import io
import os
import re
import tempfile
from pathlib import Path

from ir50p_lab.course.robot.catalogue import ORDER
from ir50p_lab.course.unknown.far_bench import FarBench
from ir50p_lab.course.unknown.race_day import FAST, Raced, RaceDay
from ir50p_lab.course.unknown.world import World
from tests.targets.in_parallel import mapped
from tests.targets.rows import Row

TESTS = Path(__file__).parents[1]
REFERENCE = TESTS / "support" / "hand_in" / "unknown_arm.py"
OF_THREE, LEAST = 4.5, 0.95  # s, median of three, which scatters more than that of twenty; share of arms completed
LOST = 0.25  # share of arms that nominal numbers complete at most
_NOMINAL = """
def practise(bench, seed):
    pass


def learn(bench, run):
    return bench.nominal
"""
_NOT_LED = """
def when_it_acts(off, off_rate, plan_at, delay):
    plan = plan_at(0)
    return plan[0] + off, plan[1] + off_rate, plan
"""
_PID = (
    _NOMINAL
    + """

def quickest(theta, a, b, most):
    return max(0.25, 1.875 * np.abs(b - a).max() / {pace})


def race(bench, theta, legs, meets):
    on_legs, pid = views.OnLegs(legs), my_robot.PID(*{gains})
    for sample in bench.race():
        q, qd, qdd = on_legs(sample, bench.delay)
        planned = np.sum(my_robot.regressor(q, qd, qdd, np.tanh(qd / 0.05)) * theta, axis=1)
        bench.drive({share} * planned + pid.step(sample.t, sample.q, on_legs(sample, 0)))
"""
)
_CLIMBED = ((1400, 1392, 1400), (1508, 2300, 2180), (17, 17, 17))  # 50 steps on 12 other arms: nine gains and a pace
_TUNED = ((1000, 1000, 1000), (800, 2800, 2400), (8, 1, 1))  # of 09
STRATEGIES = {
    "identified, computed torque": "",
    "the same, not led by the delay": _NOT_LED,
    "the same, theta = nominal": _NOMINAL,
    "nominal feed-forward, PID climbed on other arms": _PID.format(pace=1.2, gains=_CLIMBED, share=1),
    "PID of 09 alone, 0.5 rad/s": _PID.format(pace=0.5, gains=_TUNED, share=0),
}


def raced(item):
    """What came of a strategy on the arm of a seed: Raced."""
    name, seed = item
    world = World(seed)
    room = {}
    with contextlib.redirect_stdout(io.StringIO()):  # whose functions are in use
        exec(REFERENCE.read_text("utf-8") + STRATEGIES[name], room)
        room["unknown_arm"](FarBench(world.answer))
    return Raced(world)


def write_robot(home):
    """The functions of tests/solutions as a student's `my_robot`."""
    folder = Path(home) / "my_robot"
    folder.mkdir(parents=True)
    for k, name in enumerate(ORDER):
        text = (TESTS / "solutions" / f"{name}.py").read_text("utf-8")
        leans = [one for one in ORDER[:k] if re.search(rf"\b{one}\(", text)]
        imports = "".join(f"from ._{one} import {one}\n" for one in leans)
        (folder / f"_{name}.py").write_text(f"import math\n\nimport numpy as np\n\n{imports}\n\n{text}", "utf-8")
    (folder / "__init__.py").write_text("".join(f"from ._{name} import {name}\n" for name in ORDER), "utf-8")


def rows(quick):
    """A row of each strategy."""
    seeds = range(19_000, 19_003 if quick else 19_020)
    items = [(name, seed) for name in STRATEGIES for seed in seeds]
    with tempfile.TemporaryDirectory() as home:
        write_robot(home)
        os.environ["IR50P_HOME"] = home
        races = mapped(raced, items, "races")
    for k, name in enumerate(STRATEGIES):
        day = RaceDay(tuple(races[k * len(seeds) : (k + 1) * len(seeds)]))
        share = day.complete / len(seeds)
        target, ok = "-", None
        if name.startswith("identified"):
            most = FAST if len(seeds) == 20 else OF_THREE
            target, ok = f"<= {most} s, {LEAST:.0%} complete", day.median <= most and share >= LEAST
        elif name.endswith("nominal"):
            target, ok = f"<= {LOST:.0%} complete", share <= LOST
        yield Row(name, target, f"{day.median:.2f} s, {day.complete} of {len(seeds)} complete", ok=ok)
