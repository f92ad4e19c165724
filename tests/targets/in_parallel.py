"""Samples of a target spread over the processors, with a progress bar: a full run then takes minutes, not an hour."""

import os
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from tqdm.auto import tqdm


def mapped(function, items, what):
    """[function(item) for item in items]; function: of a module; what: the words beside the bar."""
    # one BLAS thread each: they would only be in each other's way; a process that is spawned reads it when it starts
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        return list(tqdm(pool.map(function, items, chunksize=5), total=len(items), desc=what))
