"""`take_lock`: one process at a time, with the standard library only (the launcher needs it before any package)."""

import os
import time


def take_lock(file, *, wait):
    """Lock an open file; True when taken. It falls by itself when every process that holds the file open has ended.

    wait: for whoever holds it, or give False. Raises: OSError where there are no locks (network drives).
    """
    if os.name == "nt":
        import msvcrt

        while True:
            try:
                msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
                return True
            except OSError:
                if not wait:
                    return False
                time.sleep(1)
    import fcntl

    try:
        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        return True
    except BlockingIOError:
        return False
