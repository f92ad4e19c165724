"""A minimal computer side for tests of the board: one command, one reply."""

from ir50p_lab.bench.protocol import DRIVE, HELLO, REPLY_SIZE, STOP, FrameParser, encode_command


class Talk:
    """Talks over a port as a test wants it, with no safety of its own."""

    def __init__(self, port):
        self.port, self.parser, self.seq = port, FrameParser(), 0

    def ask(self, kind, pwm=(0, 0, 0), gripper=False):
        """Send a command; returns the reply to it, or None if none came within the port's timeout."""
        self.seq = (self.seq + 1) % 256
        self.port.write(encode_command(self.seq, kind, pwm, gripper))
        return next((reply for reply in self.replies() if reply.seq == self.seq), None)

    def replies(self):
        return self.parser.feed(self.port.read(REPLY_SIZE))

    def hello(self):
        return self.ask(HELLO)

    def drive(self, *pwm, gripper=False):
        return self.ask(DRIVE, pwm, gripper)

    def stop(self):
        return self.ask(STOP)
