"""`jit`: numba's njit, with a cache on disk that notices if any compiled file has changed.

numba checks only the file of the function itself: machine code that has inlined a function or a constant from another
file would silently stay in use after that file has changed. Here the folder of the cache is named by a hash of all
compiled files and of those whose names they import.

Without numba, in a browser tab, `jit` does nothing: everything runs in plain Python, some fifty times slower.
"""

import contextlib
import functools
import hashlib
import re
import tempfile
from pathlib import Path

try:
    import numba
except ModuleNotFoundError as missing:
    if missing.name != "numba":  # one that is there and does not work is said, not replaced by a slow loop
        raise
    numba = None

from ir50p_lab.home import home

_PACKAGE = Path(__file__).parent


@functools.cache
def cache_folder():
    """Return where the machine code of these sources is kept: the first of `_places` that can be written to.

    It is None if there is none: then each process compiles for itself.
    """
    sources = {path: path.read_bytes() for path in sorted(_PACKAGE.rglob("*.py"))}
    compiled = b"".join(text for text in sources.values() if b"@jit(" in text or b"@kernel(" in text)
    names = set(re.findall(r"^from ir50p_lab\.(\S+) import", compiled.decode(), re.MULTILINE))
    compiled += b"".join(sources.get(_PACKAGE / f"{name.replace('.', '/')}.py", b"") for name in sorted(names))
    name = f"ir50p_lab-{hashlib.sha1(compiled).hexdigest()[:16]}"
    return next((place / name for place in _places() if _takes_files(place / name)), None)


def _places():
    """$NUMBA_CACHE_DIR, the package, the user's cache, the student's folder."""
    if numba.config.CACHE_DIR:
        yield Path(numba.config.CACHE_DIR)
    yield _PACKAGE / "__pycache__"
    with contextlib.suppress(RuntimeError):  # a user without a home directory
        yield Path.home() / ".cache"
    yield home() / ".cache"


def _takes_files(folder):
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def jit(*, fastmath=("contract",), **options):
    """Decorate a function with numba's njit, compiled at the first call and kept on disk. options: of njit.

    Division by zero gives inf or NaN as in NumPy: the caller checks results once, not every operation. A product and a
    sum may be rounded once, together, if the processor can do that: simulations are a quarter quicker.
    """
    if numba is None:
        return lambda function: function
    return functools.partial(with_cache, numba.njit, error_model="numpy", fastmath=set(fastmath), **options)


def with_cache(decorator, function, *signature, **options):
    """Decorate a function with a decorator of numba's whose machine code is to be kept in `cache_folder()`."""
    folder = cache_folder()
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(folder or "")
    try:
        return decorator(*signature, cache=folder is not None, **options)(function)
    finally:
        numba.config.CACHE_DIR = before


def on_floats(function):
    """Without numba, let a loop over steps run on Python's floats, several times as fast as on NumPy's.

    With numba it changes nothing.

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
