"""`python3 -m ir50p_lab update FOLDER`: take over what is the student's from an older copy of the course."""

import hashlib
import json
import shutil
import sys
from pathlib import Path

from ir50p_lab.errors import InputError, LabError
from ir50p_lab.home import PROJECT, home

_OWN = ("my_robot", "results", "recordings", "progress.json")
_KNOWN = PROJECT / "data/notebook_hashes.txt"  # of every notebook that ever shipped
_NUMBERS = "03 is 04 now, 04 is 06, 05 is 08, 06 is 10, 07 is 12, 08 is 14, 09 is 16, 10 is 17, 11 is 18"


def take_over(folder):
    """Copy progress, results, recordings and `my_robot` of the course in the folder named; its notebooks go to old/.

    Nothing is changed or overwritten. Raises InputError if there is no course in the folder, or if it is this one.
    """
    old = Path(folder).expanduser().resolve()
    if not (old / "notebooks").is_dir() or old == PROJECT.resolve():
        raise InputError(f"'{old}' holds no older copy of the course: give its folder (it has 'notebooks' in it)")
    for name in _OWN:
        for place in (old / "notebooks" / name, old / name):
            if place.exists():
                _copy(place, home() / name)
    notebooks = sorted((old / "notebooks").glob("*.ipynb"))
    for path in notebooks:
        _copy(path, home() / "old" / path.name)
    known = _KNOWN.read_text(encoding="utf-8").split()
    edited = [path.name for path in notebooks if notebook_hash(path) not in known]
    print(f"Notebooks of the older course: {home() / 'old'}")
    print(f"You had changed: {', '.join(edited) or 'none of them'}")
    if (old / "notebooks" / "03_dynamics.ipynb").exists():
        print(f"Notebooks have new numbers: 02 is 02 and 03 now, {_NUMBERS}.")


def notebook_hash(path):
    """What a notebook's cells say, as 16 hexadecimal digits; '' for a file that is no notebook."""
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        said = [[cell["cell_type"], "".join(cell["source"])] for cell in cells]
        text = json.dumps([cell for cell in said if cell[1].strip()])  # JupyterLab adds empty ones
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


if __name__ == "__main__":
    try:
        take_over(" ".join(sys.argv[1:]))
    except (LabError, OSError) as problem:
        sys.exit(str(problem))
