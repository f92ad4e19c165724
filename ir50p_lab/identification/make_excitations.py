"""Make data/excitation_ir50p.json: `python -m ir50p_lab.identification.make_excitations`.

Some minutes; one where OPENBLAS_NUM_THREADS=1 is set (small matrices, on which more threads only wait).
"""

import argparse

import numpy as np

from ir50p_lab.controllers import PID
from ir50p_lab.errors import IdentificationError
from ir50p_lab.identification.excitation import optimise_excitation
from ir50p_lab.identification.excitation_file import DATA, save_excitations
from ir50p_lab.identification.simulated_identification import simulate_identification
from ir50p_lab.modelling import IR50P

CANDIDATES, KEPT = 200, 21
# The loop of the thesis lags and sags: room at the limits and over the table, or the arm runs into them.
SETTINGS = {"period": 13.75, "harmonics": 5, "periods": 8, "standing": 8.0, "margin": 0.2, "table": 0.15}
NOISE = (6.0, 5.0, 5.0)  # PWM counts rms that one count of the potentiometers makes in u with `thesis_pid`


def thesis_pid():
    """The PID of Tables 4.1-4.3 behind a 3 Hz filter on the angles, in PWM counts."""
    gains = {"kp": (289, 225, 270), "ki": (50, 10, 50), "kd": (40, 30, 30)}
    return PID(**gains, limit_pwm=255, position_filter_hz=3.0, filter_hz=np.inf)


def make_excitations(arm=IR50P, *, seed=0, candidates=CANDIDATES, kept=KEPT, progress=True, **settings):
    """{name: Fourier}: 'plain', 'training', 'validation 1', ...: the best `kept` of `candidates` optimised motions.

    Each candidate is optimised from another seed, then simulated with the nominal arm and the thesis' gains; those on
    which a rigid-body model can explain most of u are kept. The first is for training, the others for validation.
    "plain" has random coefficients, as large as the limits allow, and keeps clear too.
    Args: arm: Arm with actuators; seed: of the first candidate; settings: for `optimise_excitation`.
    Raises IdentificationError if too few keep clear of limits and table.
    """
    from tqdm.auto import tqdm

    speed = 0.9 * arm.actuators.no_load_speed
    options = {**SETTINGS, "max_joint_speed": speed, "starts": 2, "iterations": 50, "progress": False, **settings}
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


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="of the first candidate")
    parser.add_argument("--out", default=str(DATA))
    given = parser.parse_args()
    command = "python -m ir50p_lab.identification.make_excitations" + (f" --seed {given.seed}" if given.seed else "")
    print(save_excitations(given.out, make_excitations(seed=given.seed), made_by=command))
