"""Hostile functions put past the gate.

Each has to be wrong, to leave the files beside it alone, and the next function has to be right all the same.
"""

import os
import tempfile
import time
from pathlib import Path
from unittest import mock

from ir50p_lab.course.grading import sandbox
from tests.targets.rows import Row

_RIGHT = Path(__file__).parents[1] / "solutions" / "quintic.py"
_PAST_THE_GATE = """
from ir50p_lab.course.grading import inside
from ir50p_lab.course.robot.source import Source
inside.cut = lambda text, name, *_: Source(name, text, ())
inside.main()
"""
_BODIES = {
    "endless loop": "while True: pass",
    "endless loop in C": "return sum(range(10**13))",
    "endless loop that catches all": "exec('while True:\\n try:\\n  while True: pass\\n except BaseException: pass')",
    "fork bomb": "exec('while True: os.fork()')",
    "patched NumPy": "np.allclose = lambda *_, **__: True; return np.eye(4)",
    "socket": "import socket; socket.create_connection(('192.0.2.1', 53), timeout=2); return np.eye(3)",
    "writing outside": "open('{victim}', 'w').write('x'); return np.eye(4)",
    "deleting": "os.remove('{victim}'); return np.eye(4)",
    "10 MB of print": "print('x' * 10_000_000); return np.eye(4)",
    "12 GiB": "bytearray(12 << 30); return np.eye(4)",
    "killed by a signal": "os.kill(os.getpid(), 9)",
}


def rows(quick):
    """The table; quick: less time for the process of each student."""
    before, seconds = sandbox.bubblewrap(), 20 if quick else 60
    yield Row(sandbox.isolation(), "-", "-")
    for what, body in _BODIES.items():
        if what == "fork bomb" and before and hasattr(os, "geteuid") and os.geteuid() == 0:
            yield Row(what, "wrong", "not tried: root inside bubblewrap needs a limit of the system")
            continue
        with tempfile.TemporaryDirectory() as folder:
            victim = Path(folder) / "victim"
            victim.write_text("precious")
            text = f"import os\n\n\ndef rot_z(angle):\n    {body.replace('{victim}', str(victim))}\n"
            began = time.monotonic()
            functions = {"rot_z": text, "quintic": _RIGHT.read_text("utf-8")}
            with mock.patch.object(sandbox, "_INSIDE", ("-c", _PAST_THE_GATE)):
                found = sandbox.verdicts(functions, before, seconds)
            took = time.monotonic() - began
            whole = victim.is_file() and victim.read_text() == "precious"
        states = found["rot_z"][0], found["quintic"][0]
        said = f"{states[0]}, {states[1]}, files {'whole' if whole else 'HARMED'}, {took:.0f} s"
        yield Row(what, "wrong, next right, files whole", said, ok=states == ("wrong", "right") and whole)
