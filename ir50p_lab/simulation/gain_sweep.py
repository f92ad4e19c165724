"""PID gain sweeps at full speed: thousands of gain sets a second, figures of merit only."""

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import numbers, vector3
from ir50p_lab.simulation.batch import LANES, METRICS, pid_batch
from ir50p_lab.simulation.plant import make_plant
from ir50p_lab.simulation.simulate import _target, _times, sampled


@dataclass(frozen=True)
class GainSweep:
    """Figures of merit of N gain sets, (N, 3) per joint; NaN where a run left all bounds (`unstable` (N,)).

    rms_error rad; overshoot rad past the set point; settling_time s (last time outside 2 % of the step about the set
    point; the duration if never inside to the end); end_error rad (set point - angle); peak_command in the unit of u;
    saturated_time s with the command at its limit; top_speed rad/s.
    """

    kp: np.ndarray
    ki: np.ndarray
    kd: np.ndarray
    rms_error: np.ndarray
    overshoot: np.ndarray
    settling_time: np.ndarray
    end_error: np.ndarray
    peak_command: np.ndarray
    saturated_time: np.ndarray
    top_speed: np.ndarray
    unstable: np.ndarray


def sweep_gains(
    arm,
    reference,
    *,
    kp,
    ki=0.0,
    kd=0.0,
    limit=np.inf,
    limit_pwm=None,
    duration=10.0,
    period=0.01,
    step=0.001,
    filter_hz=10.0,
    q0=(0.0, 0.0, 0.0),
    g=None,
    executor=None,
    progress=True,
):
    """Simulate the sampled `PID` for many gain sets at once; the numbers are, up to rounding, those of `simulate`.

    Args:
        arm: Arm without dry friction (`arm.without_friction()`), or such a theta. In-line links.
        reference: as in `simulate`.
        kp, ki, kd: (N, 3), or what broadcasts to it (scalars, (3,), (N, 1)).
        limit / limit_pwm, duration, period, step, filter_hz, q0, g: as in `simulate` and `PID`.
        executor: `concurrent.futures` executor for blocks of gain sets (a Dask client's, say); default: threads on all
            cores (the compiled loop does not hold Python's lock).
        progress: show a progress bar.

    Returns: GainSweep. Raises InputError on bad input, or an arm with dry friction (use `sweep` with `simulate`).
    """
    from tqdm.auto import tqdm

    steps, t = _times(duration, period, step)
    q0 = vector3("q0", q0)
    plant = make_plant(arm, unit="N m" if limit_pwm is None else "PWM", g=g)
    if plant.dry:
        raise InputError(
            "sweep_gains is for motion without dry friction: use arm.without_friction(), or sweep + simulate"
        )
    if plant.theta[:, 6:8].any():
        raise InputError("sweep_gains needs theta 7 and 8 to be 0 (in-line links); use sweep + simulate for this theta")
    kp, ki, kd = _gain_sets(kp=kp, ki=ki, kd=kd)
    bound = np.broadcast_to(np.asarray(limit if limit_pwm is None else limit_pwm, dtype=float), 3).copy()
    if not (bound > 0).all() or not filter_hz > 0:
        raise InputError(f"limit {bound.tolist()} and filter_hz {filter_hz} must be positive")
    r = sampled(_target(reference, q0), t)
    jobs = [slice(i, i + LANES) for i in range(0, len(kp), LANES)]
    pool = executor or ThreadPoolExecutor(os.cpu_count())
    out = np.empty((len(METRICS), 3, len(kp)))
    try:
        with tqdm(total=len(kp), disable=not progress, unit="sim") as bar:
            common = (bound, period, 2 * np.pi * filter_hz, r, np.append(q0, np.zeros(3)), step, steps)
            blocks = [
                pool.submit(run_block, plant.theta, plant.numbers, kp[job], ki[job], kd[job], *common) for job in jobs
            ]
            for job, block in zip(jobs, blocks, strict=True):
                out[:, :, job] = block.result()
                bar.update(len(kp[job]))
    finally:
        if executor is None:
            pool.shutdown(cancel_futures=True)
    unstable = ~np.isfinite(out).all(axis=(0, 1))
    out[:, :, unstable] = np.nan
    named = {name: out[i].T.copy() for i, name in enumerate(METRICS)}
    return GainSweep(kp=kp, ki=ki, kd=kd, unstable=unstable, **named)


def run_block(theta, n, kp, ki, kd, bound, period, rate, r, x0, step, steps):
    """One block of at most LANES gain sets, each (W, 3): returns (7, 3, W). Runs on any worker."""
    lanes = [np.ascontiguousarray(np.resize(gains, (LANES, 3)).T) for gains in (kp, ki, kd)]  # filled up by repeating
    return pid_batch(theta, n, *lanes, bound, period, rate, r, x0, step, steps)[:, :, : len(kp)]


def _gain_sets(**sets):
    arrays = {}
    for name, value in sets.items():
        array = numbers(name, value)
        wrong = array[~(np.isfinite(array) & (array >= 0))]
        if wrong.size:
            raise InputError(f"{name} holds {wrong[0]}; every gain must be finite and >= 0")
        arrays[name] = np.atleast_2d(array)
    try:
        shape = np.broadcast_shapes(*(a.shape for a in arrays.values()), (1, 3))
    except ValueError:
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items())
        raise InputError(f"gain shapes do not fit: {shapes}; give (N, 3), (3,) or scalars") from None
    return [np.ascontiguousarray(np.broadcast_to(a, shape)) for a in arrays.values()]
