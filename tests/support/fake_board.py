"""A board in Python on virtual time, below the driver: bytes in, bytes out, and every fault a wire can have."""

import errno

import numpy as np
from board_frames import Command, CommandParser, encode_reply

from ir50p_lab.bench import protocol
from ir50p_lab.bench.protocol import Identity, State

ANSWER = 0.0008  # s from a command to its answer
SPEED = 0.004  # rad/s per PWM count: joints that turn as fast as they are driven, and stop at once


class FakeBoard:
    """Stands in for serial.Serial and for the clock: nothing happens but when the other side reads or sleeps.

    Faults to set: dead (swallows everything), unplugged (the port raises), identity (a dict of changed fields),
    `on_command(n, data) -> data` and `on_answer(n, data) -> data`: what becomes of the n-th frame on the wire
    (b"" loses it), `answer_after`: s. `restart()` is its reset button.
    """

    timeout = 0.004
    name = "fake"

    def __init__(self, calibration, q=(0.0, 0.0, 0.0)):
        self.calibration, self.q, self.pwm, self.gripper = calibration, np.array(q, dtype=float), np.zeros(3), False
        self.t = 100.0
        self.dead = self.unplugged = self.closed = False
        self.identity, self.answer_after, self.board_id = {}, ANSWER, protocol.NO_ID
        self.on_command = self.on_answer = lambda n, data: data
        self.commands, self.writes, self.answers, self.trips, self.hellos = [], 0, 0, 0, 0
        self._parser = CommandParser()
        self._out, self._inbox = [], b""  # (when, bytes) on their way; bytes that have come
        self._greeted = self._tripped = self._watched = False
        self._fed, self._started, self.boot, self.reset_cause = self.t, self.t, 1, 0

    # the clock

    def now(self):
        return self.t

    def sleep(self, seconds):
        self._advance(self.t + max(0.0, seconds))

    def _advance(self, until):
        while self.t < until:
            step = min(0.0002, until - self.t)
            if self._watched and self.t - self._fed > 0.001 * protocol.WATCHDOG_MS:
                self._tripped, self._watched, self.pwm = True, False, np.zeros(3)
                self.trips += 1
            self.q = self.q + SPEED * self.pwm * step
            self.t += step

    # the port

    def write(self, data):
        self._check_cable()
        self.t += 1e-6
        data = self.on_command(self.writes, bytes(data))
        self.writes += 1
        for command in self._parser.feed(data):
            self.commands.append((self.t, command))
            if not self.dead:
                self._answer(command)
        return len(data)

    def read(self, n=1):
        self._check_cable()
        until = self.t + self.timeout
        while self.in_waiting < n and self.t < until:
            self._advance(min(until, self.t + 0.0001))
            self._check_cable()
        taken, self._inbox = self._inbox[:n], self._inbox[n:]
        return taken

    @property
    def in_waiting(self):
        self._check_cable()
        self._inbox += b"".join(data for when, data in self._out if when <= self.t)
        self._out = [(when, data) for when, data in self._out if when > self.t]
        return len(self._inbox)

    def reset_input_buffer(self):
        self.in_waiting  # noqa: B018  what has come by now is dropped
        self._inbox = b""

    def close(self):
        self.closed = True

    def _check_cable(self):
        if self.unplugged:
            raise OSError(errno.EIO, "Input/output error")

    # the board

    def say(self, data):
        """Put bytes on the wire to the computer."""
        self._out.append((self.t + self.answer_after, data))

    def restart(self, hung=False):
        self._greeted = self._tripped = self._watched = False
        self.pwm, self._started, self.boot = np.zeros(3), self.t, self.boot + 1
        self.reset_cause = 8 if hung else 0

    def _answer(self, command: Command):
        if command.type in (protocol.HELLO, protocol.NAME):
            if command.type == protocol.NAME and self.board_id == protocol.NO_ID:
                self.board_id = int.from_bytes(bytes(command.pwm), "little")
            self._greeted, self._tripped, self.pwm, self._watched = True, False, np.zeros(3), False
            self.hellos += 1
            fields = {"protocol": protocol.VERSION, "firmware": protocol.MINIMUM_FIRMWARE}
            fields |= {"board_id": self.board_id, "boot": self.boot, "reset_cause": self.reset_cause} | self.identity
            self._reply(Identity(command.seq, **fields))
            return
        drive = command.type == protocol.DRIVE and self._greeted and not self._tripped
        self.pwm = np.array(command.pwm, dtype=float) if drive else np.zeros(3)
        self.gripper = command.gripper if drive else self.gripper
        self._fed, self._watched = self.t, drive
        counts = np.clip(np.rint(protocol.SUBCOUNTS * self.calibration.counts(self.q)), 0, protocol.MAX_COUNTS)
        status = protocol.WATCHDOG_TRIPPED * self._tripped | protocol.HELLO_NEEDED * (not self._greeted)
        status |= protocol.HARDWARE_RESET * bool(self.reset_cause)
        self._tripped = self._tripped and command.type == protocol.DRIVE
        clock_ms = int(1000 * (self.t - self._started)) % 65536
        self._reply(State(command.seq, tuple(int(c) for c in counts), status, self._parser.bad % 65536, clock_ms))

    def _reply(self, frame):
        data = self.on_answer(self.answers, encode_reply(frame))
        self.answers += 1
        if data:
            self.say(data)
