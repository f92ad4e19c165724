"""Inside the process of one student: functions come in as JSON, are checked by the engine of `check`, verdicts go out.

Each function is judged with the course's own in place of the earlier ones that it calls: what is wrong there serves
nobody here. The verdict is made where the student's code runs, so whoever gets past the gate can forge one.
"""

import contextlib
import json
import os
import re
import signal
import sys

from ir50p_lab.course.checking import tasks
from ir50p_lab.course.checking.cell import cut
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.judge_text import CannotTake, has_dots

SECONDS = 5  # of the processor, for one function
_MEMORY = 4 << 30  # bytes
_NOBODY = 65534


def verdict(name, text):
    """Return (state, sentence) for the text of a function's file; state: "right", "wrong", "loan" or "open"."""
    first = text.partition("\n")[0]
    if first.startswith("# on loan"):
        return "loan", ""
    if ", stage " in first and first.startswith("#"):
        return "open", f"only its stage {first.partition(', stage ')[2].partition(':')[0]} is written"
    wanted = tasks.task(name)
    text = re.sub(r"^from \._\w+ import \w+$", "", text, flags=re.MULTILINE)
    try:
        source = cut(text, name, wanted.leans_on, wanted.given, wanted.function_arguments)
        if has_dots(source.text):
            return "open", "there are still dots in it"
        _allow(SECONDS)
        found = grade(wanted, source)
        return found.state, found.says
    except CannotTake as reason:
        return "wrong", f"not run: {reason}"
    except KeyboardInterrupt:
        return "wrong", f"it did not end within {SECONDS} s"
    except BaseException as error:
        return "wrong", f"it stops: {type(error).__name__}: {error}"[:300]
    finally:
        _allow(0)


def _allow(seconds):
    """Interrupt what takes longer; where there is no such timer the limit of the whole student stands alone."""
    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGPROF, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_PROF, seconds)


def lock_up(seconds=None):
    """Allow from now on no new process, no written file, little memory, no rights of root; seconds: of processor time.

    Windows has no such limits.
    """
    try:
        import resource
    except ImportError:
        return
    if os.geteuid() == 0:  # whom the limit of processes does not hold
        with contextlib.suppress(OSError):  # a sandbox has its own root, who is nobody outside
            os.setgroups([])
            os.setresgid(_NOBODY, _NOBODY, _NOBODY)
            os.setresuid(_NOBODY, _NOBODY, _NOBODY)
    limits = {"FSIZE": 0, "NOFILE": 64, "NPROC": 0, "CORE": 0}
    if sys.platform == "linux":  # macOS counts what is shared
        limits["AS"] = _MEMORY
    if seconds is not None:
        limits["CPU"] = seconds
    for what, most in limits.items():
        resource.setrlimit(getattr(resource, f"RLIMIT_{what}"), (most, most))


def main():
    """Read {name: text} from the standard input; write a line of JSON for each verdict."""
    functions = json.loads(sys.stdin.readline())
    for name in functions:  # all that the course needs is there before the limits are
        wanted = tasks.task(name)
        grade(wanted, wanted.reference)
    told = os.fdopen(os.dup(1), "w", encoding="utf-8")
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nothing, stream)  # what a function prints, nobody reads
    lock_up()
    for name, text in functions.items():
        print(json.dumps([name, *verdict(name, text)]), file=told, flush=True)


if __name__ == "__main__":
    main()
