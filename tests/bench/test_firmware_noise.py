"""The board's parser on a bad line: the same stream as Python's, the same frames, none false."""

from board_frames import CommandParser

from ir50p_lab.bench.protocol import COMMAND_SIZE, FrameParser
from tests.bench.test_protocol import random_command
from tests.emulator.noise import noisy_stream, true_frames
from tests.emulator.talk import Talk
from tests.emulator.virtual import VirtualBoard


def pour(board, stream):
    """Send a stream at four fifths of the line's full speed, no reply waited for; returns the replies to it."""
    parser, replies = FrameParser(), []
    for place in range(0, len(stream), 50):  # 1 ms
        board.write(stream[place : place + 50])
        board.sleep(0.00125)
        replies += parser.feed(board.read(board.in_waiting))
    assert not board.on_the_way
    assert parser.bad == 0
    return replies


def test_200_000_bytes_of_noise_and_no_false_frame():
    stream, valid = noisy_stream(random_command, 200_000, seed=2027)
    stream += bytes(COMMAND_SIZE)  # ends what is unfinished
    python = CommandParser()
    expected = [frame.seq for frame in python.feed(stream)]
    assert len(expected) == len(true_frames(stream, valid, COMMAND_SIZE)) > 200
    board = VirtualBoard()
    board.sleep(0.05)
    replies = pour(board, stream)
    assert [reply.seq for reply in replies] == expected  # none false, none missed
    assert board.resets == 0
    last = Talk(board).stop()
    assert last.bad_frames == python.bad % 65536
