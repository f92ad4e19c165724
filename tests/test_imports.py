"""What an import costs and brings: nothing but what is used."""

import subprocess
import sys
from importlib import import_module


def modules_after(statement):
    code = f"{statement}\nimport sys; print(' '.join(sys.modules))"
    return set(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split())


def test_package_itself_brings_nothing():
    brought = modules_after("import ir50p_lab") - modules_after("pass")
    assert brought == {"ir50p_lab"}


def test_modelling_brings_no_heavy_module_until_used():
    heavy = {"numpy", "numba", "scipy", "sympy", "matplotlib", "cv2", "control"}
    assert not modules_after("import ir50p_lab.modelling, ir50p_lab.vision") & heavy
    assert not modules_after("from ir50p_lab.modelling import IR50P, inverse_kinematics") & (heavy - {"numpy"})


PACKAGES = "bench controllers identification modelling signals simulation vision".split()


def test_every_public_name_exists_and_is_documented():
    packages = [import_module(f"ir50p_lab.{name}") for name in PACKAGES]
    values = {f"{package.__name__}.{name}": getattr(package, name) for package in packages for name in package.__all__}
    texts = {name: value.__doc__ or "" for name, value in values.items() if callable(value)}
    made = [name for name, text in texts.items() if text.startswith(f"{name.rpartition('.')[2]}(")]  # by a dataclass
    assert [name for name, text in texts.items() if len(text) <= 15] + made == []
