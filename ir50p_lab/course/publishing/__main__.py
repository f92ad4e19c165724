"""`python -m ir50p_lab.course.publishing NOTEBOOK...`, which the command `export` runs."""

import argparse
import sys
from pathlib import Path

from ir50p_lab.course.publishing.export import export
from ir50p_lab.errors import LabError


def main(arguments=None):
    """Export the given notebooks; return the exit code."""
    parser = argparse.ArgumentParser(
        prog="python3 -m ir50p_lab export",
        description="Run notebooks and write each as one HTML page that needs no network, and as PDF.",
    )
    parser.add_argument("notebooks", nargs="+", type=Path, metavar="NOTEBOOK")
    parser.add_argument(
        "--to", type=Path, default=Path("."), metavar="FOLDER", help="where the pages go (default: here)"
    )
    parser.add_argument("--as-it-is", action="store_true", help="with the outputs that are stored, without running it")
    parser.add_argument("--no-pdf", action="store_true", help="HTML only")
    options = parser.parse_args(arguments)
    try:
        for path in options.notebooks:
            for written in export(path, options.to, run=not options.as_it_is, pdf=not options.no_pdf):
                print(written)
    except LabError as problem:
        print(problem, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
