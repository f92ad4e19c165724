"""Times of the processor, in which other programs count less than by the clock."""

import time

import numpy as np


def processor_time(*calls, rounds):
    """Shortest time of each call, taken in turns, s."""
    took = np.full(len(calls), np.inf)
    for _ in range(rounds):
        for k, call in enumerate(calls):
            start = time.process_time()
            call()
            took[k] = min(took[k], time.process_time() - start)
    return took
