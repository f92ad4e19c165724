"""`jit`: numba's njit, with a cache on disk that notices when any compiled file changed.

numba checks only the file of the function itself: machine code that has inlined a function or a constant of another,
since changed file would be used on, silently. Here the folder of the cache is named by a hash of all compiled files and
of those whose names they import.

Without numba, in a browser tab, `jit` is the identity: everything runs in plain Python, some fifty times slower.
"""

import functools
import hashlib
import os
import re
from pathlib import Path

try:
    import numba
except ImportError:
    numba = None

_PACKAGE = Path(__file__).parent


@functools.cache
def cache_folder():
    """Where the machine code of these sources lies: in the package, or in the user's cache if that is read-only.

    $NUMBA_CACHE_DIR goes before both.
    """
    sources = {path: path.read_bytes() for path in sorted(_PACKAGE.rglob("*.py"))}
    compiled = b"".join(text for text in sources.values() if b"@jit(" in text or b"@kernel(" in text)
    names = set(re.findall(r"^from ir50p_lab\.(\S+) import", compiled.decode(), re.MULTILINE))
    compiled += b"".join(sources.get(_PACKAGE / f"{name.replace('.', '/')}.py", b"") for name in sorted(names))
    own = _PACKAGE / "__pycache__"
    base = own if os.access(own, os.W_OK) else Path.home() / ".cache"
    return Path(numba.config.CACHE_DIR or base, f"ir50p_lab-{hashlib.sha1(compiled).hexdigest()[:16]}")


def jit(*, fastmath=("contract",), **options):
    """Decorator: numba's njit, compiled at the first call and kept on disk. options: of njit.

    Division by zero gives inf or NaN as in NumPy: the caller checks results once, not every operation. A product and a
    sum may be rounded once, together, where the processor can: simulations are a quarter quicker.
    """
    if numba is None:
        return lambda function: function
    return functools.partial(with_cache, numba.njit(cache=True, error_model="numpy", fastmath=set(fastmath), **options))


def with_cache(decorator, function):
    """Decorate a function by a decorator of numba's that shall keep its machine code in `cache_folder()`."""
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(cache_folder())
    try:
        return decorator(function)
    finally:
        numba.config.CACHE_DIR = before


def on_floats(function):
    """Without numba a loop over steps on Python's floats, some times as fast as on NumPy's; with it the loop itself.

    Tables (two indices) are only read; what is written into vectors is carried over.
    """
    if numba is not None:
        return function

    @functools.wraps(function)
    def plain(*arguments):
        own = [_floats(one) if hasattr(one, "tolist") else one for one in arguments]
        function(*own)
        for array, values in zip(arguments, own, strict=True):
            if type(values) is list:
                array[:] = values

    return plain


def _floats(array):
    if array.ndim == 1:
        return array.tolist()
    return {(i, j): value for i, row in enumerate(array.tolist()) for j, value in enumerate(row)}
