"""The board's side of the wire in Python: what a stand-in for the board hears and says."""

from typing import NamedTuple

from ir50p_lab.bench import protocol
from ir50p_lab.bench.protocol import COMMAND_SYNC, LIMIT_PWM, REPLY_SYNC, FrameParser, State, encode_command, with_check

LIMIT_ACTIVE = (2, 4, 8)  # bits of `status`: joint 1, 2, 3 at an end of its potentiometer, outward drive is cut


class Command(NamedTuple):
    """Computer to board. seq 0..255; type HELLO, NAME, DRIVE or STOP; pwm three whole numbers, -255..255."""

    seq: int
    type: int
    pwm: tuple = (0, 0, 0)
    gripper: bool = False


def encode(command):
    """Bytes of a Command, as the computer sends it."""
    return encode_command(*command)


def encode_reply(frame):
    """Bytes of a State or an Identity, with check. Raises struct.error for numbers that do not fit."""
    if isinstance(frame, State):
        seq, counts, *rest = frame
        return with_check(protocol._STATE.pack(REPLY_SYNC, seq, protocol.STATE, *counts, *rest))
    seq, version, firmware, board_id, *rest = frame
    number = board_id.to_bytes(3, "little")
    head = (REPLY_SYNC, seq, protocol.IDENTITY, protocol.MAGIC)
    return with_check(protocol._IDENTITY.pack(*head, version, *firmware, number, *rest))


def decode_command(data):
    """The Command in COMMAND_SIZE bytes, or None if they are none."""
    sync, seq, kind, *pwm, flags = protocol._COMMAND.unpack_from(data)
    kinds = (protocol.HELLO, protocol.NAME, protocol.DRIVE, protocol.STOP)
    if sync != COMMAND_SYNC or kind not in kinds or flags > protocol.GRIPPER:
        return None
    if not all(-LIMIT_PWM <= u <= LIMIT_PWM for u in pwm) or with_check(data[:-4]) != data:
        return None
    return Command(seq, kind, tuple(pwm), bool(flags))


class CommandParser(FrameParser):
    """Finds commands in a stream of bytes."""

    sync, size, decode = bytes([COMMAND_SYNC]), protocol.COMMAND_SIZE, staticmethod(decode_command)
