"""Names of a package that are imported when first used, with the cause kept where that fails."""

import importlib.metadata
import sys
from pathlib import Path

import lazy_loader

from ir50p_lab.errors import DependencyError, LabError


def attach(package, **names):
    """As `lazy_loader.attach`, but an error while a module loads names its cause.

    Python turns an AttributeError in there into "cannot import name", which tells nothing.
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
            text = f"{package}.{name} could not be loaded: {type(error).__name__}: {error}."
            raise DependencyError(f"{text} {_remedy(error)}") from error

    return load_named, dir_of, everything


def _remedy(error):
    """What to do: rename a file beside the notebook that hides a package, set up what is missing, or ask the doctor."""
    packages = importlib.metadata.packages_distributions().keys() | sys.stdlib_module_names
    hiding = [path.name for path in sorted(Path.cwd().glob("*.py")) if path.stem in packages]
    if hiding:
        return f"{Path.cwd() / hiding[0]} hides the package {hiding[0][:-3]}: rename it, then restart the kernel."
    if isinstance(error, ModuleNotFoundError):
        return f"The package {error.name} is not installed: 'python3 -m ir50p_lab setup' installs all of them."
    return "A package is damaged, or of a version that does not fit: 'python3 -m ir50p_lab doctor' says which."
