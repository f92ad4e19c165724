"""The memory that a loop in the background shares with the notebook: orders go in, samples come out.

It is one block of bytes, in this process or mapped into two. Only one side writes each part:

    orders    written by the notebook: stop and cut, gains, a set point; closed by a CRC, so that the loop never acts on
              orders that are half written: it takes them one cycle later
    status    written by the loop: phase, number of samples, missed cycles, trips of the watchdog
    ring      written by the loop: the last CAPACITY samples

No locks: neither side ever waits for the other.
"""

import mmap
import os
import tempfile
import zlib

import numpy as np

STARTING, LEADING, RUNNING, RETURNING, ENDED = range(5)
PHASES = ("starting", "leading in", "running", "moving to the rest pose", "ended")
CAPACITY = 8192  # samples: 82 s at 100 Hz

_GAINS, _SET_POINT = ("gains", "f8", 9), ("set_point", "f8", 3)  # kp, ki, kd; rad
_ORDERS = np.dtype(
    [("stop", "?"), ("cut", "?"), ("gains_number", "i8"), _GAINS, ("set_point_number", "i8"), _SET_POINT]
)
_STATUS = np.dtype([("phase", "i8"), ("samples", "i8"), ("missed", "i8"), ("trips", "i8")])
# measured: when the measurement was taken, s of a true clock; busy: s from having the sample to its command
_MOTION = [("t", "f8"), ("q", "f8", 3), ("u", "f8", 3), ("r", "f8", 3)]
_SAMPLE = np.dtype([*_MOTION, ("measured", "f8"), ("busy", "f8"), ("trips", "i8"), ("number", "i8")])
_ORDERS_SIZE = _ORDERS.itemsize + 4
_STATUS_AT, _RING_AT = 256, 512
_SIZE = _RING_AT + CAPACITY * _SAMPLE.itemsize


class SharedLoop:
    """The block, seen from either side; `SharedLoop()` makes one in this process.

    Made with `SharedLoop.shared()` it can be opened by a child process with `SharedLoop.attach(address)`;
    `address` and `file_descriptors` are what the child needs. Nothing of it is left when both processes have died.
    `status`, written by the loop: phase (STARTING to ENDED), samples, missed (late cycles), trips (of the watchdog).
    """

    def __init__(self, block=None):
        self._block = memoryview(bytearray(_SIZE) if block is None else block)
        self.status = np.frombuffer(self._block, _STATUS, 1, _STATUS_AT).view(np.recarray)[0]
        self._ring = np.frombuffer(self._block, _SAMPLE, CAPACITY, _RING_AT)
        self._given, self._taken = np.zeros(2, _ORDERS).view(np.recarray)
        self.address, self.file_descriptors = "", ()
        self._file = None

    @classmethod
    def shared(cls):
        """A block that a child process can open: memory without a name, handed on as a file descriptor."""
        if os.name == "nt":
            address = f"ir50p-loop-{os.getpid()}-{os.urandom(8).hex()}"
            memory = cls.attach(address)
        else:
            in_memory = "/dev/shm"  # else an ordinary temporary file without a name
            file = tempfile.TemporaryFile(dir=in_memory if os.access(in_memory, os.W_OK) else None)
            file.truncate(_SIZE)
            address = str(file.fileno())
            memory = cls.attach(address)
            memory._file, memory.file_descriptors = file, (file.fileno(),)
        memory.address = address
        return memory

    @classmethod
    def attach(cls, address):
        """The same block in the child process."""
        if os.name == "nt":
            return cls(mmap.mmap(-1, _SIZE, tagname=address))
        return cls(mmap.mmap(int(address), _SIZE))

    def handed_over(self):
        """The child has it: the file descriptor is no longer needed here."""
        if self._file is not None:
            self._file.close()

    # ---- the notebook's side

    def order(self, **changes):
        """Change some of the orders: stop, cut, gains (9,), set_point (3,); the last two count their changes."""
        for name, value in changes.items():
            self._given[name] = value
            if name in ("gains", "set_point"):
                self._given[f"{name}_number"] += 1
        packed = self._given.tobytes()
        self._block[:_ORDERS_SIZE] = packed + zlib.crc32(packed).to_bytes(4, "little")

    def latest(self, count):
        """The last `count` samples at most, oldest first: a copy, (n,), fields t, q, u, r, measured, busy, trips..."""
        end = int(self.status.samples)
        first = max(0, end - min(count, CAPACITY - 64))  # the loop goes on writing while this is copied
        numbers = np.arange(first, end)
        rows = self._ring[numbers % CAPACITY]
        return rows[rows["number"] == numbers]  # never a row that is being written

    # ---- the loop's side

    def orders(self):
        """The newest complete orders: stop, cut, gains, gains_number, set_point, set_point_number."""
        raw = bytes(self._block[:_ORDERS_SIZE])
        if zlib.crc32(raw[:-4]) == int.from_bytes(raw[-4:], "little"):
            self._taken = np.frombuffer(raw, _ORDERS, 1).view(np.recarray)[0]
        return self._taken

    def put(self, t, q, u, r, measured, busy, missed, trips=0):
        """The loop adds one sample: t s; q, u, r (3,) rad, PWM counts, rad; measured, busy s; missed, trips: so far."""
        number = int(self.status.samples)
        place = number % CAPACITY
        self._ring["number"][place] = -1
        self._ring[place] = (t, q, u, r, measured, busy, trips, -1)
        self._ring["number"][place] = number
        self.status.missed, self.status.trips = missed, trips
        self.status.samples = number + 1
