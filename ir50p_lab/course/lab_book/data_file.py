"""Where the files are that come with the course: pictures, recordings, tables."""

from ir50p_lab.errors import InputError
from ir50p_lab.home import PROJECT


def data_file(name):
    """Return the path of a file or folder in data/, from whatever folder a notebook runs in.

        Recording.load(data_file("first_reach.csv"))

    name: counted from data/, such as "calibration/flat/board_01.jpg". Raises InputError, with what is there, if it is
    missing.
    """
    path = PROJECT / "data" / str(name)
    if not path.exists():
        folder = next(parent for parent in path.parents if parent.is_dir())
        there = ", ".join(sorted(entry.name for entry in folder.iterdir()))
        raise InputError(f"data_file({str(name)!r}) is not there. {folder} holds: {there}")
    return path
