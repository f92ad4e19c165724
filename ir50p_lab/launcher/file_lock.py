"""`take_lock`: one process at a time, with the standard library only (it is needed before any package is installed)."""

import os
import time


def take_lock(file, busy=""):
    """Lock an open file. The lock ends by itself when every process that holds the file open has ended.

    busy: printed once while another process holds it. If there are no locks (some network drives), it goes on without.
    """
    if os.name == "nt":
        import msvcrt

        lock, how = msvcrt.locking, (file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        lock, how = fcntl.flock, (file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    while True:
        try:
            return lock(*how)
        except (BlockingIOError, PermissionError):
            if busy:
                print(busy)
            busy = ""
            time.sleep(0.02)
        except OSError:
            return None
