"""Sweeps: the same computation for many cases, on all cores or on any executor.

A sweep that is stopped can go on later.
"""

import hashlib
import json
from collections import namedtuple
from concurrent.futures import as_completed
from pathlib import Path

import numpy as np

from ir50p_lab.errors import InputError


class Failure(namedtuple("Failure", "index case error")):
    """A case that raised: its number, the case itself, and the error as one line."""


class SweepResult(namedtuple("SweepResult", "cases results failures")):
    """The outcome of a sweep. cases, results: in the order given (None where it failed); failures: list of Failure."""


def sweep(run, cases, *, executor=None, progress=True, save_to=None):
    """Compute `run(case)` for every case, in parallel.

    Args:
        run: function of one case; its result is numbers, or dicts, lists and strings of them.
        cases: sequence of cases (numbers, strings, lists, dicts, arrays).
        executor: any `concurrent.futures` executor, such as `distributed.Client().get_executor()` of a Dask cluster;
            default: one process per core of this machine (loky, which also takes functions defined in a notebook).
        progress: whether a progress bar is shown.
        save_to: file to which every result is added as soon as it is there (JSON, one line per case). Called again with
            the same file and cases, the sweep goes on where it was interrupted. A file of another `run` or of
            other cases does no harm, because cases are found by their content and the name of `run`.

    Returns: SweepResult. A case that raises becomes a Failure and does not stop the others; the next call tries it
    again.
    Raises: InputError if `save_to` holds something other than a sweep, or a result cannot be written as JSON.
    """
    from tqdm.auto import tqdm

    cases = list(cases)
    name = f"{getattr(run, '__module__', '')}.{getattr(run, '__qualname__', repr(run))}"
    keys = [_key(name, case) for case in cases]
    known = {} if save_to is None else _read(Path(save_to))
    results = [known.get(key) for key in keys]
    failures, waiting = [], {}

    def take(future):
        i = waiting.pop(future)
        try:
            results[i] = _plain(future.result())
        except Exception as error:  # a case may fail in any way; it is reported with its case
            failures.append(Failure(index=i, case=cases[i], error=f"{type(error).__name__}: {error}"))
        else:
            if save_to is not None:
                _write(Path(save_to), keys[i], results[i])
        bar.update()

    done = sum(key in known for key in keys)
    with tqdm(total=len(cases), initial=done, disable=not progress, unit="case") as bar:
        pool = _all_cores() if executor is None else executor
        try:
            for i, key in enumerate(keys):
                if key not in known:
                    waiting[pool.submit(run, cases[i])] = i
            for future in as_completed(waiting):
                take(future)
        finally:  # after an interrupt: keep what is there, and do not begin the rest
            begun = [future for future in list(waiting) if not future.cancel()]
            try:
                for future in begun:
                    if future.done():
                        take(future)
            finally:
                if executor is None:
                    pool.shutdown(wait=False)
    failures.sort(key=lambda failure: failure.index)
    return SweepResult(cases=cases, results=results, failures=failures)


def _all_cores():
    from loky import ProcessPoolExecutor

    return ProcessPoolExecutor()


def _plain(value):
    """`value` with arrays as lists and NumPy numbers as Python's: the same after a trip through the file."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return value


def _key(name, case):
    try:
        text = json.dumps([name, _plain(case)], sort_keys=True)
    except TypeError as error:
        raise InputError(
            f"case {case!r} cannot be named in a file ({error}); use numbers, strings, lists, dicts"
        ) from None
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def _write(path, key, result):
    try:
        line = json.dumps({"case": key, "result": result})
    except TypeError as error:
        raise InputError(f"a result cannot be saved ({error}); return numbers, strings, lists or dicts") from None
    with path.open("a", encoding="utf-8") as file:
        file.write(line + "\n")


def _read(path):
    """{key: result} of the file of a sweep, which is made if there is none."""
    path.touch()
    *lines, rest = path.read_text(encoding="utf-8").split("\n")
    known = {}
    for number, line in enumerate(lines, start=1):
        try:
            entry = json.loads(line)
            known[entry["case"]] = entry["result"]
        except (json.JSONDecodeError, KeyError, TypeError, RecursionError):
            raise InputError(
                f"{path}, line {number}: not a line of a sweep; delete the file or name another in save_to"
            ) from None
    if rest:  # the process was killed while it wrote this line: that case is computed again
        path.write_text("".join(line + "\n" for line in lines), encoding="utf-8")
    return known
