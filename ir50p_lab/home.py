"""Where everything of the student's lies: progress, results, recordings; and what the settings say, for any folder."""

import os
import tempfile
from pathlib import Path

from ir50p_lab.launcher.settings import PROJECT, path_setting, setting

__all__ = ["PROJECT", "VARIABLE", "home", "path_setting", "replace_text", "setting"]
VARIABLE = "IR50P_HOME"


def home():
    """The student's folder: $IR50P_HOME, else notebooks/ of the project. It may not exist yet."""
    return path_setting(VARIABLE) or PROJECT / "notebooks"


def replace_text(path, text):
    """Write a file in one step: a crash leaves the old or the new one, whole. Raises OSError."""
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".", ignore_cleanup_errors=True) as folder:
        scratch = Path(folder, path.name)
        scratch.write_text(text, encoding="utf-8")
        os.replace(scratch, path)
