"""One state or many: functions of one state turned into NumPy's generalised ufuncs, and the errors that they raise."""

import re
import sys
import warnings
from contextlib import nullcontext
from functools import cache

import numpy as np

from ir50p_lab.errors import InputError, SuspiciousAngleWarning
from ir50p_lab.inputs import vectors3
from ir50p_lab.launcher.file_lock import take_lock

_TURN = 2 * np.pi
_NO_LIMITS = (np.inf, np.inf, np.inf)
NOT_FINITE = "the result is not finite: the numbers are too large"


def kernel(layout):
    """Decorate a function of one state: its name then stands for a function that returns NumPy's generalised ufunc.

    layout: NumPy's signature, such as "(n),(n)->(n)". The last argument of the function is the result, which it fills.
    It raises InputError(NOT_FINITE) if the result is not finite, because then a NaN has gone in. The ufunc works on
    floats and is compiled when it is first needed.
    """

    def decorate(function):
        return cache(lambda: _compiled(function, layout))

    return decorate


def _compiled(function, layout):
    from ir50p_lab.jit import cache_folder, numba, with_cache  # takes a while: not at import

    if numba is None:
        return _interpreted(function, layout)
    operands = [dims.split(",") if dims else [] for dims in re.findall(r"\((.*?)\)", layout)]
    types = [f"f8[{','.join(':' * len(dims))}]" if dims else "f8" for dims in operands]
    signature, folder = [f"void({', '.join(types)})"], cache_folder()
    with open(folder / "lock", "a") if folder else nullcontext() as file:
        if file:
            # numba keeps two halves in two files that must come from one process; of a mixture it calls a null pointer
            take_lock(file)
        compiled = with_cache(numba.guvectorize, function, signature, layout, nopython=True)
    return compiled.ufunc  # NumPy's own: without numba's look at the arguments


def _interpreted(function, layout):
    """The same without numba: a loop over the states in Python."""
    ins, out = (re.findall(r"\((.*?)\)", side) for side in layout.split("->"))

    def one(*arguments):
        arguments = [np.asarray(one, dtype=float) for one in arguments]
        sizes = {}
        for names, argument in zip(ins, arguments, strict=True):
            sizes.update(zip(names.split(","), argument.shape, strict=False))
        result = np.empty([sizes[name] for name in out[0].split(",")])
        function(*arguments, result)
        return result

    return np.vectorize(one, signature=layout, otypes=[float])


def evaluate(kernel, constants, check=None, /, **vectors):
    """Return `kernel` of the constants and the vectors, each (3,) or (..., 3): arrays, lists or tuples.

    Good input is not inspected here: NumPy refuses what does not fit, and the kernel what is not finite. Only then, or
    if NumPy hands the work to another kind of array, are the arguments checked one by one, for the message that names
    the fault. check() returns the constants after checking them.
    """
    try:
        result = kernel()(*constants, *vectors.values())
        if type(result) is np.ndarray:
            return result
    except (TypeError, ValueError, SystemError, FloatingPointError, RuntimeWarning):  # as NumPy is told to warn
        pass
    with np.errstate(all="ignore"):
        return kernel()(*(check() if check else constants), *same_shape(**vectors))


def warn_of_degrees(arm, q):
    """Warn of angles q (..., 3) that are more than a turn beyond the arm's limits (without limits: beyond four turns).

    The warning points at the line outside this package that gave them.
    """
    q = np.asarray(q)
    if q.size == 3 and np.vdot(q, q) < _TURN**2:  # the usual case, at no cost
        return
    limits = np.maximum(np.negative(getattr(arm, "q_min", _NO_LIMITS)), getattr(arm, "q_max", _NO_LIMITS))
    beyond = np.abs(q) - np.where(np.isfinite(limits), limits, 3 * _TURN)
    if (beyond > _TURN).any():
        said = "q has an angle more than a turn beyond the arm's limits: angles are in radians"  # one text: said once
        level, caller = 2, sys._getframe(1)
        while caller.f_back and str(caller.f_globals.get("__name__")).startswith("ir50p_lab."):
            level, caller = level + 1, caller.f_back
        warnings.warn(f"{said} (np.radians turns degrees into them)", SuspiciousAngleWarning, stacklevel=level)


def same_shape(**vectors):
    """Return the vectors as arrays (..., 3), broadcast to one shape. Raises InputError if their shapes do not fit."""
    arrays = {name: vectors3(name, x, unit="SI") for name, x in vectors.items()}
    try:
        return np.broadcast_arrays(*arrays.values())
    except ValueError:
        shapes = ", ".join(f"{name} {a.shape}" for name, a in arrays.items())
        raise InputError(f"shapes do not fit: {shapes}; give all (3,), or all (n, 3) with the same n") from None
