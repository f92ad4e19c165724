"""All targets of the vision part as one table beside the thesis: `python -m tests.targets.vision [--quick]`.

Each part is a module with `rows(quick)` -> list of Row: the ball (notebook 16), the calibration and the
table plane (17) and reaching (18). `--quick` runs small samples of the same code. `--only ball` runs one part.
The exit code is 1 when a target is missed or a part fails.
"""

import argparse
import importlib
import sys
import time

from tests.targets.rows import Row, table

PARTS = ("ball", "calibration", "table", "reaching")


def part(name, quick):
    """The rows of one part; a part that fails is a row that says so, and the other parts still run."""
    try:
        return list(importlib.import_module(f"tests.targets.vision_{name}").rows(quick=quick))
    except Exception as error:
        return [Row(f"{name}: does not run", "-", f"{type(error).__name__}: {error}"[:90], ok=False)]


def main(arguments=None):
    """Run the parts and print their tables; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.targets.vision", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small samples of the same code")
    parser.add_argument("--only", choices=PARTS, action="append", help="this part only; may be given again")
    options = parser.parse_args(arguments)
    rows = []
    for name in options.only or PARTS:
        start = time.perf_counter()
        rows += part(name, options.quick)
        print(f"{name}: {time.perf_counter() - start:.0f} s", file=sys.stderr)
    size = "small samples" if options.quick else "full samples"
    print(table(rows, f"Vision: targets, measured on rendered pictures and the simulated arm ({size})"))
    return int(any(row.ok is False for row in rows))


if __name__ == "__main__":
    sys.exit(main())
