"""Computed torque beside the thesis: `python -m tests.targets.computed_torque [--quick]`, medians over 20 units.

The thesis gives no errors for its Figures 2.8 and 4.13, only that the arm follows with some error and lag; numbers named
'trial' were checked with a second program before this one was written. RMS in mrad, joints 1/2/3.
"""

import argparse
import sys
import time

import numpy as np
from scipy.optimize import brentq

from ir50p_lab.controllers import ComputedTorque
from ir50p_lab.course.printed.control import PARAMETERS_2_1_2
from ir50p_lab.course.torque.views import follow, rms, thesis_pid
from ir50p_lab.errors import InputError
from ir50p_lab.identification import identify, load_excitations, regressor
from ir50p_lab.modelling import IR50P, THESIS_C
from ir50p_lab.modelling.named_arms import thesis_theta
from ir50p_lab.signals import quintic, sinusoid
from ir50p_lab.simulation import simulate
from tests.targets.rivals import PlannedSpeed, PushAndPD
from tests.targets.rows import Row, table

TABLES_2_4 = {"kp": (20**2, 50**2, 50**2), "kd": (40, 100, 100)}  # Tables 2.4-2.6
TABLES_4_5 = {"kp": (25, 9, 49), "kd": (10, 6, 14)}  # Tables 4.5-4.7
GOAL = (np.pi / 2, np.pi / 2, -np.pi / 3)
# rad, rad/s. The trial's own sinusoid is not known any more; on this one the PID of Tables 4.1-4.3 has the same errors
SWING = sinusoid((0.8, 0.4, 0.3), (0.5, 0.8, 1.0), offset=(0.0, 0.8, -0.8))
MOVE = quintic((0, 0, 0), GOAL, duration=6)


def excitation():
    """The motion of the recordings that models are identified from."""
    return load_excitations()["training"]


def record(seed, motion):
    """110 s of the unit `seed` on the excitation, as a student records it."""
    return follow(IR50P, thesis_pid(), motion, min(110.0, motion.duration), seed=seed)


def tracked(controller, seed, target=SWING, seconds=15.0):
    """(3,) rms of what the bench measured against the reference, mrad, from the first sample on.

    Infinite where the arm strayed 2 rad from the reference, so that the bench cut its drive.
    """
    try:
        return rms(follow(IR50P, controller, target, seconds, seed=seed), target)
    except InputError:
        return np.full(3, np.inf)


def simulated(controller, target):
    """(3,) rms, mrad, 15 s of the arm of 2.1.2, sampled every 10 ms."""
    q, qd, _ = target(0.0)
    return 1e3 * simulate(THESIS_C, controller, target, q0=q, qd0=qd, duration=15).rms_error


def wrong_parameters(rng):
    """The arm of 2.1.2 with every mass and inertia off by up to 20 %, each by its own draw: theta (3, 20)."""
    right = PARAMETERS_2_1_2
    wrong = {name: np.array(right[name]) * rng.uniform(0.8, 1.2, 3) for name in ("m", "Izz", "Iyy", "Iyz")}
    return thesis_theta(**{**right, **wrong})


def rows_simulated():
    """Tables 2.4-2.6, Figure 2.8."""
    moves = {
        "quintic": quintic((0, 0, 0), GOAL, duration=5),
        "sinus": sinusoid((0.8, 0.6, 0.6), (1, 1.5, 2)),
    }
    rng, rows = np.random.default_rng(0), []
    trial = {
        "exact model": (".0022/.0056/.0064", ".0089/.0070/.0195"),
        "model x 1.2": (".095/.479/.982", ".367/1.08/.598"),
        "model x 0.8": (".140/.713/1.48", ".551/1.62/.899"),
    }
    for k, (name, target) in enumerate(moves.items()):
        laws = {
            what: ComputedTorque(scale * THESIS_C, **TABLES_2_4, filter_hz=np.inf)
            for what, scale in (("exact model", 1.0), ("model x 1.2", 1.2), ("model x 0.8", 0.8))
        }
        for what, law in laws.items():
            found = simulated(law, target)
            limit = 0.03 if what == "exact model" else 3
            ok = bool((found < limit).all())
            said = f"trial {trial[what][k]}"
            rows.append(Row(f"Tables 2.4-2.6, {name}, {what}", f"< {limit:g}", text(found, 3), said, ok))
        draws = [wrong_parameters(rng) for _ in range(10)]
        worst = np.max([simulated(ComputedTorque(t, **TABLES_2_4, filter_hz=np.inf), target) for t in draws], axis=0)
        rows.append(
            Row(
                f"Tables 2.4-2.6, {name}, masses and inertias +-20 % each, worst of 10",
                "< 3",
                text(worst, 2),
                ok=(worst < 3).all(),
            )
        )
    return rows


def rows_bench(seeds):
    """Tables 4.5-4.7, Figure 4.13: each unit is recorded, identified and then tracks, on its own model."""
    motion, found, models = excitation(), {}, []
    for seed in seeds:
        recording = record(seed, motion)
        model = identify(recording, l2=IR50P.l[1])
        models.append(model)
        laws = {
            "PID, Tables 4.1-4.3": thesis_pid(),
            "computed torque": PlannedSpeed(model.theta, **TABLES_4_5),
            "computed torque, measured velocity in C and F": ComputedTorque(model, **TABLES_4_5, delay=0.02),
            "feed-forward and PD": PushAndPD(model.theta, (289, 225, 270), (40, 30, 30)),
            "gravity and PD": PushAndPD(model.theta, (289, 225, 270), (40, 30, 30), weight_alone=True),
            "computed torque, true parameters": PlannedSpeed(IR50P.theta_pwm, **TABLES_4_5),
        }
        for name, law in laws.items():
            for move, target in (("sinusoid", SWING), ("quintic 6 s", MOVE)):
                found.setdefault((name, move), []).append(tracked(law, seed, target))
    target = np.array([20.0, 50.0, 20.0])
    trial = {
        ("PID, Tables 4.1-4.3", "sinusoid"): "trial 144/408/165",
        ("PID, Tables 4.1-4.3", "quintic 6 s"): "trial 61/491/89",
        ("computed torque", "sinusoid"): "'some error', lag; trial 13/37/13",
        ("computed torque", "quintic 6 s"): "trial 17/26/8",
    }
    rows = []
    for (name, move), values in found.items():
        middle, worst = np.median(values, axis=0), np.max(values, axis=0)
        asked = (name, move) == ("computed torque", "sinusoid")
        rows.append(
            Row(
                f"{name}, {move}: median (worst)",
                "<= 20/50/20" if asked else "-",
                f"{text(middle)} ({text(worst)})",
                trial.get((name, move), "-"),
                bool((middle <= target).all()) if asked else None,
            )
        )
    return rows + rows_saturation(models[0], seeds[0])


def rows_saturation(model, seed):
    """Too fast a motion: computed from the model's limits, then driven."""
    least = brentq(lambda duration: share(model, duration) - 1, 0.2, 30)
    rows = []
    for slower, fits in ((1.3, True), (0.6, False)):
        duration = slower * least
        law = PlannedSpeed(model.theta, **TABLES_4_5)
        error = tracked(law, seed, quintic((0, 0, 0), GOAL, duration=duration), duration).max()
        what = f"the quintic in {duration:.1f} s: computed '{'fits' if fits else 'saturates'}'"
        asked = "follows (< 100)" if fits else "cannot follow (> 100)"
        rows.append(Row(what, asked, f"{error:.0f}", "'motors too limited'", (error < 100) == fits))
    return rows


def share(model, duration):
    """The largest part of 255 counts that the way to GOAL asks for."""
    rows = quintic((0, 0, 0), GOAL, duration=duration).sample(np.linspace(0, duration, 200))
    return np.abs(np.einsum("nij,ij->ni", regressor(*rows.transpose(1, 0, 2)), model.theta)).max() / 255


def text(values, digits=0):
    """Three numbers with slashes between."""
    return "/".join(f"{x:.{digits}f}" if x < 1e4 else "far" for x in values)


def main(arguments=None):
    """Print the table; returns 1 if a target is missed."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.targets.computed_torque", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--quick", action="store_true", help="3 units instead of 20")
    options = parser.parse_args(arguments)
    start, seeds = time.perf_counter(), range(100, 103 if options.quick else 120)
    rows = rows_simulated() + rows_bench(seeds)
    print(table(rows, f"Computed torque: RMS tracking error in mrad, joints 1/2/3, simulated ({len(seeds)} units)"))
    print(f"{time.perf_counter() - start:.0f} s", file=sys.stderr)
    return int(any(row.ok is False for row in rows))


if __name__ == "__main__":
    sys.exit(main())
