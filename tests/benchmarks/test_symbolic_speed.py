"""Speed of the derivation: `pytest tests/benchmarks --benchmark-enable -s`.

The notebook derives the equations of motion while the student waits: below 0.2 s it feels live. SymPy alone needs
seconds, nearly all of them to simplify.
"""

import time

from ir50p_lab.modelling.symbolic import derive


def test_derivation_feels_live(request):
    times = []
    for _ in range(5):
        start = time.perf_counter()
        derive()
        times.append(time.perf_counter() - start)
    print(f"\nM, C and g by derive(): {1e3 * min(times):.0f} ms (target 200 ms)")
    assert min(times) < 0.2 or not request.config.getoption("benchmark_enable")
