"""Where everything of the student's lies: progress, results, recordings."""

import os
import tempfile
from pathlib import Path

VARIABLE = "IR50P_HOME"
PROJECT = Path(__file__).parents[1]


def home():
    """The student's folder: $IR50P_HOME, else notebooks/ of the project, else the working one. It may not exist yet."""
    if os.environ.get(VARIABLE):
        return Path(os.environ[VARIABLE]).expanduser().absolute()
    notebooks = PROJECT / "notebooks"
    return notebooks if notebooks.is_dir() else Path.cwd()


def replace_text(path, text):
    """Write a file in one step: a crash leaves the old or the new one, whole. Raises OSError."""
    scratch = None
    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=path.parent, prefix=f".{path.stem}-", suffix=".tmp", delete=False
        ) as file:
            scratch = Path(file.name)
            file.write(text)
        os.replace(scratch, path)
    except OSError:
        if scratch is not None:
            scratch.unlink(missing_ok=True)
        raise
