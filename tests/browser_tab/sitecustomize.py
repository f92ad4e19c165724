"""Imported by every Python that starts with this folder on PYTHONPATH: what a browser tab lacks cannot be imported."""

import sys

for name in ("numba", "cv2", "serial", "loky"):
    sys.modules[name] = None
