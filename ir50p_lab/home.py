"""Where everything of the student's lies: progress, results, recordings."""

import os
import tempfile
from pathlib import Path

VARIABLE = "IR50P_HOME"
PROJECT = Path(__file__).parents[1]


def home():
    """The student's folder: $IR50P_HOME, else notebooks/ of the project. It may not exist yet."""
    return Path(os.environ.get(VARIABLE) or PROJECT / "notebooks").expanduser().absolute()


def replace_text(path, text):
    """Write a file in one step: a crash leaves the old or the new one, whole. Raises OSError."""
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".", ignore_cleanup_errors=True) as folder:
        scratch = Path(folder, path.name)
        scratch.write_text(text, encoding="utf-8")
        os.replace(scratch, path)
