"""The bench of an unknown arm, as a hand-in sees it: it asks, and a world answers, here or behind a pipe."""

import base64
import zlib
from types import SimpleNamespace

import numpy as np

from ir50p_lab.inputs import vector3


class FarBench:
    """The bench of an arm that nobody has seen; ask: function of a question (dict) that returns the answer (dict).

    delay     s from a sample to the moment when its command acts
    l         (3,) m, lengths; limits (2, 3) rad; start (3,) rad, where each run begins
    K         (3, 3) of the camera, whose pictures are straight; corners (4, 2) px, where it sees the places `points`
              (4, 3) m of the table
    nominal   theta (3, 20), counts: the numbers of an IR50P of these lengths
    left      s of practice that are left
    recording what the last run measured and sent: t (n,), q (n, 3) rad, u (n, 3) counts; None before the first
    ended     how the last run ended

    `for sample in bench.run(58): bench.drive(u)` practises, `bench.race()` is the same once; a sample has t, q, counts
    and touched, the number of balls so far. `bench.look()` is a picture, of 0..255.
    """

    def __init__(self, ask):
        self._ask = ask
        told = {name: np.array(value) for name, value in ask({"op": "begin"}).items()}
        self.delay, self.left = float(told["delay"]), float(told["left"])
        self.l, self.limits, self.start = told["l"], told["limits"], told["start"]
        self.K, self.corners, self.points, self.nominal = (told[key] for key in ("K", "corners", "points", "nominal"))
        self._slope, self._zero = told["slope"], told["zero"]
        self.recording, self.ended, self._counts = None, "", None

    def look(self):
        """Return a picture (h, w, 3) of the balls on the table; the arm stands aside.

        Raises InputError if all are taken.
        """
        said = self._ask({"op": "look"})
        pixels = zlib.decompress(base64.b64decode(said["picture"]))
        return np.frombuffer(pixels, np.uint8).reshape(said["shape"])

    def drive(self, u):
        """Send counts (3,), rounded and held to +-255, and return what is sent. Raises InputError for anything else."""
        self._counts = np.clip(np.rint(vector3("u", u, unit="counts")), -255, 255)
        return self._counts

    def run(self, seconds):
        """Yield the samples of a practice run, from the start pose; it ends early if no time is left."""
        return self._samples({"op": "practice", "seconds": seconds})

    def race(self):
        """Yield the samples of the race, at most 20 s; there is only one. Raises InputError for a second."""
        return self._samples({"op": "race"})

    def _samples(self, question):
        said, rows = self._ask(question), []
        try:
            while "ended" not in said:
                counts, self._counts = np.array(said["c"]), np.zeros(3)
                q = (counts - self._zero) / self._slope
                yield SimpleNamespace(t=said["t"], q=q, counts=counts, touched=said["n"])
                rows.append((said["t"], q, self._counts))
                said = self._ask({"u": self._counts.tolist()})
            self.left, self.ended = said["left"], said["ended"]
        finally:
            if rows:
                t, q, u = map(np.array, zip(*rows, strict=True))
                self.recording = SimpleNamespace(t=t, q=q, u=u)
