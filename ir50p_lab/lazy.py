"""Names of a package that are imported when first used; if that fails, the cause is kept."""

import importlib.metadata
import sys
import traceback
from pathlib import Path

import lazy_loader

from ir50p_lab.errors import DependencyError, LabError


def attach(package, **names):
    """Do the same as `lazy_loader.attach`, but let an error while a module loads name its cause.

    Python turns an AttributeError in there into "cannot import name", which says nothing.
    """
    load, dir_of, everything = lazy_loader.attach(package, **names)

    def load_named(name):
        try:
            return load(name)
        except (AttributeError, ImportError) as error:
            if name not in everything:
                raise
            if isinstance(error, LabError):  # it says what to do by itself, as in a browser tab
                raise
            raise failed(f"{package}.{name}", error) from error

    return load_named, dir_of, everything


def failed(what, error):
    """Return the DependencyError for an ImportError or AttributeError while `what` was loaded: cause and remedy."""
    text = f"{what} could not be loaded: {type(error).__name__}: {error}."
    hiding = _hiding(error)
    if hiding:
        return DependencyError(f"{text} {hiding} hides the package {hiding.stem}: rename it, then restart the kernel.")
    if isinstance(error, ModuleNotFoundError):
        setup = "'python3 -m ir50p_lab setup' installs all of them"
        return DependencyError(f"{text} The package {error.name} is not installed: {setup}.")
    doctor = "'python3 -m ir50p_lab doctor' says which"
    return DependencyError(f"{text} A package is damaged, or of a version that does not fit: {doctor}.")


def _hiding(error):
    """The file or folder beside the notebook that was loaded in the place of a package, None if there is none."""
    packages = importlib.metadata.packages_distributions().keys() | sys.stdlib_module_names
    loaded = [frame.filename for frame in traceback.extract_tb(error.__traceback__)]
    loaded += [getattr(module, "__file__", None) for module in list(sys.modules.values())]
    for file in filter(None, loaded):
        if Path(file).is_relative_to(Path.cwd()):
            beside = Path.cwd() / Path(file).relative_to(Path.cwd()).parts[0]
            if beside.stem in packages and beside.stem != "ir50p_lab":
                return beside
    return None
