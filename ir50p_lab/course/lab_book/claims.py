"""What a notebook claims, as a sentence that runs: printed with value and limit, or raised with the same words."""

import json

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.home import path_setting


class ClaimError(AssertionError):
    """A claim of the text that does not hold for these numbers; the message is the sentence, its value and limit."""


def claim(text, value, *, below=None, above=None, near=None, within=None, unit="", by=""):
    """Print what is claimed, its value and its limit; raise the same sentence if it does not hold.

        claim("the shoulder sinks", fell, above=0.1)
        claim("P leaves g/Kp", error, near=predicted, within=1e-6)

    Args: text: the claim, in words that a student understands. value: a number or an array, of which every element
    has to keep the limits. below, above: value < below, value > above. near, within: |value - near| < within. Limits
    are numbers, or arrays that fit the value. unit: of all of them, printed after the value. by: whose function made
    the value, as `badge_of` returns it; if that is not "yours", the sentence is printed, but nothing is claimed.

    If the environment variable IR50P_CLAIMS names a file, a line of JSON is added to it: the text, and how far
    each element of the value is from its limits. tests/notebooks/margins.py reads that over many units and seeds.
    Raises: ClaimError (an AssertionError), also for a value that is not finite; InputError without a limit.
    """
    if (near is None) != (within is None) or (below is None and above is None and near is None):
        raise InputError(f"claim {text!r} needs a limit: below=, above=, or near= and within=")
    value = np.asarray(value, dtype=float)
    said, room = [], []
    for word, limit in (("below", below), ("above", above)):
        if limit is not None:
            said.append(f"{word} {_words(limit)}")
            room.append(limit - value if word == "below" else value - limit)
    if near is not None:
        said.append(f"within {_words(within)} of {_words(near)}")
        near = np.asarray(near, dtype=float)
        room += [near + within - value, value - (near - within)]
    room = np.stack(np.broadcast_arrays(*room))
    sentence = f"{text}: {f'{_words(value)} {unit}'.strip()} ({' and '.join(said)})"
    _log(text, room)
    if by not in ("", "yours"):
        print(f"{by}, not claimed: {sentence}")
        return
    if not (room > 0).all():  # nan is no room either
        raise ClaimError(f"does not hold: {sentence}")
    print(f"{'✓' if by else 'it holds:'} {sentence}")


def _words(number):
    return np.array2string(np.asarray(number, dtype=float), formatter={"float": lambda x: f"{x:.4g}"}, separator=", ")


def _log(text, room):
    if path := path_setting("IR50P_CLAIMS"):
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"claim": text, "room": room.ravel().tolist()}) + "\n")
