"""The course from an installed wheel, without a clone: `uvx --from git+URL ir50p-lab`, `pipx run --spec ... ir50p-lab`.

The wheel carries the course's files. They are copied once into a folder of the student's, and the launcher there
takes over: it installs what the lock says, and opens JupyterLab.
"""

import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from ir50p_lab.launcher.environment import LOCK

_PACKAGE = Path(__file__).parents[1]


def main():
    """Copy the course into ./ir50p-lab, or the folder after `--to`, and run the launcher with the other arguments."""
    arguments = sys.argv[1:]
    folder = Path("ir50p-lab")
    if arguments[:1] == ["--to"] and len(arguments) > 1:
        folder = Path(arguments[1]).expanduser()
        del arguments[:2]
    if (_PACKAGE.parent / LOCK).is_file():  # run in a clone's own .venv
        folder = _PACKAGE.parent
    elif not (folder / LOCK).is_file():
        if folder.exists() and any(folder.iterdir()):
            sys.exit(f"{folder.absolute()} holds something else: name a new folder, ir50p-lab --to FOLDER")
        print(f"Copying the course into {folder.absolute()}")
        shutil.copytree(Path(sysconfig.get_path("data"), "share", "ir50p-lab"), folder, dirs_exist_ok=True)
        shutil.copytree(_PACKAGE, folder / _PACKAGE.name, ignore=shutil.ignore_patterns("__pycache__"))
        print("Tomorrow: 'python3 -m ir50p_lab' in that folder (Windows: py -m ir50p_lab), or this command again.")
    return subprocess.call([sys.executable, "-m", "ir50p_lab", *arguments], cwd=folder)
