"""The emulated board on virtual time: a pyserial look-alike and a clock in one, with an arm behind it.

    board = VirtualBoard(plant=SimulatedArm(arm, unit, seed))      # powered on, booting; plant default: HeldArm()
    bench = SerialBench(board, clock=board, ...)

As a port (what pyserial's Serial has): read(n), write(data), in_waiting, timeout, write_timeout, reset_input_buffer(),
reset_output_buffer(), flush(), close(), is_open, port. read() lets virtual time pass until n bytes are there or
`timeout` (s; None waits for ever, 0 not at all) is over; write() takes no time, the bytes go out at the line's pace.
As a clock: now() -> s since power-on, sleep(seconds), sleep_until(t). Same calls, same bytes, same times in each run.
The arm: any object with advance(pwm (3,), seconds) and counts() -> (3,) converter counts; called every `tick` (1 ms)
with the mean voltage that the bridges give, in PWM counts.
To look inside: pins() -> Pins(duty, direction, enable, gripper, hertz), .pwm; changes: list of (t, Pins) at each change.
To make trouble: reset() (button, DTR), hang() (the sketch, until the next reset), unplug() (reads and writes raise SerialException from then on),
to_board / to_host: functions bytes -> bytes that every piece passes through (noise, loss).
"""

import math

import serial

from tests.emulator.build import firmware
from tests.emulator.mega import Mega


class HeldArm:
    """An arm that does not move: `values` (3,) converter counts, `pwm` the last drive."""

    def __init__(self, values=(512, 512, 512)):
        self.values, self.pwm = values, (0.0, 0.0, 0.0)

    def advance(self, pwm, seconds):
        self.pwm = pwm

    def counts(self):
        return self.values


class VirtualBoard:
    """See the text above. plant: the arm; elf: compiled sketch (default: the normal one)."""

    is_open = True
    port = "emulated"
    write_timeout = None

    def __init__(self, plant=None, *, elf=None, tick=1e-3, resolution=50e-6, timeout=0.05):
        """tick: s between two steps of the arm; resolution: s between two looks at the line."""
        self.plant, self.timeout = plant or HeldArm(), timeout
        self.to_board = self.to_host = bytes
        self.changes = []
        self._mega, self._tick, self._resolution = Mega(elf or firmware()), tick, resolution
        self._inbox, self._unplugged, self._raw = bytearray(), False, None
        self._next_tick = 0.0
        self._look()

    # ---- port

    @property
    def in_waiting(self):
        self._plugged()
        return len(self._inbox)

    def read(self, size=1):
        self._plugged()
        end = math.inf if self.timeout is None else self.now() + self.timeout
        while len(self._inbox) < size and self.now() < end - 1e-9:
            self._advance(min(self._resolution, end - self.now()))
        data = bytes(self._inbox[:size])
        del self._inbox[:size]
        return data

    def write(self, data):
        self._plugged()
        self._mega.received += self.to_board(bytes(data))
        return len(data)

    def reset_input_buffer(self):
        self._plugged()
        self._inbox.clear()

    def reset_output_buffer(self):
        self._plugged()
        self._mega.received.clear()

    def flush(self):
        self._plugged()

    def close(self):
        self.is_open = False

    def _plugged(self):
        if not self.is_open:
            raise serial.PortNotOpenError
        if self._unplugged:
            raise serial.SerialException("device disconnected")

    # ---- clock

    def now(self):
        return self._mega.seconds

    def sleep(self, seconds):
        self.sleep_until(self.now() + seconds)

    def sleep_until(self, t):
        while (left := t - self.now()) > 1e-9:
            self._advance(min(left, 5 * self._resolution))  # nobody waits for a byte: look less often

    # ---- inside and trouble

    def pins(self):
        return self._mega.pins()

    def reset(self):
        self._mega.reset()
        self._look()

    def hang(self, interrupts=True):
        self._mega.hang(interrupts)

    @property
    def resets(self):
        return self._mega.resets

    @property
    def on_the_way(self):
        """Number of bytes written that the board has not got yet."""
        return len(self._mega.received)

    def register(self, address):
        return self._mega.register(address)

    def unplug(self):
        self._unplugged = True
        self._mega.received.clear()

    def _advance(self, seconds):
        """A short piece of time: the processor first, then the arm if its tick is due."""
        self._mega.run(min(seconds, max(self._next_tick - self.now(), 1e-6)))
        if self._mega.sent:
            data = self.to_host(bytes(self._mega.sent))
            self._mega.sent.clear()
            if not self._unplugged:
                self._inbox += data
        self._look()
        if self.now() >= self._next_tick - 1e-9:
            self._next_tick += self._tick
            self.plant.advance(self.changes[-1][1].pwm, self._tick)
            for channel, counts in enumerate(self.plant.counts()):
                self._mega.set_counts(channel, counts)

    def _look(self):
        raw = self._mega.raw_pins()
        if raw != self._raw:
            self._raw = raw
            pins = self._mega.pins()
            if not self.changes or pins != self.changes[-1][1]:
                self.changes.append((self.now(), pins))
