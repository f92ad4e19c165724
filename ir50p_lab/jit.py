"""`jit`, `gufunc`: numba's njit and guvectorize, with a cache on disk that notices when any compiled file changed.

numba checks only the file of the function itself: machine code that has inlined a function of another, since changed
file would be used on, silently. Here the folder of the cache is named by a hash of all compiled files.
"""

import contextlib
import functools
import hashlib
import os
import re
from pathlib import Path

import numba
from numba.core import event

from ir50p_lab.launcher.file_lock import take_lock

_PACKAGE = Path(__file__).parent


@functools.cache
def cache_folder():
    """Where the machine code of these sources lies: in the package, or in the user's cache if that is read-only.

    $NUMBA_CACHE_DIR goes before both.
    """
    sources = {str(p.relative_to(_PACKAGE)): p.read_bytes() for p in sorted(_PACKAGE.rglob("*.py"))}
    compiled = {name: text for name, text in sources.items() if b"@jit(" in text or b"@kernel(" in text}
    name = f"ir50p_lab-{hashlib.sha1(repr(compiled).encode()).hexdigest()[:16]}"
    own = _PACKAGE / "__pycache__"
    writable = os.access(own if own.exists() else _PACKAGE, os.W_OK)
    base = own if writable else Path.home() / ".cache"
    return Path(numba.config.CACHE_DIR or base, name)


def jit(**options):
    """Decorator: numba's njit, compiled at the first call and kept on disk. options: of njit.

    Division by zero gives inf or NaN as in NumPy: the caller checks results once, not every operation.
    """

    def decorate(function):
        with _own_cache():
            return numba.njit(cache=True, error_model="numpy", **options)(function)

    return decorate


def gufunc(function, layout):
    """A NumPy generalised ufunc of floats with this layout, such as "(n),(n)->(n)", compiled and kept on disk."""
    operands = [dims.split(",") if dims else [] for dims in re.findall(r"\((.*?)\)", layout)]
    types = [f"f8[{','.join(':' * len(dims))}]" if dims else "f8" for dims in operands]
    with _own_cache(), _no_other_process():
        compiled = numba.guvectorize([f"void({', '.join(types)})"], layout, nopython=True, cache=True)(function)
    return compiled.ufunc  # NumPy's own: without numba's look at the arguments


@contextlib.contextmanager
def _own_cache():
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(cache_folder())
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


@contextlib.contextmanager
def _no_other_process():
    """While a ufunc is compiled or loaded.

    numba keeps its two halves in two files that must come from one process. Of a mixture it calls the null pointer.
    """
    cache_folder().mkdir(parents=True, exist_ok=True)
    with open(cache_folder() / "lock", "a") as file:
        take_lock(file)
        yield


def says_that_it_compiles(function):
    """Decorator: a call that compiles says so, for it may take half a minute. Code that lies in the cache is not."""

    class Saying(event.RecordingListener):
        def on_start(self, compilation):
            if not self.buffer:
                print(f"{function.__name__} is compiled, once: up to 30 s...", flush=True)
            super().on_start(compilation)

    @functools.wraps(function)
    def wrapper(*args, **options):
        with event.install_listener("numba:compile", Saying()):
            return function(*args, **options)

    return wrapper
