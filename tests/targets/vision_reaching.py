"""Targets of reaching: balls in the declared work area, looked at twice, and the true tip of the simulated arm."""

import numpy as np

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.errors import UnreachableError, VisionError
from ir50p_lab.modelling import IR50P, forward_kinematics
from ir50p_lab.vision import BallLocator, RenderedBench, reach, reach_pose
from ir50p_lab.vision.reaching.budget import error_budget
from ir50p_lab.vision.reaching.plan import MARGIN
from ir50p_lab.vision.reaching.reach import HEIGHT
from tests.support.places import places_in, work_area
from tests.targets.in_parallel import mapped
from tests.targets.rows import Row
from tests.targets.vision_setup import calibrated, own_plane

OVER = np.array([0.0, 0.0, HEIGHT])
BENT = 0.5  # counts rms: what a straight line leaves of a parabola 1.5 counts high is 0.45, and its zero is fitted, too
UNITS = range(100, 110)  # copies of the arm on which nothing was tuned, each calibrated by an experiment of its own


def oracle_reaches(p, n=400):
    """Whether a brute-force grid over joints 2 and 3, refined, comes within 1 mm of p (limits less the margin)."""
    low, high = np.array(IR50P.q_min) + MARGIN, np.array(IR50P.q_max) - MARGIN
    q1 = np.arctan2(p[1], p[0])
    if not low[0] <= q1 <= high[0]:
        return False
    lo, hi, best = low[1:], high[1:], np.inf
    for _ in range(4):
        grid = np.stack(np.meshgrid(np.linspace(lo[0], hi[0], n), np.linspace(lo[1], hi[1], n)), -1).reshape(-1, 2)
        q = np.column_stack([np.full(len(grid), q1), grid])
        distance = np.linalg.norm(forward_kinematics(IR50P, q) - p, axis=1)
        k = distance.argmin()
        best, half = min(best, distance[k]), 0.05 * (hi - lo)
        lo, hi = np.maximum(low[1:], grid[k] - half), np.minimum(high[1:], grid[k] + half)
    return best < 1e-3


def one_reach(task):
    """Reach for a rendered ball, task = (ball (3,) m, seed): distances in m, or the error that says why not.

    True tip to true goal; of the ball, seen to true; of the tip, believed to true; believed tip to believed goal.
    """
    ball, seed = task
    unit = UNITS[seed % len(UNITS)]
    bench = SimulatedBench(IR50P, seed=unit, q0=rest_pose(IR50P), record_to=False, calibration=calibrated(unit))
    world = RenderedBench(bench, ball, seed=seed)
    with bench:
        try:
            done = reach(bench, BallLocator(world, own_plane()), rest=False)
        except (UnreachableError, VisionError) as error:
            return error
    goal = world.balls_true[0] + OVER
    seen = np.linalg.norm(done.ball - world.balls_true[0])
    return np.linalg.norm(done.tip_true - goal), seen, np.linalg.norm(done.tip - done.tip_true), done.miss


def rows(quick):
    """The table of targets."""
    n = 10 if quick else 200
    balls = places_in(work_area(IR50P), np.random.default_rng(11), n)
    results = mapped(one_reach, [(ball, seed) for seed, ball in enumerate(balls)], "balls reached for")
    possible = np.array([oracle_reaches(ball + OVER) for ball in balls])
    reached = np.array([isinstance(one, tuple) for one in results])
    refused = np.array([isinstance(one, UnreachableError) for one in results])
    agree = int((refused == ~possible).sum())
    miss, seen, hand, stand = zip(*[one for one in results if isinstance(one, tuple)], strict=True)
    median, p95, rms = np.median(miss), np.percentile(miss, 95), np.sqrt(np.mean(np.square(miss)))
    wanted = 150 * n / 200
    locator = BallLocator(None, own_plane())
    slope = np.array(calibrated(UNITS[0]).slope)
    poses = [reach_pose(IR50P, ball + OVER) for ball in balls[possible][:20]]
    budgets = [error_budget(IR50P, locator, q, sigma_q=BENT / slope, slope=slope) for q in poses]
    predicted = 1e-3 * _rms([budget.loc["all together", "two looks"] for budget in budgets])
    parts = {name: _predicted(budgets, name) for name in ("ball", "hand", "standing")}
    return [
        Row(f"balls reached, of {n} in the work area", f">= {wanted:.0f}", f"{reached.sum()}", "-", reached.sum() >= wanted),
        Row("refusals as the brute-force oracle has them", f"{n}", f"{agree} ({refused.sum()} refused)", "-", agree == n),
        Row("true tip to true goal, two looks, median", "<= 3 mm", f"{1e3 * median:.2f} mm", "-", median <= 3e-3),
        Row("true tip to true goal, two looks, p95", "<= 6 mm", f"{1e3 * p95:.2f} mm", "-", p95 <= 6e-3),
        Row("of it: ball, seen against true, rms", "-", f"{_rms(seen):.2f} mm, predicted {parts['ball']:.2f} mm", "mean 5.1 mm"),
        Row("of it: hand, believed against true, rms", "-", f"{_rms(hand):.2f} mm, predicted {parts['hand']:.2f} mm"),
        Row("of it: standing beside the goal, rms", "-", f"{_rms(stand):.2f} mm, predicted {parts['standing']:.2f} mm"),
        Row(
            "rms, beside the error budget",
            "within a factor 1.5",
            f"{1e3 * rms:.2f} mm, predicted {1e3 * predicted:.2f} mm",
            "-",
            1 / 1.5 < rms / predicted < 1.5,
        ),
    ]  # fmt: skip


def _predicted(budgets, part):
    """What the budgets say of one part, rms mm: the ball's place, where the hand is believed, standing still."""
    words = {"ball": ("ball in",), "hand": ("marker", "potentiometers"), "standing": ("standing",)}[part]
    return _rms([np.linalg.norm(one["two looks"][one.index.str.startswith(words)]) for one in budgets])


def _rms(values):
    return 1e3 * float(np.sqrt(np.mean(np.square(values))))
