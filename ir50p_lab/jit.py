"""`jit`: numba's njit with a cache on disk that notices when any compiled file of the package changed.

numba checks only the file of the function itself: machine code that has inlined a function of another, since changed
file would be used on, silently. Here all cached code is dropped when any of the files changed.
"""

import contextlib
import functools
import gc
from pathlib import Path

_collects = gc.isenabled()
gc.disable()  # what an import builds stays: looking through it for garbage is a tenth of its time
try:
    import numba
    from numba.core import event
    from numba.core.registry import cpu_target

    cpu_target.target_context.refresh()  # what numba loads at the first call
finally:
    gc.freeze()  # nor is it looked through later
    if _collects:
        gc.enable()

_PACKAGE = Path(__file__).parent
_STAMP = _PACKAGE / "__pycache__" / "compiled_from.txt"


def _drop_stale_code():
    sources = sorted(path for path in _PACKAGE.rglob("*.py") if b"@jit(" in path.read_bytes())
    state = "\n".join(f"{p.relative_to(_PACKAGE)} {p.stat().st_mtime_ns} {p.stat().st_size}" for p in sources)
    with contextlib.suppress(OSError):  # a read-only installation: numba then keeps its cache elsewhere
        if not _STAMP.exists() or _STAMP.read_text() != state:
            for path in _PACKAGE.rglob("__pycache__/*.nb[ic]"):
                path.unlink(missing_ok=True)
            _STAMP.parent.mkdir(exist_ok=True)
            _STAMP.write_text(state)


_drop_stale_code()

# division by zero gives inf or NaN as in NumPy: the caller checks results once, not every operation
jit = functools.partial(numba.njit, cache=True, error_model="numpy")


class _Once(event.Listener):
    """Prints a line when the first function is compiled; code that lies in the cache is not."""

    def __init__(self, line):
        self._line = line

    def on_start(self, _):
        if self._line:
            print(self._line, flush=True)
        self._line = ""

    def on_end(self, _):
        pass


def says_that_it_compiles(function):
    """Decorator: a call that compiles says so, for it may take half a minute."""

    @functools.wraps(function)
    def wrapper(*args, **options):
        with event.install_listener("numba:compile", _Once(f"{function.__name__} is compiled, once: up to 30 s...")):
            return function(*args, **options)

    return wrapper
