"""How the wheel is built: by flit, with notebooks, data, pages and lock in it (`share/ir50p-lab`).

A build backend: pip and uv import it from the project's folder, where nothing of the course is installed yet.
"""

import shutil
from pathlib import Path

from flit_core.buildapi import *  # noqa: F403
from flit_core.buildapi import build_wheel as _build

_CARRIED = "notebooks data docs wheel_build environment.txt environment-test.txt pyproject.toml".split()
_CARRIED += "README.md LICENSE CITATION.cff AGENTS.md".split()
_STUDENTS = "my_robot results recordings old progress.json .ipynb_checkpoints __pycache__".split()
_STAGE = Path("build/wheel")
_STAGE.mkdir(parents=True, exist_ok=True)  # flit asks for it whatever it builds


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """PEP 517: build the wheel, with the course's files; nothing of a student's gets in."""
    place = _STAGE / "share" / "ir50p-lab"
    shutil.rmtree(_STAGE / "share", ignore_errors=True)
    place.mkdir(parents=True)
    for source in map(Path, _CARRIED):
        if source.is_dir():
            shutil.copytree(source, place / source, ignore=shutil.ignore_patterns(*_STUDENTS))
        else:
            shutil.copy(source, place)
    return _build(wheel_directory, config_settings, metadata_directory)
