import random
import re
import struct
import zlib
from pathlib import Path

import pytest
from board_frames import LIMIT_ACTIVE, Command, CommandParser, encode, encode_reply
from hypothesis import given
from hypothesis import strategies as st

from ir50p_lab.bench import protocol
from ir50p_lab.bench.protocol import DRIVE, HELLO, NAME, STOP, FrameParser, Identity, State
from tests.emulator.noise import noisy_stream, true_frames

HEADER = Path(protocol.__file__).parent / "firmware/ir50p_board/protocol.h"

bytes1, words = st.integers(0, 255), st.integers(0, 65535)
pwm = st.integers(-255, 255)
commands = st.builds(
    Command, bytes1, st.sampled_from([HELLO, NAME, DRIVE, STOP]), st.tuples(pwm, pwm, pwm), st.booleans()
)
quarters = st.integers(0, protocol.MAX_COUNTS)
states = st.builds(State, bytes1, st.tuples(quarters, quarters, quarters), st.integers(0, 63), words, words)
identities = st.builds(Identity, bytes1, bytes1, st.tuples(bytes1, bytes1), st.integers(0, 0xFFFFFF), words, bytes1)


def random_command(rng):
    return encode(
        Command(
            rng.randrange(256),
            rng.choice((HELLO, DRIVE, DRIVE, STOP)),
            tuple(rng.randrange(-255, 256) for _ in range(3)),
            rng.random() < 0.5,
        )
    )


def random_reply(rng):
    if rng.random() < 0.2:
        return encode_reply(
            Identity(rng.randrange(256), 1, (1, rng.randrange(9)), rng.randrange(1 << 24), rng.randrange(65536), 0)
        )
    counts = tuple(rng.randrange(protocol.MAX_COUNTS + 1) for _ in range(3))
    return encode_reply(
        State(rng.randrange(256), counts, rng.randrange(64), rng.randrange(65536), rng.randrange(65536))
    )


SIDES = [(CommandParser, random_command, protocol.COMMAND_SIZE), (FrameParser, random_reply, protocol.REPLY_SIZE)]


def test_the_sketch_has_the_same_numbers_as_python():
    numbers = dict(re.findall(r"const u?int\d+_t (\w+) = (\w+);", HEADER.read_text()))
    assert int(numbers.pop("CRC_POLYNOMIAL"), 0) == int(f"{0x04C11DB7:032b}"[::-1], 2)  # zlib's, lowest bit first
    assert len(numbers) == 24
    assert {name: int(value) for name, value in numbers.items()} == {name: getattr(protocol, name) for name in numbers}
    lists = dict(re.findall(r"const \w+ (\w+)\[\w+\] = {(.*)};", HEADER.read_text()))
    assert lists["LIMIT_ACTIVE"] == ", ".join(map(str, LIMIT_ACTIVE))
    assert lists["MAGIC"] == ", ".join(f"'{chr(byte)}'" for byte in protocol.MAGIC)


def test_the_layout_in_bytes():
    data = encode(Command(7, DRIVE, (1, -2, 255), gripper=True))
    assert data[:-4] == bytes([0xA5, 7, ord("D"), 1, 0, 0xFE, 0xFF, 0xFF, 0, 1])
    assert struct.unpack("<I", data[-4:])[0] == zlib.crc32(data[:-4])
    assert zlib.crc32(b"123456789") == 0xCBF43926  # the catalogue's check value of CRC-32


@given(commands)
def test_commands_survive_the_wire(command):
    assert CommandParser().feed(encode(command)) == [command]


@given(st.one_of(states, identities))
def test_replies_survive_the_wire(reply):
    assert FrameParser().feed(encode_reply(reply)) == [reply]


@pytest.mark.parametrize(
    "command", [Command(0, DRIVE, (256, 0, 0)), Command(0, ord("X")), Command(0, DRIVE, (0, 0, -999))]
)
def test_a_right_check_does_not_excuse_wrong_numbers(command):
    parser = CommandParser()
    assert parser.feed(encode(command)) == []
    assert parser.bad == 1


@pytest.mark.parametrize("reply", [State(0, (4093, 0, 0), 0, 0, 0), State(0, (0, 0, 0), 64, 0, 0)])
def test_a_reply_out_of_range_is_none(reply):
    assert FrameParser().feed(encode_reply(reply)) == []


@pytest.mark.parametrize(("side", "make", "size"), SIDES)
def test_every_damage_of_up_to_two_bits_is_found(side, make, size):
    frame = make(random.Random(1))
    number, decode = int.from_bytes(frame, "little"), side.decode
    assert decode(frame) is not None
    for i in range(8 * size):
        for j in range(i + 1):
            damaged = number ^ 1 << i ^ (1 << j if j < i else 0)
            assert decode(damaged.to_bytes(size, "little")) is None


@pytest.mark.parametrize(("side", "make", "size"), SIDES)
def test_a_good_frame_right_after_noise_is_not_lost(side, make, size):
    frame, rng = make(random.Random(5)), random.Random(6)
    for _ in range(300):
        parser = side()
        parser.feed(frame[: rng.randrange(size)] + rng.randbytes(rng.randrange(20)))
        assert len(parser.feed(frame)) >= 1


@pytest.mark.parametrize(("side", "make", "size"), SIDES)
def test_200_000_bytes_of_noise_and_no_false_frame(side, make, size):
    stream, valid = noisy_stream(make, 200_000, seed=2026)
    parser, encoded = side(), []
    for place in range(0, len(stream), 4096):
        encoded += parser.feed(stream[place : place + 4096])
    encode_again = encode if side is CommandParser else encode_reply
    assert [encode_again(frame) for frame in encoded] == true_frames(stream, valid, size)  # none false, none missed
    assert len(encoded) > 200
    assert parser.bad > 2000
