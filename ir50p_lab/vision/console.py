"""What OpenCV, its decoders and camera drivers write on the console: kept out of the notebook, and readable."""

import contextlib
import os
import tempfile


@contextlib.contextmanager
def captured():
    """A list that holds, after the block, the lines written to the console's error stream in it."""
    import cv2

    lines, level = [], cv2.utils.logging.getLogLevel()
    try:
        kept = os.dup(2)
    except OSError:  # a program without a console
        yield lines
        return
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 2)
        try:
            yield lines
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            cv2.utils.logging.setLogLevel(level)
            file.seek(0)
            lines += file.read().decode(errors="replace").splitlines()
