"""The memory that a loop in the background shares with the notebook: orders go in, samples come out.

It is one block of bytes, in this process or mapped into two. Only one side writes each part:

    orders    written by the notebook: a counter, stop and cut, gains, a set point; closed by a CRC, so that the loop
              never acts on orders that are half written: it takes them one cycle later
    status    written by the loop: phase, number of samples, missed cycles, trips of the watchdog
    ring      written by the loop: the last CAPACITY samples, one row each, column names in COLUMNS

No locks: neither side ever waits for the other.
"""

import mmap
import os
import struct
import tempfile
import zlib
from typing import NamedTuple

import numpy as np

# measured: when the measurement was taken, s of a true clock; busy: s from having the sample to its command
COLUMNS = ("t", "q1", "q2", "q3", "u1", "u2", "u3", "r1", "r2", "r3", "measured", "busy", "trips", "number")
CAPACITY = 8192  # samples: 82 s at 100 Hz
STARTING, LEADING, RUNNING, RETURNING, ENDED = range(5)
PHASES = ("starting", "leading in", "running", "moving to the rest pose", "ended")

_ORDERS = struct.Struct("<q??6x q9d q3d")
_ORDERS_SIZE = _ORDERS.size + 4
_STATUS_AT, _PHASE, _SAMPLES, _MISSED, _TRIPS, _STATUS_COUNT = 256, 0, 1, 2, 3, 8
_RING_AT = 512
_SIZE = _RING_AT + CAPACITY * len(COLUMNS) * 8


class Orders(NamedTuple):
    """What the notebook wants: number counts the changes of anything, the others those of gains and set point.

    gains: 9 numbers, kp, ki, kd; set_point: 3 numbers, rad, NaN: leave that joint's goal.
    """

    number: int = 0
    stop: bool = False
    cut: bool = False
    gains_number: int = 0
    gains: tuple = (0.0,) * 9
    set_point_number: int = 0
    set_point: tuple = (np.nan,) * 3


class SharedLoop:
    """The block, seen from either side; `SharedLoop()` makes one in this process.

    Made with `SharedLoop.shared()` it can be opened by a child process with `SharedLoop.attach(address)`;
    `address` and `file_descriptors` are what the child needs. Nothing of it is left when both processes have died.
    """

    def __init__(self, block=None):
        self._block = memoryview(bytearray(_SIZE) if block is None else block)
        self._status = np.frombuffer(self._block, np.int64, _STATUS_COUNT, _STATUS_AT)
        self._ring = np.frombuffer(self._block, np.float64, CAPACITY * len(COLUMNS), _RING_AT).reshape(CAPACITY, -1)
        self._seen, self._orders = bytes(_ORDERS_SIZE), Orders()
        self.address, self.file_descriptors = "", ()
        self._file = None

    @classmethod
    def shared(cls):
        """A block that a child process can open: memory without a name, handed on as a file descriptor."""
        if os.name == "nt":
            address = f"ir50p-loop-{os.getpid()}-{os.urandom(8).hex()}"
            memory = cls(mmap.mmap(-1, _SIZE, tagname=address))
        else:
            in_memory = "/dev/shm"  # else an ordinary temporary file without a name
            file = tempfile.TemporaryFile(dir=in_memory if os.access(in_memory, os.W_OK) else None)
            file.truncate(_SIZE)
            memory = cls(mmap.mmap(file.fileno(), _SIZE))
            memory._file, address = file, str(file.fileno())
            memory.file_descriptors = (file.fileno(),)
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
        """Change some of the orders; gains and set point count their own changes."""
        for name in ("gains", "set_point"):
            if name in changes:
                changes[f"{name}_number"] = getattr(self._orders, f"{name}_number") + 1
        orders = self._orders._replace(number=self._orders.number + 1, **changes)
        packed = _ORDERS.pack(*orders[:4], *orders.gains, orders.set_point_number, *orders.set_point)
        self._block[:_ORDERS_SIZE] = packed + zlib.crc32(packed).to_bytes(4, "little")
        self._orders = orders

    @property
    def phase(self):
        """Where the loop is: STARTING, LEADING, RUNNING, RETURNING or ENDED."""
        return int(self._status[_PHASE])

    @property
    def samples(self):
        """How many samples there have been."""
        return int(self._status[_SAMPLES])

    @property
    def missed(self):
        """How many cycles came late."""
        return int(self._status[_MISSED])

    @property
    def trips(self):
        """How often the drive was cut because the loop had paused."""
        return int(self._status[_TRIPS])

    def latest(self, count):
        """The last `count` samples at most, oldest first: a copy, (n, len(COLUMNS))."""
        end = self.samples
        first = max(0, end - min(count, CAPACITY - 64))  # the loop goes on writing while this is copied
        numbers = np.arange(first, end)
        rows = self._ring[numbers % CAPACITY]
        return rows[rows[:, -1] == numbers]  # never a row that is being written

    # ---- the loop's side

    def orders(self):
        """The newest complete orders."""
        raw = bytes(self._block[:_ORDERS_SIZE])
        if raw != self._seen and zlib.crc32(raw[:-4]) == int.from_bytes(raw[-4:], "little"):
            v = _ORDERS.unpack(raw[:-4])
            self._orders = Orders(v[0], v[1], v[2], v[3], v[4:13], v[13], v[14:17])
            self._seen = raw
        return self._orders

    def enter(self, phase):
        """The loop says where it is."""
        self._status[_PHASE] = phase

    def put(self, t, q, u, r, measured, busy, missed, trips=0):
        """The loop adds one sample: t s; q, u, r (3,) rad, PWM counts, rad; measured, busy s; missed, trips: so far."""
        number = int(self._status[_SAMPLES])
        row = self._ring[number % CAPACITY]
        row[-1] = -1.0
        row[0], row[1:4], row[4:7], row[7:10], row[10:13] = t, q, u, r, (measured, busy, trips)
        row[-1] = number
        self._status[_MISSED], self._status[_TRIPS] = missed, trips
        self._status[_SAMPLES] = number + 1
