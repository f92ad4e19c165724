"""The tables of targets beside the thesis: `python -m tests.targets [NAME ...] [--quick]`; without names, all of them.

A NAME is one of `NAMES`, or how some of them begin (`vision`). Each is a module here whose `rows(quick)` are the lines of
its table, below the first line of its docstring. The exit code is 0 when all targets are met, 1 when one is missed or
cannot be measured, 2 for a name or an option that there is not.
"""

import argparse
import importlib
import sys
import time
import traceback

from tests.targets.rows import table

NAMES = (
    "identification",
    "computed_torque",
    "vision_ball",
    "vision_calibration",
    "vision_table",
    "vision_reaching",
    "hostile",
    "unknown_arm",
)


def main(arguments=None):
    """Run the targets named, in their order; return the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.targets", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(NAMES))
    parser.add_argument("--quick", action="store_true", help="small samples of the same code")
    options = parser.parse_args(arguments)
    if unknown := [one for one in options.names if not any(name.startswith(one) for name in NAMES)]:
        parser.error(f"there are no targets '{unknown[0]}'; there are: {', '.join(NAMES)}")
    names = [name for name in NAMES if not options.names or name.startswith(tuple(options.names))]
    return max([_run(name, options.quick) for name in names])


def _run(name, quick):
    """The exit code of one; an error is shown and counts as missed, so that the others still run."""
    start = time.perf_counter()
    try:
        module = importlib.import_module(f"tests.targets.{name}")
        rows = list(module.rows(quick))
    except Exception:
        traceback.print_exc()
        print(f"{name}: could not be measured, see the error above", file=sys.stderr)
        return 1
    print(table(rows, module.__doc__.splitlines()[0]), end="\n\n", flush=True)
    print(f"{name}: {time.perf_counter() - start:.0f} s", file=sys.stderr)
    return int(any(row.ok is False for row in rows))


if __name__ == "__main__":
    sys.exit(main())
