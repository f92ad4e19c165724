"""Make data/excitation_ir50p.json: `python -m data.make_excitations`.

Some minutes; one where OPENBLAS_NUM_THREADS=1 is set (small matrices, on which more threads only wait).
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tqdm.auto import tqdm

from ir50p_lab.course.torque.views import thesis_pid
from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification import optimise_excitation, validate
from ir50p_lab.identification.excitation_file import DATA
from ir50p_lab.modelling import IR50P
from ir50p_lab.signals.fourier import heights
from ir50p_lab.simulation import simulate

CANDIDATES, KEPT = 200, 21
# The loop of the thesis lags and sags: room at the limits and over the table, or the arm runs into them.
SETTINGS = {"period": 13.75, "harmonics": 5, "periods": 8, "standing": 8.0, "margin": 0.2, "table": 0.15}
NOISE = (6.0, 5.0, 5.0)  # PWM counts rms that one count of the potentiometers makes in u with `thesis_pid`


@dataclass(frozen=True, kw_only=True, eq=False)
class SimulatedIdentification:
    """What `simulate_identification` found, per joint (3,).

    fit: best fit in % of the commands that a model without sticking can reach on such a run; spread: standard deviation
    of u; q: (n, 3) rad, as it was followed; room: (3,) rad to the nearer joint limit; height: m of the
    lower of elbow and tip over the table.
    """

    fit: np.ndarray
    spread: np.ndarray
    q: np.ndarray
    room: np.ndarray
    height: float

    def worth(self, floor=(90.0, 92.0, 93.0), *, room=0.05, height=0.03):
        """Least distance of any joint's fit from a floor, in %: the larger, the better the motion.

        -inf if the run comes nearer than `room` (rad) to a joint limit or `height` (m) to the table: there the bench
        cuts the drive, or the table pushes, and no model of the arm explains u.
        """
        if (self.room < room).any() or self.height < height:
            return -np.inf
        return float((self.fit - np.asarray(floor, dtype=float)).min())


def simulate_identification(reference, arm, controller, *, noise=5.0):
    """Simulate the closed loop on two periods of a motion: how much of u could a rigid-body model explain afterwards?

    An optimised motion is not the one that the arm makes: a weak controller lags and sags under gravity, and a joint
    that hardly moves sticks, where u may be anything up to the breakaway friction. No noise is drawn; `noise`, PWM
    counts rms in u, one number or (3,), is added to what is left as its root sum of squares.
    """
    start = reference.sample(np.zeros(1))[0, 0]
    run = simulate(arm, controller, reference, duration=2 * reference.period, q0=start, unit="PWM")
    found = validate(arm.theta_pwm, run.t, run.q, run.u, sign=0.05, cutoff_hz=1.2)
    spread = found.measured.std(axis=0)
    return SimulatedIdentification(
        fit=100 * (1 - np.hypot(found.rms, noise) / spread),
        spread=spread,
        q=run.q,
        room=np.minimum(run.q - arm.q_min, np.array(arm.q_max) - run.q).min(axis=0),
        height=float(np.min(heights(arm.l, run.q))),
    )


def make_excitations(arm=IR50P, *, seed=0, candidates=CANDIDATES, kept=KEPT, progress=True, **settings):
    """{name: Fourier}: 'plain', 'training', 'validation 1', ...: the best `kept` of `candidates` optimised motions.

    Each candidate is optimised from another seed, then simulated with the nominal arm and the thesis' gains; those on
    which a rigid-body model can explain most of u are kept. The first is for training, the others for validation.
    "plain" has random coefficients, as large as the limits allow, and keeps clear too.
    Args: arm: Arm with actuators; seed: of the first candidate; settings: for `optimise_excitation`.
    Raises IdentificationError if too few keep clear of limits and table.
    """
    speed = 0.9 * arm.actuators.no_load_speed
    options = {**SETTINGS, "max_joint_speed": speed, "progress": False, **settings}
    found = []
    for number in tqdm(range(seed, seed + candidates), disable=not progress, unit="motion", desc="excitation"):
        made = optimise_excitation(arm, seed=number, **options)
        worth = simulate_identification(made.reference, arm, thesis_pid(), noise=NOISE).worth()
        found.append((worth, number, made))
    found.sort(key=lambda one: -one[0])
    if found[kept - 1][0] == -np.inf:
        raise IdentificationError(
            f"of {candidates} motions only {sum(one[0] > -np.inf for one in found)} keep clear of limits and table in "
            f"the simulation, {kept} are wanted: try more candidates, or a larger margin and table"
        )
    best = [made for _, _, made in found[:kept]]
    befores = (made.before for _, _, made in found)
    clear = (
        motion for motion in befores if simulate_identification(motion, arm, thesis_pid()).worth((-1e9,) * 3) > -np.inf
    )
    motions = {"plain": next(clear, best[0].before), "training": best[0].reference}
    return motions | {f"validation {k}": made.reference for k, made in enumerate(best[1:], start=1)}


def save_excitations(path, motions, *, made_by):
    """Write {name: Fourier} to a JSON file for `load_excitations`, every digit kept. made_by: the command."""
    rows = {}
    for name, motion in motions.items():
        periods = round(motion.duration / motion.period)
        rows[name] = {"period": motion.period, "periods": periods, "q0": motion.q0, "a": motion.a, "b": motion.b}
    text = json.dumps({"made_by": made_by, "unit": "rad, s", "motions": rows}, indent=1)
    Path(path).write_text(text + "\n", encoding="ascii")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="of the first candidate")
    parser.add_argument("--out", default=str(DATA))
    given = parser.parse_args()
    command = "python -m data.make_excitations" + (f" --seed {given.seed}" if given.seed else "")
    save_excitations(given.out, make_excitations(seed=given.seed), made_by=command)
