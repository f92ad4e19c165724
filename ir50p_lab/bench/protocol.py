"""What goes over the wire between the computer and the board; the sketch has the same in C.

A test fails when `firmware/ir50p_board/protocol.h` and this file differ. All numbers are little endian.
The computer asks, the board answers; it never speaks first.

=========  ====  ===  ====  ===================================================================  =====
frame      byte 0, 1, 2     then                                                                 then
=========  ====  ===  ====  ===================================================================  =====
command    0xA5  seq  type  pwm 3 x int16 (-255..255), flags uint8 (bit 0 gripper)               CRC-32
state      0x5A  seq  's'   counts 3 x uint16 (quarter counts), status uint8, bad_frames uint16,  CRC-32
                            clock_ms uint16
identity   0x5A  seq  'h'   'IR', protocol, firmware major, minor (3 x uint8), board id uint24,   CRC-32
                            boot uint16, reset_cause uint8
=========  ====  ===  ====  ===================================================================  =====

Command types: 'H' hello (stops the arm, answered by identity), 'N' name (the same, and gives a board without an id the
one in the three pwm, 0..255 each), 'D' drive, 'S' stop (both answered by state). The answer
repeats the sequence number of its command, so that a late answer is not taken for the present one.

Why CRC-32 (the one of zlib, zip, PNG) where 16 bits are common on such a wire: CRC-16 lets one in 65 536 badly damaged
frames pass, and a joint would act on it. CRC-32 at these lengths finds every error of up to six bits and every burst of
up to 32, and lets one in 4 billion of the rest pass. It costs two bytes, 0.04 ms. Ranges are checked besides.
"""

import struct
import zlib
from collections import namedtuple

VERSION = 2
MINIMUM_FIRMWARE = (1, 1)  # major, minor; what the sketch must at least be
BAUD = 500_000  # exact on a 16 MHz processor (115 200 is 2 % off), and 32 bytes there and back take 0.64 ms
JOINTS = 3
LIMIT_PWM = 255
COMMAND_SYNC, REPLY_SYNC = 0xA5, 0x5A
HELLO, NAME, DRIVE, STOP = b"HNDS"  # command types
STATE, IDENTITY = b"sh"  # reply types
MAGIC = b"IR"

GRIPPER = 1  # the one flag of a command: gripper closed

# bits of `status`
WATCHDOG_TRIPPED = 1  # no command came for WATCHDOG_MS: the drive was cut, and is so until a stop or a hello
# 2, 4, 8: joint 1, 2, 3 is at an end of its potentiometer, outward drive is cut
HELLO_NEEDED = 16  # the board has (re)started and does not drive before a hello
HARDWARE_RESET = 32  # its last start was by the hardware watchdog: the sketch had hung
STATUS_BITS = 63

NO_ID = 0xFFFFFF  # what an empty EEPROM holds: the board has no id yet

WATCHDOG_MS = 100  # without a valid drive command for so long, the board brakes
SUBCOUNTS = 4  # `counts` on the wire are quarters of a converter count: the mean of 16 conversions
MAX_COUNTS = SUBCOUNTS * 1023
LOW_COUNTS, HIGH_COUNTS = SUBCOUNTS * 10, SUBCOUNTS * 1013  # beyond: no outward drive
BROKEN_COUNTS = SUBCOUNTS * 3  # so near to 0 or to MAX_COUNTS only a broken or shorted wire reads: no drive at all

_CRC = struct.Struct("<I")
_COMMAND = struct.Struct("<BBB3hB")
_STATE = struct.Struct("<BBB3HBHH")
_IDENTITY = struct.Struct("<BBB2s3B3sHB")
COMMAND_SIZE = _COMMAND.size + _CRC.size
REPLY_SIZE = _STATE.size + _CRC.size


class State(namedtuple("State", "seq counts status bad_frames clock_ms")):
    """The state of the board, as it sends it to the computer.

    counts: (3,), quarters of a count; status: see the bits above; bad_frames and clock_ms wrap at 65536.
    """


class Identity(namedtuple("Identity", "seq protocol firmware board_id boot reset_cause")):
    """The board's answer to a hello.

    protocol: VERSION; firmware: (major, minor); board_id: 24 bits, given once, NO_ID before that; boot: number of
    starts so far, which differs after each reset and wraps at 65536; reset_cause: the processor's register MCUSR, or 0
    if a boot loader has cleared it.
    """


def encode_command(seq, kind, pwm=(0, 0, 0), gripper=False):
    """Return the bytes of a command with its check.

    seq: 0..255; kind: HELLO, NAME, DRIVE or STOP; pwm: three whole numbers, -255..255. Raises struct.error for numbers
    that do not fit.
    """
    return with_check(_COMMAND.pack(COMMAND_SYNC, seq, kind, *map(int, pwm), GRIPPER if gripper else 0))


def decode_reply(data):
    """Return the State or Identity in REPLY_SIZE bytes, or None if they are neither."""
    if data[0] != REPLY_SYNC or data[2] not in (STATE, IDENTITY) or with_check(data[: -_CRC.size]) != data:
        return None
    if data[2] == STATE:
        _, seq, _, *counts, status, bad_frames, clock_ms = _STATE.unpack_from(data)
        if max(counts) > MAX_COUNTS or status > STATUS_BITS:
            return None
        return State(seq, tuple(counts), status, bad_frames, clock_ms)
    _, seq, _, magic, protocol, major, minor, number, *rest = _IDENTITY.unpack_from(data)
    board_id = int.from_bytes(number, "little")
    return Identity(seq, protocol, (major, minor), board_id, *rest) if magic == MAGIC else None


def with_check(data):
    """Return the bytes of a frame followed by its CRC-32."""
    return data + _CRC.pack(zlib.crc32(data))


class FrameParser:
    """Finds replies in a stream of bytes that comes in pieces of any size; counts and drops everything else.

    After a bad frame it goes on one byte behind the sync byte of that frame, so that no good frame is lost to noise
    before it. Attribute `bad`: how often a sync byte was not the start of a valid frame.
    """

    sync, size, decode = bytes([REPLY_SYNC]), REPLY_SIZE, staticmethod(decode_reply)

    def __init__(self):
        self._buffer, self.bad = b"", 0

    def feed(self, data):
        """Take more bytes. Returns the frames that they complete, oldest first."""
        buffer, size, frames = self._buffer + data, self.size, []
        start = buffer.find(self.sync)
        while 0 <= start <= len(buffer) - size:
            frame = self.decode(buffer[start : start + size])
            if frame is None:
                self.bad += 1
                start += 1
            else:
                frames.append(frame)
                start += size
            start = buffer.find(self.sync, start)
        self._buffer = buffer[start:] if start >= 0 else b""
        return frames
