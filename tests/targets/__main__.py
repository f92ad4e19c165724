"""The tables of targets beside the thesis: `python -m tests.targets [NAME ...] [...]`; NAME: one of `NAMES`.

Without names, all of them. What follows the names goes to each: `--quick`, or what `vision --help` lists. Every name is a
module here with `main(arguments)`, which prints its table and returns 1 when a target is missed. The exit code is 0 when
all targets are met, 1 when one is missed or cannot be measured, 2 for a name or an option that there is not.
"""

import importlib
import itertools
import sys
import traceback

NAMES = ("identification", "computed_torque", "vision", "hostile", "unknown_arm")


def main(arguments):
    """Run the targets named, in their order; return the exit code."""
    names = list(itertools.takewhile(lambda argument: not argument.startswith("-"), arguments))
    options = arguments[len(names) :]
    unknown = [name for name in names if name not in NAMES]
    if unknown:
        print(f"There are no targets '{unknown[0]}'. There are: {', '.join(NAMES)}.", file=sys.stderr)
        return 2
    if not names and options in (["-h"], ["--help"]):
        print(__doc__.strip())
        return 0
    codes = []
    for name in names or NAMES:
        if codes:
            print()
        codes.append(_run(name, options))
        sys.stdout.flush()
    return max(codes)


def _run(name, options):
    """The exit code of one; an error is shown and counts as missed, so that the others still run."""
    try:
        return importlib.import_module(f"tests.targets.{name}").main(list(options))
    except SystemExit as end:  # argparse: a wrong option, or --help
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except Exception:
        traceback.print_exc()
        print(f"{name}: could not be measured, see the error above", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
