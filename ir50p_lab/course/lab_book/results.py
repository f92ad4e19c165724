"""The chain of the student's own results: calibration (10), model (13), camera (17), each for the bench it comes from.

What a bench needs of them (`connect()` takes the calibration) is read in `bench.result_files`; all is written here.
"""

import contextlib
import dataclasses
import json
from datetime import datetime

import numpy as np

from ir50p_lab.bench.connect import connect
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.bench.result_files import Result, every, folder, newest
from ir50p_lab.bench.simulated import SimulatedBench
from ir50p_lab.errors import InputError, NotMeasuredError
from ir50p_lab.home import replace_text
from ir50p_lab.inputs import numbers

NOTEBOOKS = {"calibration": "10_bench_measure", "model": "13_is_the_model_good", "camera": "17_camera_calibration"}
_ENDINGS = {"calibration": ".toml", "model": ".model", "camera": ".yml"}
_RENDERED = {"bench": "rendered pictures", "bench_id": "rendered", "arm": "", "simulated": "true"}


def save_result(kind, value, more=None, measured_on=None):
    """Keep a result with its origin; later notebooks take the newest one. One line says what was kept.

        save_result("model", identify(recording), recording)
        save_result("model", theta, errors, recording)    # your own
        save_result("camera", calibration, T_base_cam)

    Args:
        kind: 'calibration' (of potentiometers), 'model' (what `identify` or `output_error` returns, or your own theta
        (3, 20) in PWM counts) or 'camera' (what `calibrate` returns). more: for your own theta its standard errors
        (3, 20), inf where the data do not tell, nan where it was not fitted; for a camera T_base_cam (4, 4), where it
        stands. measured_on: the open bench, or the Recording, from which it comes; it is the third argument if there is
        no `more`. None: rendered pictures of a camera, or the simulated arm of your own theta.

    From a board without an id nothing is kept; the line says so. Raises InputError for another kind, a theta or errors
    of another shape, for a T_base_cam that is not a rigid transform, and if it cannot be written.
    """
    _check(kind)
    if hasattr(more, "header") or hasattr(more, "bench_id"):
        more, measured_on = measured_on, more
    if kind == "camera" and more is not None:
        value = _standing(value, more)
    if kind == "model" and not hasattr(value, "residuals"):
        measured_on = measured_on or SimulatedBench(record_to=False)
        value = _own_model(*((value.theta, value.stderr) if hasattr(value, "stderr") else (value, more)))
    head = _origin(measured_on, kind)
    if head.get("bench_id", "none") == "none":
        print("Not kept: nobody knows which bench this is from. python3 -m ir50p_lab bench-test gives a board its id")
        return
    write = (lambda path: _write_model(value, path)) if kind == "model" else value.save
    simulated = head.get("simulated") == "true"
    unit, seed = head.get("seed", "") if simulated else "", head.get("noise_seed", "")
    about = {name: head.get(name, "") for name in ("arm", "bench", "bench_id")}
    print("Kept:", add(kind, write, simulated=simulated, unit=unit, seed=seed, **about))


def add(kind, write, **about):
    """Keep a result, and return it. write: function (path) that writes the numbers; about: the other fields of Result.

    Raises InputError if it cannot be written.
    """
    number = 1 + max((int(one.name.rpartition("-")[2]) for one in every() if one.kind == kind), default=0)
    name, now, ending = f"{kind}-{number}", datetime.now().astimezone().isoformat(), _ENDINGS[kind]
    result = Result(name=name, kind=kind, made=now, chosen=now, withdrawn=False, file=name + ending, **about)
    try:
        folder().mkdir(parents=True, exist_ok=True)
        write(result.path)
        _describe(result)
    except OSError as error:
        raise InputError(f"cannot keep {name} in {folder()}: {error.strerror}; set IR50P_HOME to a folder") from None
    return result


def _describe(result):
    replace_text(folder() / f"{result.name}.json", json.dumps(result._asdict(), indent=1) + "\n")


def load_result(kind, bench, course=None):
    """Return your newest result of this kind for a bench; a simulated arm without one gets the course's.

    One line says whose it is.

    Args: kind: 'model' or 'camera' (`connect()` takes the calibration by itself). bench: the bench for which it is
    needed: what was measured on another one does not count. course: function () -> what the course has instead.
    Raises NotMeasuredError for a real arm on which nothing was measured; InputError for a damaged file.
    """
    found = newest_result(kind, bench)
    if found is None and not bench.simulated:
        raise NotMeasuredError(f"{_missing(kind, bench)}: measure first, with notebook {NOTEBOOKS[kind]}")
    if found is None:
        print(f"The course's {kind}: {_missing(kind, bench)} (notebook {NOTEBOOKS[kind]} does)")
        return course()
    print(f"Your {found}")
    return _read(found)


def newest_result(kind, bench):
    """Return the Result of this kind that counts for a bench, or None if there is none."""
    _check(kind)
    if kind == "camera" and bench.simulated:
        return newest(kind, _RENDERED["bench_id"], "")
    return newest(kind, bench.bench_id, bench.arm.name) if bench.bench_id else None


def results(*, choose=None, withdraw=None):
    """Return your results as a table, with the one that counts for its bench marked.

    Args: choose: name of a result that counts from now on, whatever is newer; withdraw: name of one that no longer
    counts (`choose` takes it back). Returns: pandas.DataFrame.
    """
    import pandas as pd

    for name in filter(None, (choose, withdraw)):
        known = {one.name: one for one in every()}
        if name not in known:
            raise InputError(f"there is no result {name!r}: {', '.join(known) or 'none at all'}")
        chosen = known[name].chosen if name == withdraw else datetime.now().astimezone().isoformat()
        _describe(known[name]._replace(withdrawn=name == withdraw, chosen=chosen))
    found = every()
    table = pd.DataFrame(found, columns=Result._fields, dtype=object).set_index("name")
    counts = [one == newest(one.kind, one.bench_id, one.arm) for one in found]
    table["state"] = np.where(table.withdrawn, "withdrawn", np.where(counts, "counts", ""))
    table["made"] = table.made.str[:16].str.replace("T", " ")
    table["arm is"] = np.where(table.simulated, "simulated", "real")
    return table[["state", "made", "bench", "bench_id", "arm is", "unit", "seed"]]


def arm_that_answers(*needs, **options):
    """Return the open bench of `connect(**options)`, or the simulated arm if that bench cannot do what a cell needs.

    A line says why. A recording does not answer. A real arm needs the results named in `needs` ('calibration', 'model',
    'camera'), measured on this very bench: no law that rests on a model of another arm ever drives it.
    """
    bench = connect(**options)
    missing = [kind for kind in needs if not bench.simulated and newest_result(kind, bench) is None]
    if bench.kind != "replay" and not missing:
        return bench
    bench.abort()  # it has not moved
    why = "a recording does not answer"
    if bench.kind != "replay":
        todo = "; ".join(f"{_missing(kind, bench)} (notebook {NOTEBOOKS[kind]} does)" for kind in missing)
        why = f"measure first: {todo}"
    print(f"The simulated arm instead: {why}")
    return connect("simulated", **options)


@contextlib.contextmanager
def arm_at_rest(arm, *needs):
    """Return the open bench of `arm_that_answers(*needs)` for this arm, which has been moved to its rest pose."""
    with arm_that_answers(*needs, arm=arm, q0=rest_pose(arm)) as bench:
        next(bench.run(seconds=0.02, record=False))  # where is it?
        bench.go_to_rest()
        yield bench


def _missing(kind, bench):
    return f"no {kind} of yours was measured on {bench.name if kind != 'camera' or not bench.simulated else 'pictures'}"


def _check(kind):
    if kind not in NOTEBOOKS:
        raise InputError(f"kind = {kind!r}: choose {', '.join(NOTEBOOKS)}")


def _origin(measured_on, kind):
    """Lines of the head of a recording that say where something is from."""
    if measured_on is None and kind == "camera":
        return _RENDERED
    if hasattr(measured_on, "header"):
        return measured_on.header
    if not hasattr(measured_on, "bench_id"):
        raise InputError(f"measured_on = {measured_on!r:.60}: give the open bench or the Recording that it is from")
    return measured_on.head()


def _own_model(theta, errors):
    """An Estimate of a theta (3, 20) in PWM counts and its standard errors (3, 20), None: not known."""
    from ir50p_lab.identification import Estimate
    from ir50p_lab.identification.parameters import NAMES

    theta, stderr = numbers("theta", theta), numbers("errors", np.full((3, 20), np.nan) if errors is None else errors)
    if not theta.shape == stderr.shape == (3, 20) or not np.isfinite(theta).all() or (stderr < 0).any():
        raise InputError(f"theta {theta.shape}, errors {stderr.shape}: give both (3, 20), theta finite, errors >= 0")
    spread = np.where(np.isfinite(stderr), stderr, 0.0)[:, :, None] ** 2 * np.eye(20)
    columns = tuple(tuple(np.array(NAMES)[np.isfinite(row)].tolist()) for row in stderr)
    unknown = {"condition": np.full(3, np.nan), "sigma": np.full(3, np.nan), "residuals": np.zeros((0, 3))}
    said = {"columns": columns, "unidentifiable": (), "warnings": (), "method": "your own"}
    return Estimate(theta=theta, stderr=stderr, covariance=spread, **unknown, **said)


def _standing(camera, T_base_cam):
    """The Calibration of a camera that stands there."""
    from ir50p_lab.vision.arguments import rigid

    return dataclasses.replace(camera, T_base_cam=rigid("T_base_cam", T_base_cam))


def _write_model(model, path):
    fields = dataclasses.asdict(model) | {"residuals": np.round(model.residuals, 4)}
    path.write_text(json.dumps(fields, default=np.ndarray.tolist), encoding="utf-8")


def _read(found):
    if found.kind == "camera":
        from ir50p_lab.vision import Calibration

        return Calibration.load(found.path)
    from ir50p_lab.identification import Estimate

    try:
        listed = json.loads(found.path.read_text(encoding="utf-8"))
        arrays = {one.name for one in dataclasses.fields(Estimate) if one.type is np.ndarray}
        fields = {name: np.array(value) if name in arrays else value for name, value in listed.items()}
        return Estimate(**{name: _tuples(value) for name, value in fields.items()})
    except (OSError, ValueError, TypeError, RecursionError) as error:
        raise InputError(f"{found.path} is not a model ({error!r:.80}): results(withdraw={found.name!r})") from None


def _tuples(value):
    return tuple(map(_tuples, value)) if isinstance(value, list) else value
