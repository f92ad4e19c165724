"""A stream of bytes as from a bad line: random bytes, valid frames, and valid frames damaged in every way."""

import random


def noisy_stream(make_frame, size, seed):
    """Bytes (at least `size`) and the set of all valid frames (bytes) that went into it, damaged or not.

    make_frame: function Random -> bytes of a valid frame.
    """
    rng, stream, valid = random.Random(seed), bytearray(), set()
    while len(stream) < size:
        frame = make_frame(rng)
        valid.add(frame)
        stream += rng.choice(_DAMAGES)(rng, frame, make_frame, valid)
    return bytes(stream), valid


def true_frames(stream, valid, length):
    """The frames a perfect receiver finds: every valid one, oldest first, none within another."""
    found, place = [], 0
    while place <= len(stream) - length:
        piece = stream[place : place + length]
        if piece in valid:
            found.append(piece)
        place += length if piece in valid else 1
    return found


def _intact(rng, frame, make_frame, valid):
    return frame + rng.randbytes(40)


def _random(rng, frame, make_frame, valid):
    return rng.randbytes(rng.randrange(1, 60))


def _starts(rng, frame, make_frame, valid):
    return frame[:1] * rng.randrange(1, 30) + frame[:3] + rng.randbytes(len(frame) - 3)


def _flipped(rng, frame, make_frame, valid):
    number = int.from_bytes(frame, "little")
    for bit in rng.sample(range(8, 8 * len(frame)), rng.randrange(1, 16)):  # not in the sync byte: too easy
        number ^= 1 << bit
    return number.to_bytes(len(frame), "little")


def _low_bits(rng, frame, make_frame, valid):
    """Damage that no range check sees: sequence number, low bytes of numbers, check."""
    damaged = bytearray(frame)
    for place in rng.sample([1, 3, 5, 7, -1, -2, -3, -4], rng.randrange(1, 8)):
        damaged[place] = rng.randrange(256)
    return bytes(damaged)


def _cut(rng, frame, make_frame, valid):
    return frame[: rng.randrange(1, len(frame))]


def _lost_byte(rng, frame, make_frame, valid):
    place = rng.randrange(len(frame))
    return frame[:place] + frame[place + 1 :]


def _extra_byte(rng, frame, make_frame, valid):
    place = rng.randrange(1, len(frame))
    return frame[:place] + rng.randbytes(1) + frame[place:]


def _spliced(rng, frame, make_frame, valid):
    """The head of one frame and the tail of another, both valid."""
    other, place = make_frame(rng), rng.randrange(1, len(frame))
    valid.add(other)
    return frame[:place] + other[place:]


_DAMAGES = [
    *[_intact, _random, _starts, _flipped, _flipped, _low_bits, _low_bits],
    *[_cut, _lost_byte, _extra_byte, _spliced],
]
