"""Sweeps: the same computation for many cases, on all cores or on any executor, resumable, failures kept apart."""

import hashlib
import json
import os
from concurrent.futures import FIRST_COMPLETED, wait
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ir50p_lab.errors import InputError


@dataclass(frozen=True)
class Failure:
    """A case that raised: its number, the case, and the error as one line."""

    index: int
    case: object
    error: str


@dataclass(frozen=True)
class SweepResult:
    """cases and results in the order given (None where it failed); failures: list of Failure."""

    cases: list
    results: list
    failures: list


def sweep(run, cases, *, executor=None, progress=True, save_to=None):
    """Compute `run(case)` for every case.

    Args:
        run: function of one case; its result is numbers, or dicts, lists and strings of them.
        cases: sequence of cases (numbers, strings, lists, dicts, arrays).
        executor: any `concurrent.futures` executor, such as `distributed.Client().get_executor()` of a Dask cluster;
            default: one process per core of this machine (loky, which also takes functions defined in a notebook).
        progress: show a progress bar.
        save_to: file to which every result goes as soon as it is there (JSON, one line per case). Called again with
            the same file and cases, the sweep goes on where it was interrupted. A file of another `run` or of
            other cases does no harm: cases are found by their content, under the name of `run`.

    Returns: SweepResult. A case that raises becomes a Failure and does not stop the others; it is tried again on the
    next call.
    Raises: InputError if `save_to` holds something else than a sweep, or a result cannot be written as JSON.
    """
    from tqdm.auto import tqdm

    cases = list(cases)
    name = f"{getattr(run, '__module__', '')}.{getattr(run, '__qualname__', repr(run))}"
    keys = [_key(name, case) for case in cases]
    known = _read(save_to)
    results = [known.get(key) for key in keys]
    todo = [i for i, key in enumerate(keys) if key not in known]
    failures = []
    file = Path(save_to).open("a", encoding="utf-8") if save_to is not None else None
    pool, own = (executor, False) if executor is not None else (_all_cores(), True)
    bar = tqdm(total=len(cases), initial=len(cases) - len(todo), disable=not progress, unit="case")
    waiting = {}
    try:
        queue = iter(todo)
        # a few cases ahead of the workers: an interrupt then loses little, and memory stays small
        for i in queue:
            waiting[pool.submit(run, cases[i])] = i
            if len(waiting) >= 64:
                _collect(waiting, cases, keys, results, failures, file, bar)
        while waiting:
            _collect(waiting, cases, keys, results, failures, file, bar)
    finally:
        finished = [future for future in waiting if future.done()]  # after an interrupt: keep what is there
        _take(finished, waiting, cases, keys, results, failures, file, bar)
        for future in waiting:
            future.cancel()
        if own:
            pool.shutdown(wait=False)
        if file is not None:
            file.close()
        bar.close()
    failures.sort(key=lambda failure: failure.index)
    return SweepResult(cases=cases, results=results, failures=failures)


def _all_cores():
    from loky import ProcessPoolExecutor

    return ProcessPoolExecutor(max_workers=os.cpu_count())


def _collect(waiting, cases, keys, results, failures, file, bar):
    """Take what is ready from `waiting`, at least one result."""
    ready, _ = _wait(waiting)
    _take(ready, waiting, cases, keys, results, failures, file, bar)


def _take(ready, waiting, cases, keys, results, failures, file, bar):
    for future in ready:
        i = waiting.pop(future)
        try:
            results[i] = _plain(future.result())
        except Exception as error:  # a case may fail in any way; it is reported with its case
            failures.append(Failure(index=i, case=cases[i], error=f"{type(error).__name__}: {error}"))
        else:
            if file is not None:
                _write(file, keys[i], results[i])
        bar.update(1)


def _wait(futures):
    first = next(iter(futures))
    if type(first).__module__.startswith("distributed"):  # Dask futures have their own wait
        import distributed

        return distributed.wait(list(futures), return_when=FIRST_COMPLETED)
    return wait(futures, return_when=FIRST_COMPLETED)


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


def _write(file, key, result):
    try:
        line = json.dumps({"case": key, "result": result})
    except TypeError as error:
        raise InputError(f"a result cannot be saved ({error}); return numbers, strings, lists or dicts") from None
    file.write(line + "\n")
    file.flush()


def _read(path):
    if path is None or not Path(path).exists():
        return {}
    known = {}
    lines = Path(path).read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, start=1):
        try:
            entry = json.loads(line)
            known[entry["case"]] = entry["result"]
        except (json.JSONDecodeError, KeyError, TypeError, RecursionError):
            if number == len(lines):
                _cut_last_line(path)  # the process was killed while it wrote: that case is computed again
                break
            raise InputError(
                f"{path}, line {number}: not a line of a sweep; delete the file or name another in save_to"
            ) from None
    return known


def _cut_last_line(path):
    data = Path(path).read_bytes()
    Path(path).write_bytes(data[: data.rstrip(b"\n").rfind(b"\n") + 1])
