"""Question and answer with the board: numbered commands, repeated if need be, each matched with its answer."""

from types import SimpleNamespace

from serial import SerialTimeoutException

from ir50p_lab.bench import protocol
from ir50p_lab.errors import BoardLostError

try:
    from termios import error as _termios_error  # what pyserial lets through when a cable is pulled, no OSError
except ImportError:  # Windows
    _termios_error = OSError

PORT_ERRORS = (OSError, _termios_error)
STALL = 0.1  # s: if one read takes longer, the program was suspended, not the board
READ_TIMEOUT = 0.004  # longest wait for an answer, s: 1 ms on the wire and up to 3 ms through USB
REPEAT = 0.004  # s: a question without an answer for so long is asked again


class Link:
    """The wire to the board, over an open serial port.

    transport: what serial.Serial offers: timeout, read(n), write(bytes), in_waiting, reset_input_buffer(), close().
    clock: now() and sleep(s).
    Attribute: statistics, what has happened on the wire since it was opened. commands: how many were sent; repeats: how
    many of them were repeats, because no answer came; bad_replies, bad_commands: damaged frames, dropped by the
    computer and by the board (whose counter begins when it starts and wraps at 65536); watchdog_trips: how often the
    board cut the drive because no command came for 100 ms.
    """

    def __init__(self, transport, clock):
        self._transport, self._clock = transport, clock
        transport.timeout = READ_TIMEOUT
        self._parser = protocol.FrameParser()
        self._seq, self._tripped = 0, False
        self.statistics = SimpleNamespace(commands=0, repeats=0, bad_replies=0, bad_commands=0, watchdog_trips=0)

    def ask(self, kind, pwm=(0, 0, 0), gripper=False, *, patience, repeat=REPEAT):
        """Send a command and wait for its answer; ask again every `repeat` s without one, for `patience` s in all.

        An answer to any of the repeats counts, because this call sent them all. A program that was stopped while it
        waited first reads what has come meanwhile.
        Returns: (State or Identity, the time at which the command that it answers was sent).
        Raises: BoardLostError if no answer came; PORT_ERRORS as they come from the port.
        """
        wanted = protocol.Identity if kind in (protocol.HELLO, protocol.NAME) else protocol.State
        sent, stalled = {}, False
        start = now = self._clock.now()
        while now < start + patience:
            self.statistics.repeats += bool(sent)
            sent[self.tell(kind, pwm, gripper)] = now
            size, next_try = protocol.REPLY_SIZE, now + repeat
            while now < next_try:
                before, data = now, self._transport.read(size)
                now = self._clock.now()
                if now - before > STALL and not stalled:
                    stalled, start, next_try = True, now, now + repeat
                replies = self._parser.feed(data)
                self.statistics.bad_replies = self._parser.bad
                for reply in replies:
                    self._note(reply)
                    if isinstance(reply, wanted) and reply.seq in sent:
                        return reply, sent[reply.seq]
                if not (replies and len(data) == protocol.REPLY_SIZE):  # part of a frame, or of noise, has come
                    size = max(1, self._transport.in_waiting)
        raise BoardLostError(f"no answer for {patience * 1000:.0f} ms")

    def tell(self, kind, pwm, gripper):
        """Send a command without waiting; the next `ask` passes over its answer. Returns its number."""
        self._seq = (self._seq + 1) % 256
        self.statistics.commands += 1
        try:
            self._transport.write(protocol.encode_command(self._seq, kind, pwm, gripper))
        except SerialTimeoutException:  # also if the program was stopped as it wrote; what it meant to drive is old
            kind = protocol.STOP if kind == protocol.DRIVE else kind
            self._transport.write(protocol.encode_command(self._seq, kind, (0, 0, 0), gripper))
        return self._seq

    def stop(self, gripper=False):
        """Send STOP, three times at once in case one is damaged, and wait up to 50 ms until the board confirms it.

        Raises BoardLostError if it does not.
        """
        for _ in range(3):
            self.tell(protocol.STOP, (0, 0, 0), gripper)
        self.ask(protocol.STOP, (0, 0, 0), gripper, patience=0.05)

    def forget(self):
        """Drop everything that has come so far and was not read."""
        self._transport.reset_input_buffer()
        self._parser = protocol.FrameParser()

    def close(self):
        """Release the port."""
        self._transport.close()

    def _note(self, reply):
        if isinstance(reply, protocol.State):
            self.statistics.bad_commands = reply.bad_frames
            tripped = bool(reply.status & protocol.WATCHDOG_TRIPPED)
            self.statistics.watchdog_trips += tripped and not self._tripped  # it is said until a stop is answered
            self._tripped = tripped
