"""Taking over what is the student's from an older copy of the course: nothing of it is changed or overwritten."""

import hashlib
import json
import os
import shutil
from pathlib import Path

from ir50p_lab.launcher.problems import COMMAND, SetUpError

_OWN = ("my_robot", "results", "recordings", "progress.json")
_KNOWN = "data/notebook_hashes.txt"  # of every notebook that ever shipped
_NUMBERS = "03 is 04 now, 04 is 06, 05 is 08, 06 is 10, 07 is 12, 08 is 14, 09 is 16, 10 is 17, 11 is 18"


def take_over(arguments, root):
    """Copy progress, results, recordings and `my_robot` of the course in the folder named; its notebooks go to old/.

    Raises SetUpError if there is no course in the folder, or if it is this one.
    """
    old = Path(*arguments).expanduser().resolve()
    if not arguments or not (old / "notebooks").is_dir() or old == root.resolve():
        raise SetUpError(
            f"'{old}' holds no older copy of the course: {COMMAND} update FOLDER (it has 'notebooks' in it)"
        )
    home = Path(os.environ.get("IR50P_HOME") or root / "notebooks").expanduser()
    for name in _OWN:
        for place in (old / "notebooks" / name, old / name):
            if place.exists():
                _copy(place, home / name)
    notebooks = sorted((old / "notebooks").glob("*.ipynb"))
    for path in notebooks:
        _copy(path, home / "old" / path.name)
    known = (root / _KNOWN).read_text(encoding="utf-8").split()
    edited = [path.name for path in notebooks if notebook_hash(path) not in known]
    print(f"Notebooks of the older course: {home / 'old'}")
    print(f"You had changed: {', '.join(edited) or 'none of them'}")
    if (old / "notebooks" / "03_dynamics.ipynb").exists():
        print(f"Notebooks have new numbers: 02 is 02 and 03 now, {_NUMBERS}.")
    return 0


def notebook_hash(path):
    """What a notebook's cells say, as 16 hexadecimal digits; '' for a file that is no notebook."""
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        text = json.dumps([[cell["cell_type"], "".join(cell["source"])] for cell in cells])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return ""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _copy(source, target):
    """Copy a file or folder; what is there already stays and is named."""
    if source.is_dir():  # not copytree: it copies the folders' permissions too, and a dangling link stops it
        for path in sorted(path for path in source.rglob("*") if path.is_file() and "__pycache__" not in path.parts):
            _copy(path, target / path.relative_to(source))
    elif not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target)
    elif target.read_bytes() != source.read_bytes():
        print(f"Left as it is here: {target} (the older one: {source})")
