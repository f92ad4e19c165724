"""`python3 -m ir50p_lab update FOLDER|FILE.zip`: take over what is the student's from another copy of the course."""

import json
import shutil
import sys
import tempfile
import zipfile
from pathlib import Path

from ir50p_lab.home import PROJECT, home

#: What comes along, and into which folder; the notes lie in results.
_INTO = {"my_robot/**/*.*": "", "results/**/*.*": "", "recordings/**/*.*": "", "progress.json": "", "*.ipynb": "old"}


def take_over(folder, named=None):
    """Copy my_robot, results, recordings and notes of the course in the given folder; its notebooks go to `old/`.

    A ZIP that `take_home()` made serves as well. Nothing is overwritten: a file that differs from the one here, or
    cannot be read, is named. Ends the program with a sentence if the folder holds no course, or is this one.
    named: what the folder is called in that sentence.
    """
    if str(folder).lower().endswith(".zip"):
        _take_over_zip(folder)
        return
    older = Path(folder).expanduser().resolve() / "notebooks"
    if not older.is_dir() or older.parent == PROJECT.resolve():
        sys.exit(f"'{older.parent}' holds no older copy of the course: give its folder (it has 'notebooks' in it)")
    found = {one: home() / into / one.relative_to(older) for name, into in _INTO.items() for one in older.glob(name)}
    files = [path for path in sorted(found) if path.is_file() and path.suffix != ".pyc"]  # no dangling links
    left = [str(path) for path in files if not _copied(path, found[path])]
    print(f"Taken over from {named or older}: {len(files) - len(left)} files, into {home()}")
    if (home() / "old").is_dir():
        print(f"The older notebooks are beside the new ones, in {home() / 'old'}")
    foreign = [
        str(path)
        for path in files
        if path.suffix == ".py" and {"\0", "\ufffd"} & set(path.read_text("utf-8", "replace"))
    ]
    if foreign:
        print(f"Save with the encoding UTF-8, or Python cannot read them: {', '.join(foreign)}")
    print(f"Left where they are, because they cannot be read or are different here: {', '.join(left) or 'none'}")


def _take_over_zip(file):
    with tempfile.TemporaryDirectory() as room:
        try:
            zipfile.ZipFile(Path(file).expanduser()).extractall(room)
        except (OSError, zipfile.BadZipFile) as error:
            sys.exit(f"'{file}' cannot be unpacked: {error}")
        take_over(room, named=file)


def _copied(path, target):
    """Copy a file unless there is one; tell whether both are equal now. What should be JSON and is not stays behind."""
    try:
        if path.suffix in (".ipynb", ".json"):  # cut off, of zeros, half merged, or only a place holder of a cloud
            json.loads(path.read_text("utf-8-sig"))
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
        return target.read_bytes() == path.read_bytes()
    except (OSError, ValueError):
        return False


if __name__ == "__main__":
    take_over(" ".join(sys.argv[1:]))
