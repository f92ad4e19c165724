"""Imported by every Python that starts with this folder on PYTHONPATH: what a browser tab lacks cannot be imported."""

import sys
import time

for name in ("numba", "cv2", "serial", "loky"):
    sys.modules[name] = None
del time.thread_time
