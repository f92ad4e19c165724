"""The small recordings in `data/`, for lessons that need the same data on every computer: all simulated.

`python -m data.make_recordings` writes them again; `data/README.md` says what each is for.
"""

import argparse
from pathlib import Path

import numpy as np

from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.simulated import SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.modelling.named_arms import IR50P, IR50P_WEAK_SHOULDER
from ir50p_lab.signals import hold, through

_GAINS = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30)}  # Tables 4.1-4.3
_FILTERED = {"position_filter_hz": 3.0, "filter_hz": np.inf}  # the one that fits Table 4.4
_SET_POINT = (np.pi / 2, np.pi / 2, -np.pi / 3)


def pid_default_unit():
    """Tables 4.1-4.3 on the IR50P: 30 s, q filtered with 3 Hz."""
    return _follow(IR50P, 1, hold(_SET_POINT), 30, **_FILTERED)


def pid_weak_shoulder():
    """Tables 4.1-4.3 on the unit whose joint 1 swings over and hunts: 30 s, q filtered with 3 Hz (Figure 4.8)."""
    return _follow(IR50P_WEAK_SHOULDER, 1, hold(_SET_POINT), 30, **_FILTERED)


def noise_at_rest():
    """No drive, nothing moves: 10 s of noise and rounding of the potentiometers."""
    bench = SimulatedBench(IR50P, seed=2, q0=rest_pose(IR50P), record_to=False).open()
    for _ in bench.run(1, record=False):
        pass  # joint 3 sinks onto its end stop
    for _ in bench.run(10, controller="none: u = 0"):
        pass
    return _undated(bench)


def slow_and_fast():
    """One move of 6 s and the same move back in 1.2 s, with rests: 12 s, for filters and velocities."""
    start, end = np.array([0.0, 0.6, -0.8]), np.array([0.7, 0.9, -0.4])
    poses = [start, start, end, end, start, start]
    gains = {"kp": (600, 900, 700), "ki": (300, 400, 300), "kd": (40, 60, 50)}  # found by trying: follows closely
    return _follow(IR50P, 3, through(poses, durations=(1.5, 6.0, 1.0, 1.2, 2.3)), 12, gains=gains, q0=start)


RECORDINGS = {
    "pid_default_unit": pid_default_unit,
    "pid_weak_shoulder": pid_weak_shoulder,
    "noise_at_rest": noise_at_rest,
    "slow_and_fast": slow_and_fast,
}


def _follow(arm, seed, reference, seconds, *, gains=_GAINS, q0=None, **filters):
    bench = SimulatedBench(arm, seed=seed, q0=q0, record_to=False).open()
    controller = PID(**gains, limit_pwm=255, **filters)
    bench.follow(controller, reference, seconds)
    return _undated(bench)


def _undated(bench):
    """The recording without its date: made again it is the same file."""
    recording = bench.recording
    del recording.header["date"]
    recording.header["made_by"] = "python -m data.make_recordings"
    return recording


def main(arguments=None):
    """Write the recordings into the folder of the argument, default `data`."""
    parser = argparse.ArgumentParser(prog="python -m data.make_recordings", description=__doc__)
    parser.add_argument("folder", nargs="?", default="data", help="where to (default: data)")
    folder = Path(parser.parse_args(arguments).folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in RECORDINGS.items():
        path = make().save(folder / f"{name}.csv")
        print(f"{path}: {path.stat().st_size / 1024:.0f} KiB")


if __name__ == "__main__":
    main()
