"""Imported by every Python that starts with this folder on PYTHONPATH: linear algebra that rounds differently.

Results of numpy.linalg and scipy.linalg (floating point arrays and numbers) get a relative noise of 1e-12, larger than
what separates processors and smaller than what any claim may rest on. It stands for processors that nobody here has.
"""

import functools
import importlib.machinery
import sys
import zlib

NOISE = 1e-12
MODULES = {
    "numpy.linalg": "cholesky det eig eigh eigvals eigvalsh inv lstsq norm pinv qr slogdet solve svd svdvals",
    "scipy.linalg": "cho_factor cho_solve cholesky det eig eigh eigvals eigvalsh expm inv lstsq norm null_space pinv pinvh "
    "qr solve solve_triangular sqrtm svd svdvals",
}


class Finder:
    """Finds the modules above as Python does, and has them changed as soon as they are executed."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        """Find a module whose functions are wrapped; None for all others."""
        if name not in MODULES:
            return None
        spec = importlib.machinery.PathFinder.find_spec(name, path, target)
        execute = spec.loader.exec_module

        def execute_and_wrap(module):
            execute(module)
            for function in MODULES[name].split():
                if hasattr(module, function):
                    setattr(module, function, noisy(getattr(module, function)))

        spec.loader.exec_module = execute_and_wrap
        return spec


def noisy(function):
    """Wrap a function so that its result differs in the last digits."""

    @functools.wraps(function)
    def wrapped(*arguments, **options):
        return with_noise(function(*arguments, **options))

    return wrapped


def with_noise(result):
    """Return the result with noise: arrays, numbers, and tuples of them; whole numbers and single precision as they are.

    A result has its own noise: the same question has the same answer on every processor.
    """
    import numpy as np

    if isinstance(result, tuple):
        parts = [with_noise(part) for part in result]
        return type(result)(*parts) if hasattr(result, "_fields") else tuple(parts)
    if not isinstance(result, np.ndarray | float | complex) or np.asarray(result).dtype not in (float, complex):
        return result
    noise = np.random.default_rng(zlib.crc32(np.asarray(result).tobytes())).uniform(-NOISE, NOISE, np.shape(result))
    return result * (1 + noise)


sys.meta_path.insert(0, Finder)
