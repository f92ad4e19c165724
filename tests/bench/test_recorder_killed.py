"""Killed without warning, or on a full disk: what was recorded is there, and a full disk stops the drive."""

import os
import subprocess
import sys
import textwrap
import warnings

import numpy as np
import pytest

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.bench import recorder as recorder_module
from ir50p_lab.bench.recording import Recording
from ir50p_lab.errors import RecordingError

# Writes as fast as it can, and tells after each sample that it is recorded: one byte into a pipe.
WRITER = """
    import os, sys
    import numpy as np
    from ir50p_lab.bench.base import Sample
    from ir50p_lab.bench.recorder import Recorder
    recorder = Recorder({"kind": "simulated", "simulated": "true", "period_s": "0.01"}, sys.argv[1])
    print(recorder.path, flush=True)
    counts, u = np.array([512.0, 600.25, 234.75]), np.array([-255.0, 0.0, 12.0])
    for k in range(10**9):
        sample = Sample(0.01 * k, np.array([0.5, 0.2, 1e-4 * k % 3]), counts, 0)
        recorder.write(sample, u, (1.0, 2.0, 3.0), False)
        os.write(1, b".")
"""


def test_killed_at_random_moments_at_most_the_last_sample_is_missing(tmp_path):
    rng = np.random.default_rng(4)
    moments = rng.integers(1, 6000, 3)  # samples told before the kill: 100 Hz is passed many times over
    for n in moments:
        command = [sys.executable, "-c", textwrap.dedent(WRITER), str(tmp_path)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, cwd=os.getcwd()) as process:
            path = process.stdout.readline().decode().strip()
            told = len(process.stdout.read(int(n)))
            process.kill()  # SIGKILL: nothing is flushed, no handler runs
            told += len(process.stdout.read())
        assert told >= n and process.returncode != 0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a cut-off last line may be left out
            loaded = Recording.load(path)
        assert told <= len(loaded) <= told + 1  # one may be recorded and not yet told
        np.testing.assert_allclose(loaded.t, 0.01 * np.arange(len(loaded)), atol=1e-9)
        np.testing.assert_allclose(loaded.q[:, 2], 1e-4 * np.arange(len(loaded)) % 3, atol=1e-6)


class Watched(SimulatedBench):
    """Knows whether the drive was cut."""

    cuts = 0

    def _cut(self):
        self.cuts += 1
        super()._cut()


def test_a_full_disk_cuts_the_drive_and_says_so(tmp_path, monkeypatch):
    def write(file, data, real=os.write):
        if os.fstat(file).st_size > 3000:
            raise OSError(28, "No space left on device")
        return real(file, data)

    with pytest.raises(RecordingError, match=r"No space left.*Make room"), Watched(record_to=tmp_path) as bench:
        monkeypatch.setattr(recorder_module.os, "write", write)
        for _ in bench.run(5):
            bench.drive([100, 0, 0])
            assert bench.cuts == 0
    assert bench.cuts >= 1 and not bench.command.any()
    loaded = Recording.load(bench.recording.path)
    np.testing.assert_allclose(loaded.u, np.tile([100, 0, 0], (len(loaded), 1)))
    assert 5 < len(loaded) == len(bench.recording) - 1 < 100
