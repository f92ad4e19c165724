"""The test command: ``python3 -m ir50p_lab test``, further arguments go to pytest.

--quick        without notebooks, the emulated board, and what takes long or measures time
--all          as in CI: each notebook with its dots, too, and what is marked `ci` (students, pages in a browser)
--everywhere   notebooks and the tests marked `numeric`, as on other processors and other arms: tests/everywhere.py
"""

import subprocess
import sys

from tests import everywhere

PYTEST = [sys.executable, "-m", "pytest"]
FAILED, NOTHING_FOUND = 1, 5  # pytest's exit codes
MINUTES = 25  # of one processor, with a compiler for the board, without other work beside it


def main(arguments):
    """Run pytest on all cores, then one at a time what measures time, which may fail once; return the exit code."""
    if "--everywhere" in arguments:
        return everywhere.main([argument for argument in arguments if argument != "--everywhere"])
    together = [*PYTEST, *everywhere.PARALLEL, "--timing=without", *arguments]
    alone = [*PYTEST, "-p", "no:xdist", "--timing=only", *arguments]
    if any(argument.startswith("--cov") for argument in arguments):
        alone.append("--cov-append")
    if not arguments:
        print(
            f"This takes some {MINUTES} minutes of one processor; each notebook is named when it is done.", flush=True
        )
    codes = [subprocess.run(together).returncode]
    if "--quick" not in arguments:
        codes.append(subprocess.run(alone).returncode)
        if codes[-1] == FAILED:
            print("What measures time depends on what else runs here: once more what has failed.", flush=True)
            codes[-1] = subprocess.run([*alone, "--last-failed"]).returncode
    return max((code for code in codes if code != NOTHING_FOUND), default=NOTHING_FOUND)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
