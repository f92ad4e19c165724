"""What each step of the processing brings, on the simulated bench: the claims of the course, each as a number."""

import numpy as np
import pytest

from ir50p_lab.bench import ArmInstance, SimulatedBench
from ir50p_lab.controllers import PID
from ir50p_lab.identification import fit, load_excitations, process, regressor, validate
from ir50p_lab.modelling import IR50P

pytestmark = pytest.mark.numeric
NO_PLAY = ArmInstance(dead_zone=(0, 0, 0), backlash=(0, 0, 0), pot_bow=(0, 0, 0), bow_spread=0.0)  # one count of noise
NAIVE = {"derivatives": "causal", "cutoff_hz": 3.0}
FULL = {"delay": 0.02, "slow": 0.05}


@pytest.fixture(scope="module")
def records():
    """Training, validation: two motions, each its own noise."""
    made = []
    for name in ("training", "validation 1"):
        motion = load_excitations()[name]
        gains = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30), "limit_pwm": 255}
        pid = PID(**gains, position_filter_hz=3.0, filter_hz=np.inf)
        with SimulatedBench(IR50P, seed=3, unit=NO_PLAY, q0=motion.q_start, record_to=False) as bench:
            bench.plant.counts()  # one sample of noise apart
            made.append(bench.follow(pid, motion, 60))
    return made


def trained(record, *, rows="joint", columns="rigid", **steps):
    motion = process(record, **steps)
    Phi = regressor(motion.q, motion.qd, motion.qdd)
    return fit(Phi, motion.u, rows=rows, columns=columns, use=motion.use)


def test_each_step_of_the_way_from_the_thesis_to_the_full_method(records):
    train, valid = records
    naive, full = trained(train, rows="shared", columns="thesis", **NAIVE), trained(train, **FULL)
    as_thesis, best = validate(naive, valid, **NAIVE).fit, validate(full, valid, delay=0.02).fit
    assert (as_thesis > 40).all() and (as_thesis < 90).all() and (best > 88).all() and (best > as_thesis + 8).all()
    # most of the gap, or a large part, is the signals of the validation, not theta
    better_signals = validate(naive, valid, delay=0.02).fit
    share = (better_signals - as_thesis) / (best - as_thesis)
    assert (share > 0.2).all() and share.max() > 0.4
    # with q zero-phase, filtering u adds next to nothing
    filtered = validate(trained(train, filter_u=True, **FULL), valid, delay=0.02).fit
    assert np.abs(filtered - best).max() < 1.0
    # neither does the delay, though the inertia is wrong without it
    late = trained(train, slow=0.05)
    assert np.abs(validate(late, valid, delay=0.02).fit - best).max() < 2.0
    true = IR50P.theta_pwm[0, 0]
    assert abs(full.theta[0, 0] / true - 1) < 0.1 < abs(late.theta[0, 0] / true - 1)
    # no theta does better: what is left is stiction
    ceiling = validate(IR50P.theta_pwm, valid, delay=0.02).fit
    assert (best > ceiling - 2).all()
