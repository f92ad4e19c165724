"""What is no arm, no recording, no number, no port: every public name of the bench says so, and how to go on."""

import numpy as np
import pytest
from refusals import refused

from ir50p_lab.bench import (
    Recording,
    ReplayBench,
    SerialBench,
    SimulatedBench,
    connect,
    nominal_calibration,
)
from ir50p_lab.controllers import PID
from ir50p_lab.errors import LabError, PortError
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals import hold


class Anything:
    """An object that is nothing the bench knows, with a name that stays."""

    def __repr__(self):
        return "Anything()"


RUBBISH = ["x", -1, float("nan"), [], {}, Anything(), np.full((3, 3), np.nan)]


CALIBRATED = Recording.from_arrays([0.0], np.zeros((1, 3)), header=nominal_calibration(IR50P).header())


@pytest.mark.parametrize("rubbish", RUBBISH, ids=repr)
@pytest.mark.parametrize(
    "make",
    [
        nominal_calibration,
        SimulatedBench,
        lambda arm: SerialBench("COM3", arm=arm),
        lambda arm: ReplayBench(CALIBRATED, arm=arm),
    ],
    ids=["calibration", "simulated", "serial", "replay"],
)
def test_no_arm(make, rubbish):
    refused(r"give an Arm", make, rubbish)


@pytest.mark.parametrize("rubbish", [None, *RUBBISH[1:]], ids=repr)
def test_no_recording(rubbish):
    refused(r"give a Recording", ReplayBench, rubbish)


@pytest.mark.parametrize("period", [None, "0.01", 0.0, 2.0], ids=repr)
def test_no_period(period):
    refused(r"period", SimulatedBench, IR50P, period=period, record_to=False)


@pytest.mark.parametrize("rubbish", RUBBISH, ids=repr)
def test_a_run_refuses(rubbish):
    with SimulatedBench(IR50P, record_to=False) as bench:
        with pytest.raises(LabError):
            list(bench.run(rubbish))
        with pytest.raises(LabError):
            for _ in bench.run(0.02):
                bench.drive(rubbish)
        refused("", bench.follow, PID(kp=(1, 1, 1), limit_pwm=255), hold([0, 0, 0]), rubbish, error=LabError)
        refused(r"give a controller", bench.follow, rubbish, hold([0, 0, 0]), 1.0)
        refused(r"give a function of time", bench.follow, PID(kp=(1, 1, 1), limit_pwm=255), rubbish, 1.0)
        refused("", bench.start, rubbish, hold([0, 0, 0]), error=LabError)
        refused("", bench.start, PID(kp=(1, 1, 1), limit_pwm=255), rubbish, error=LabError)


def test_a_misspelt_bench_says_how_to_go_on_without_a_board(monkeypatch):
    monkeypatch.setenv("IR50P_BENCH", "simulatd")
    refused(r"simulatd does not exist.*connect\('simulated'\)", connect, error=PortError)
